#include "plan/decide/share_windows.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "plan/program/value_type.hpp"

namespace etlc::plan {

namespace {

/// Windows that take the same element at each step, also while finish() reports the last positions:
/// one without lag goes on beyond the end of the trace, since no position of its own lies there.
/// And that begin together.
using Signal = std::tuple<bool, std::vector<Slot>, std::uint32_t, bool, std::uint32_t>;

void widen(Stream& stream, Slot from, std::uint32_t from_length) {
    stream.op = StreamOp::widening;
    stream.operands = {from};
    stream.from_length = from_length;
}

}  // namespace

void share_windows(Plan& plan) {
    // On truth values a window is a counter, which nothing undercuts.
    if (value_type(plan.values).on_demand) return;
    std::map<Signal, std::vector<Slot>> watching;
    for (Slot slot = 0; slot < plan.streams.size(); ++slot) {
        const Stream& stream = plan.streams[slot];
        if (stream.op == StreamOp::window && stream.length > 1)
            watching[{stream.max, stream.operands, stream.operand_lag, stream.lag == 0,
                      stream.begins_with}]
                .push_back(slot);
    }
    for (auto& [signal, windows] : watching) {
        const auto length = [&](Slot slot) { return plan.streams[slot].length; };
        std::stable_sort(windows.begin(), windows.end(),
                         [&](Slot a, Slot b) { return length(a) < length(b); });
        for (std::size_t i = windows.size(); i-- > 1;) {
            const Slot from = windows[i - 1];
            const bool longer = length(from) < length(windows[i]);
            if (longer && length(windows[i]) - length(from) <= length(from))
                widen(plan.streams[windows[i]], from, length(from));
        }
    }
}

}  // namespace etlc::plan
