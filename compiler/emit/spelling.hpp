// The types of values in C++: the spelling of types, constants and runtime headers, one row per
// type. Only this table and plan::ValueType tell the types apart.
#pragma once

#include <string>

#include "check/model/model.hpp"

namespace etlc::emit {

struct Spelling {
    // Types.
    std::string value;
    std::string value_meaning;
    std::string atom;  ///< measured predicate or bool
    std::string key;   ///< one end of a value
    std::string reading;
    std::string verdict;
    std::string kept;  ///< value kept between steps
    bool bytes;        ///< values consist of bytes, not words
    // Constants.
    std::string yes;
    std::string no;
    std::string top;  ///< end of a value
    std::string bottom;
    std::string neither;  ///< neither yes nor no; empty: spell both ends
    // Headers of the runtime.
    std::string predicates;
    std::string verdicts;
    std::string delays;
    std::string windows;
};

const Spelling& spelling(check::Values values);

}  // namespace etlc::emit
