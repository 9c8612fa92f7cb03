// Types of values in the words of C++: a row each.
// Takes: what the user chose. Gives: how types, constants and headers are called. Keeps true: the
// emitter asks for words here, and plan::ValueType when a value is found out; nothing else of it
// knows which types there are.
#pragma once

#include <string>

#include "check/model/model.hpp"

namespace etlc::emit {

struct Spelling {
    // Types.
    std::string value;
    std::string value_meaning;
    std::string atom;  ///< of a predicate or bool as it is measured
    std::string key;   ///< of one end
    std::string reading;
    std::string verdict;
    std::string kept;  ///< a value that is kept from step to step
    bool bytes;        ///< values are made of bytes, not of words
    // Constants.
    std::string yes;
    std::string no;
    std::string top;  ///< one end of them
    std::string bottom;
    std::string neither;  ///< neither yes nor no; empty: both ends are written
    // Headers of the runtime.
    std::string predicates;
    std::string verdicts;
    std::string delays;
    std::string windows;
};

const Spelling& spelling(check::Values values);

}  // namespace etlc::emit
