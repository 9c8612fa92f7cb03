// Why a Parquet file is not read.
// Takes: a cause and words. Gives: an exception. Keeps true: it is thrown only inside the process
// that reads Parquet, which tells etlc the words and ends.
#pragma once

#include <stdexcept>
#include <string>

#include "data/records/protocol.hpp"

namespace etlc::data::parquet {

class Refused : public std::runtime_error {
public:
    Refused(records::Cause cause, const std::string& why)
        : std::runtime_error(why), cause_(cause) {}
    records::Cause cause() const { return cause_; }

private:
    records::Cause cause_;
};

/// The file, or a column of it, contradicts itself.
[[noreturn]] inline void refuse(const std::string& why) {
    throw Refused(records::Cause::file, why);
}

}  // namespace etlc::data::parquet
