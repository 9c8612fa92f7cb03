// A trace made of one array a channel: what .npz and .h5 files have in common.
// Takes: for every channel the shape of its array and its rows. Gives: the trace. Keeps true:
// shapes and element types fit the channels, all arrays have as many steps; failures have E08 codes
// and name the array.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "data/arrays/rows.hpp"
#include "data/traces/trace.hpp"

namespace etlc::data {

/// One channel and the array that feeds it.
struct Feed {
    Channel channel;
    std::uint64_t steps = 0;
    std::unique_ptr<Rows> rows;  ///< null: an optional channel that the file lacks
};

/// What of the array cannot feed the channel: T or T x 1 for scalars and bools, T x D for vectors,
/// and T where D is 1; bools for bools only.
std::optional<diag::Failure> check_array(const std::vector<std::uint64_t>& shape, bool has_bools,
                                         const Channel& channel);

/// The feeds in the order of the channels.
diag::Result<std::unique_ptr<Trace>> open_array_trace(std::vector<Feed> feeds);

}  // namespace etlc::data
