// What the functions for rows of steps check.
#pragma once

#include <algorithm>
#include <memory>

#include "library/batch.hpp"
#include "library/interface/call.hpp"
#include "library/samples.hpp"

namespace etlc::library {

constexpr std::uint64_t kMostRows = std::uint64_t{1} << 32U;
constexpr std::uint32_t kMostThreads = 1024;

/// Checks the samples of all inputs, the number of threads and the room for all verdicts.
etlc_status check_grids(const Session& session, const Grids& samples, std::size_t grid_count,
                        std::uint32_t threads, const void* verdicts, std::size_t count);

/// Refuses a batch where the episode of an environment has ended.
etlc_status check_none_ended(const Batch& batch);

/// Returns how many threads work at these rows.
inline std::uint32_t threads_for(std::uint32_t threads, const Grids& samples) {
    const std::uint64_t most = std::max<std::uint64_t>(samples.rows, 1);
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(threads, 1, most));
}

/// Opens the session that `make` makes.
template <class Make>
etlc_status give_session(etlc_session* to, const char* what, const Make& make) {
    if (to == nullptr) return refuse_null(what);
    *to = 0;
    *to = hold(make());
    return *to != 0 ? etlc_status{ETLC_OK}
                    : refuse(ETLC_OUT_OF_MEMORY, "too many sessions are open");
}

}  // namespace etlc::library
