// The records that a reader sends, a program that reads files which may be hostile.
// Takes: the program, its arguments and a file. Gives: its records. Keeps true: records are not
// trusted; a file that crashes the reader causes a failure here, whose message is printable and
// does not repeat the path.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "data/files/child.hpp"
#include "diag/diag.hpp"
#include "recordings/records/protocol.hpp"

namespace etlc::recordings {

class Records {
public:
    /// The caller's codes for the failures of a file.
    struct Codes {
        diag::Code unreadable;
        diag::Code malformed;
        diag::Code no_channel;
        diag::Code elements;
    };

    /// Starts a reader of the files `what`, "HDF5". The environment variable `variable` replaces
    /// the program.
    static diag::Result<std::shared_ptr<Records>> start(std::string_view program,
                                                        const char* variable, const char* what,
                                                        const Codes& codes, const std::string& path,
                                                        const std::vector<std::string>& arguments);

    /// Reads the next record into `bytes()`. A failure that the reader sends is returned as one.
    diag::Result<records::Tag> next();
    const std::string& bytes() const { return bytes_; }
    /// The failure of a record that makes no sense.
    diag::Failure nonsense() const;

private:
    Records(std::unique_ptr<data::Child> child, const Codes& codes)
        : child_(std::move(child)), codes_(codes) {}

    diag::Code code_of(char cause) const;
    diag::Failure stopped();

    std::unique_ptr<data::Child> child_;
    Codes codes_;
    std::string bytes_;
};

}  // namespace etlc::recordings
