// The values that functions take together, over all samples.
#pragma once

#include <bitset>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>
#include <vector>

#include "prove/symbol.hpp"

namespace etlc::prove {

class Images {
public:
    /// `places`: of the samples of one step.
    Images(const etlprove::Diagrams& diagrams, Place places)
        : diagrams_(diagrams), places_(places) {}

    /// Whether two lists of functions take the same values together; false where they are too many
    /// to find out.
    bool are_equal(const std::vector<Diagram>& first, const std::vector<Diagram>& second);

private:
    using Values = std::set<std::vector<bool>>;
    using Support = std::bitset<512>;

    static constexpr std::size_t kMostValues = 4096;
    static constexpr std::size_t kMostLists = 50000;

    const Support& support(Diagram of);
    std::vector<std::vector<std::size_t>> groups(const std::vector<Diagram>& first,
                                                 const std::vector<Diagram>& second);
    const Values* values(const std::vector<Diagram>& of);

    const etlprove::Diagrams& diagrams_;
    Place places_;
    std::unordered_map<Diagram, Support> supports_;
    std::map<std::vector<Diagram>, Values> values_;
};

}  // namespace etlc::prove
