// A scope that gives out each name once. The same calls in the same order return the same names.
#pragma once

#include <set>
#include <string>
#include <utility>

namespace etlc::emit {

class Scope {
public:
    explicit Scope(std::set<std::string> taken = {}) : taken_(std::move(taken)) {}
    /// Returns `wanted` + `mark`; if that is taken, wanted_2 + mark, wanted_3 + mark, ...
    std::string claim(const std::string& wanted, const std::string& mark = "");
    /// Returns wanted_1; if that is taken, wanted_2, wanted_3, ...
    std::string number(const std::string& wanted);

private:
    std::set<std::string> taken_;
};

}  // namespace etlc::emit
