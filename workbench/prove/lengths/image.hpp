// The values that functions take together, over all samples.
// Takes: two lists of functions. Gives: whether the values are the same. Keeps true: "yes" is said
// only where all values of both were found.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <set>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "prove/symbols/symbol.hpp"

namespace etlc::prove {

class Images {
public:
    using Functions = std::vector<Diagram>;
    /// Per atom, a bit for each set of ends of a sample that can be true, each end by itself.
    using Possible = std::vector<std::uint16_t>;

    Images(etlprove::Diagrams& diagrams, std::size_t atoms) : diagrams_(diagrams), atoms_(atoms) {}

    /// `possible`: of the samples; null: every end may be anything. False where there are too many
    /// values to find out.
    bool are_equal(const Functions& first, const Functions& second, const Possible* possible);
    /// Whether it is no use to ask for more.
    bool gives_up() const { return failures_ >= kMostFailures; }

private:
    using Known = std::unordered_map<Diagram, Diagram>;
    using Support = std::bitset<512>;

    static constexpr std::uint32_t kMostBranches = 20000;
    static constexpr std::uint32_t kMostDiagrams = 1U << 19U;
    static constexpr int kMostFailures = 2;

    const Support& support(Diagram of);
    std::vector<std::vector<std::size_t>> groups(const Functions& first, const Functions& second);
    Diagram in_ranges(Diagram of, const Possible& possible, Known& known);
    bool may_be(const Possible& possible, Place place, bool is_true) const;
    bool agree(std::size_t n, Diagram one, Diagram other);

    etlprove::Diagrams& diagrams_;
    std::size_t atoms_;
    int failures_ = 0;
    std::unordered_map<Diagram, Support> supports_;
    // The two lists that are compared, what was compared, and the limit for it.
    Functions first_, second_;
    std::set<std::tuple<std::size_t, Diagram, Diagram>> agreed_;
    std::uint32_t most_diagrams_ = 0;
    bool is_too_large_ = false;
};

}  // namespace etlc::prove
