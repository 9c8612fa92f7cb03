// The reader's side of the records, which it writes to standard output.
// Keeps true: memory, files and time of the process are limited before a file is opened; every
// record renews the limit of processor time, so long files are read and endless loops end.
#pragma once

#include <string>

#include "data/records/protocol.hpp"

namespace etlc::data::records {

/// Limits the process. `mapped`: bytes of a mapped file, which take address space only.
void limit_resources(std::uint64_t mapped = 0);

void send(Tag tag, const char* bytes, std::size_t n);
void send(Tag tag, const std::string& text);

/// Exits without the cleanup of libraries, which a damaged file may have broken.
[[noreturn]] void quit(int status);
[[noreturn]] void fail(Cause cause, const std::string& text);
[[noreturn]] void done();

}  // namespace etlc::data::records
