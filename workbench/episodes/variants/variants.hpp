// Makes failures of a recorded episode, because most people record successes only. A variant is the
// episode with its frames in another order: cut short, its phases in reverse order, played
// backward, or frozen. It is read as a file with these frames would be, so truths, `hold` and
// `stale after` see the new order.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "data/spill/spill.hpp"
#include "episodes/recording.hpp"

namespace etlc::episodes {

enum class Variant : std::uint8_t {
    cut,              ///< ends before a truth's last change
    phases_reversed,  ///< the phases between changes of truths come in reverse order
    reversed,         ///< played backward
    frozen,           ///< the frame before a truth's last change repeats to the end
};

/// All variants with their names in --variants and in results.
inline constexpr std::pair<Variant, std::string_view> kVariants[] = {
    {Variant::cut, "cut"},
    {Variant::phases_reversed, "phases_reversed"},
    {Variant::reversed, "reversed"},
    {Variant::frozen, "frozen"}};

std::string_view name_of(Variant variant);

/// The frames of an episode, from 0, in the order of a variant.
using Order = std::vector<std::uint64_t>;

/// Returns the variants of this kind of an episode with `frames` frames, all different from it;
/// none where it is too short. A truth changes at the first frame whose label is known and differs
/// from the last known one.
/// `truths`: for each labelled predicate, the labels of all frames.
std::vector<Order> orders(Variant variant, const std::vector<std::vector<Label>>& truths,
                          std::uint64_t frames);

/// The frames of an episode, kept while it is read. Most of them are in a temporary file.
class KeptFrames {
public:
    /// Returns an opener of the same trace that keeps its frames. Both arguments outlive it.
    Opener keeping(const Opener& open);
    /// Returns an opener of the kept frames in this order. Both outlive it.
    Opener in_order(const Order& order) const;

private:
    class Keeper;
    class Reordered;

    std::vector<bool> has_;  ///< per channel
    data::Spool<data::Sample> frames_;
};

}  // namespace etlc::episodes
