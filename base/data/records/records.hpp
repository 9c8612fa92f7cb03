// The records of a reader, a program that reads what may be hostile.
// Takes: the program, its arguments and a file. Gives: its records. Keeps true: none of them is
// trusted: whatever the file does to the reader, here it is a failure, whose message is printable
// and does not repeat the path.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "data/files/child.hpp"
#include "data/records/protocol.hpp"
#include "diag/diag.hpp"

namespace etlc::data {

class Records {
public:
    /// What the caller calls the failures of a file.
    struct Codes {
        diag::Code unreadable;
        diag::Code malformed;
        diag::Code no_channel;
        diag::Code elements;
    };

    /// `what`: the files that it reads, "HDF5"; `variable`: of the environment, which names
    /// another program.
    static diag::Result<std::shared_ptr<Records>> start(std::string_view program,
                                                        const char* variable, const char* what,
                                                        const Codes& codes, const std::string& path,
                                                        const std::vector<std::string>& arguments);

    /// The next record; its bytes are in `bytes()`. What the reader says is wrong is a failure.
    diag::Result<records::Tag> next();
    const std::string& bytes() const { return bytes_; }
    diag::Failure nonsense() const;

private:
    Records(std::unique_ptr<Child> child, const Codes& codes)
        : child_(std::move(child)), codes_(codes) {}

    diag::Code code_of(char cause) const;
    diag::Failure stopped();

    std::unique_ptr<Child> child_;
    Codes codes_;
    std::string bytes_;
};

}  // namespace etlc::data
