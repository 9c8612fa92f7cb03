// SPDX-License-Identifier: MIT
// Stands in for the runtime's boolean_verdict.hpp when `etlc prove` compiles a class.
#pragma once

#include "etlmon/temporal/truth.hpp"
#include "etlmon/temporal/verdict.hpp"

namespace etlmon {
inline namespace ETLMON_BUILD {

struct BooleanVerdict : Answers<BooleanVerdict> {
    etlprove::Status status;
};

/// The conditions of the runtime's file.
inline BooleanVerdict prefix_verdict(Truth holds, Bit surely, Bit perhaps,
                                     bool complete = false) noexcept {
    return {{}, {holds.low, !holds.high, complete || surely || !perhaps}};
}
inline BooleanVerdict sliding_verdict(Truth holds) noexcept {
    return prefix_verdict(holds, true, true);
}

}  // namespace ETLMON_BUILD
}  // namespace etlmon
