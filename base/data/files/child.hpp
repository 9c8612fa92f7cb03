// A program that is run for what it writes to its standard output.
// Takes: its path and arguments, and what it shall read. Gives: its output as it comes, and how it
// ended. Keeps true: it has no other input, and ends with this object at the latest; a program that
// neither reads, writes nor ends for too long is stopped; one that ends before it has read all that
// it was given ends nothing here.
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/descriptor.hpp"
#include "diag/diag.hpp"

namespace etlc::data {

class Child {
public:
    struct Options {
        int max_silence_seconds = 0;
        bool fed = false;  ///< it reads what `give` gives it; else nothing
        /// It has all of the environment, else only what finds libraries.
        bool whole_environment = false;
        std::vector<std::string> variables;  ///< of the environment besides: "NAME=VALUE"
        bool heard = false;  ///< the end of its standard error is kept; else none of it
    };
    /// Nothing where the program cannot be run.
    static std::unique_ptr<Child> start(const std::string& program,
                                        const std::vector<std::string>& arguments,
                                        const Options& options);
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child();

    /// Writes all of `bytes` to its standard input; false where it does not take them. What it
    /// writes meanwhile is kept for `read`.
    bool give(std::string_view bytes);
    /// The end of its standard input.
    void give_no_more();

    /// Exactly `n` bytes; false where there are fewer, or where the program was stopped for its
    /// silence.
    bool read(char* to, std::size_t n);
    /// Whether it writes nothing more. Waits until that is known.
    bool at_end();
    /// How many bytes have come that were not read.
    std::size_t arrived() const { return arrived_.size() - taken_; }

    /// How it ended, after `read` failed: "was stopped by signal 11 (Segmentation fault)". Waits
    /// for it.
    std::string ending();
    /// Its exit status; -1 where it was stopped. Waits for it.
    int exit_status();
    /// The last line of its standard error, where it is heard; without what cannot be printed.
    std::string last_words();

private:
    Child(pid_t process, const Options& options, Descriptor input, Descriptor output,
          Descriptor errors)
        : process_(process),
          options_(options),
          input_(std::move(input)),
          output_(std::move(output)),
          errors_(std::move(errors)) {}

    /// Waits until something can be done and does it, writing `bytes` from the front; false where
    /// there is nothing to wait for, or it was stopped for its silence.
    bool wait(std::string_view& bytes);
    void hear();
    void receive();
    void stop();
    int status();

    pid_t process_;
    Options options_;
    Descriptor input_;
    Descriptor output_;
    Descriptor errors_;
    std::string arrived_;
    std::size_t taken_ = 0;  ///< of arrived_
    std::string said_;       ///< the end of its standard error
    int status_ = 0;
    bool silent_ = false;
    bool deaf_ = false;  ///< it reads no more
};

/// A program that belongs to etlc: beside it, as in the build folder, or below libexec/, where it
/// is installed.
std::string helper_path(std::string_view name);

}  // namespace etlc::data
