#include "emit/text/scope.hpp"

#include <fmt/format.h>

namespace etlc::emit {

std::string Scope::claim(const std::string& wanted, const std::string& mark) {
    std::string name = wanted + mark;
    for (int i = 2; !taken_.insert(name).second; ++i)
        name = fmt::format("{}_{}{}", wanted, i, mark);
    return name;
}

std::string Scope::number(const std::string& wanted) {
    int i = 1;
    while (!taken_.insert(fmt::format("{}_{}", wanted, i)).second) ++i;
    return fmt::format("{}_{}", wanted, i);
}

}  // namespace etlc::emit
