// The reader's side of the records.
// Takes: what is to be sent. Gives: records on standard output. Keeps true: before a file is
// opened, memory, files and time of the process are limited; each record may take its share of
// processor time, so that long files may and endless loops may not.
#pragma once

#include <string>

#include "data/records/protocol.hpp"

namespace etlc::data::records {

/// `mapped`: bytes of a file that take address space and no memory.
void limit_resources(std::uint64_t mapped = 0);

void send(Tag tag, const char* bytes, std::size_t n);
void send(Tag tag, const std::string& text);

/// What a damaged file did to a library's own tidying up is of no interest.
[[noreturn]] void quit(int status);
[[noreturn]] void fail(Cause cause, const std::string& text);
[[noreturn]] void done();

}  // namespace etlc::data::records
