// The formats behind open_trace, each from any source of bytes.
// Takes: channels, and an open file or an archive. Gives: the trace. Keeps true: as trace.hpp says.
#pragma once

#include <memory>
#include <vector>

#include "data/arrays/archive.hpp"
#include "data/files/bytes.hpp"
#include "data/traces/trace.hpp"

namespace etlc::data {

diag::Result<std::unique_ptr<Trace>> open_csv_trace(std::unique_ptr<ByteSource> source,
                                                    const std::vector<Channel>& channels);

/// The archive is opened once per channel, so that every array is unpacked in step with the others.
diag::Result<std::unique_ptr<Trace>> open_npz_trace(const ArchivePlace& place,
                                                    const std::vector<Channel>& channels);

/// The same finding about a trace: E04 codes of archives and arrays become their E08 counterparts.
diag::Failure of_trace(diag::Failure failure);

}  // namespace etlc::data
