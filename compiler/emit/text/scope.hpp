// Names of one scope, each given once.
// Takes: the name that is wanted. Gives: it, or one like it that is free. Keeps true: the same
// calls in the same order give the same names.
#pragma once

#include <set>
#include <string>
#include <utility>

namespace etlc::emit {

class Scope {
public:
    explicit Scope(std::set<std::string> taken = {}) : taken_(std::move(taken)) {}
    /// `wanted` and `mark`; where that is taken, wanted_2 and mark, wanted_3 and mark, ...
    std::string claim(const std::string& wanted, const std::string& mark = "");
    /// wanted_1, or wanted_2, wanted_3, ... where it is taken.
    std::string number(const std::string& wanted);

private:
    std::set<std::string> taken_;
};

}  // namespace etlc::emit
