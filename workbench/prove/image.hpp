// The values that functions take together, over all samples.
// Takes: two lists of functions. Gives: whether the values are the same. Keeps true: "yes" is said
// only where all values of both were found.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <unordered_map>
#include <vector>

#include "prove/symbol.hpp"

namespace etlc::prove {

class Images {
public:
    using Functions = std::vector<Diagram>;
    /// Per atom, a bit for each set of ends of a sample that can be true, each end by itself.
    using Possible = std::vector<std::uint16_t>;

    Images(const etlprove::Diagrams& diagrams, std::size_t atoms)
        : diagrams_(diagrams), atoms_(atoms) {}

    /// `possible`: of the samples; null: every end may be anything. False where there are too many
    /// values to find out.
    bool are_equal(const Functions& first, const Functions& second, const Possible* possible);
    /// Whether it is no use to ask for more.
    bool gives_up() const { return failures_ >= kMostFailures; }

private:
    using Values = std::set<std::vector<bool>>;
    using Support = std::bitset<512>;

    static constexpr std::size_t kMostValues = 4096;
    static constexpr std::size_t kMostLists = 10000;
    static constexpr int kMostFailures = 8;

    const Support& support(Diagram of);
    std::vector<std::vector<std::size_t>> groups(const Functions& first, const Functions& second);
    const Values* values(const Functions& of);
    bool may_be(Place place, bool is_true) const;

    const etlprove::Diagrams& diagrams_;
    std::size_t atoms_;
    const Possible* possible_ = nullptr;
    int failures_ = 0;
    std::unordered_map<Diagram, Support> supports_;
    std::map<Functions, Values> values_;
};

}  // namespace etlc::prove
