// What is checked of samples in the memory of the caller.
#pragma once

#include <cstdint>

#include "check/model/model.hpp"
#include "library/etlc.h"
#include "library/session.hpp"

namespace etlc::library {

/// Refuses samples that are not one per input. `what`: their name in the message.
etlc_status check_count(const Session& session, const void* samples, std::size_t count,
                        const char* what);

/// Refuses room for verdicts that is null, or larger than any memory.
etlc_status check_verdicts(const void* verdicts, std::size_t count);

/// Return ETLC_OK, or refuse the samples of an input. The room for the verdicts has been checked,
/// so that `rows` times `steps` is no number that the caller made up.
etlc_status check_sample(const check::Input& input, const etlc_sample& sample);
etlc_status check_column(const check::Input& input, const etlc_column& column, std::uint64_t steps);
etlc_status check_grid(const check::Input& input, const etlc_grid& grid, std::uint64_t rows,
                       std::uint64_t steps);

}  // namespace etlc::library
