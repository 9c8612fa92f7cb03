// A child process that is run for its standard output.
// Takes: its path, arguments and input. Gives: its output as it arrives, and how it ended. Keeps
// true: it has no other input, and ends with this object at the latest; it is killed where it
// neither reads, writes nor ends for too long; where it ends without reading all its input, this
// process goes on.
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/file.hpp"
#include "diag/diag.hpp"

namespace etlc::data {

class Child {
public:
    struct Options {
        int max_silence_seconds = 0;
        bool fed = false;  ///< its standard input is what `give` writes; else empty
        /// It inherits the whole environment; else only what locates libraries.
        bool whole_environment = false;
        std::vector<std::string> variables;  ///< added to its environment: "NAME=VALUE"
        bool heard = false;                  ///< the end of its standard error is kept; else none
    };
    /// Starts a program; null where it cannot be run.
    static std::unique_ptr<Child> start(const std::string& program,
                                        const std::vector<std::string>& arguments,
                                        const Options& options);
    /// Replaces this process by a program, with the same streams. Returns where it cannot be run.
    static void become(const std::string& program, const std::vector<std::string>& arguments,
                       const Options& options);
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child();

    /// Writes all of `bytes` to its standard input; false where it stops reading. Output that
    /// arrives meanwhile is kept for `read`.
    bool give(std::string_view bytes);
    /// Closes its standard input.
    void give_no_more();

    /// Reads exactly `n` bytes; false where there are fewer, or where the program was silent too
    /// long.
    bool read(char* to, std::size_t n);
    /// Returns whether its output has ended. Waits until that is known.
    bool at_end();
    /// Returns how many bytes have arrived and were not read.
    std::size_t arrived() const { return arrived_.size() - taken_; }
    /// Returns whether no more output comes than has arrived.
    bool has_ended() const { return !output_; }
    /// Returns whether all of its output has been read, and no more comes.
    bool is_over() const { return has_ended() && arrived() == 0; }

    /// Takes up to `n` bytes of its output that are there, without waiting; returns their number.
    std::size_t take(char* to, std::size_t n);
    /// The descriptor of its output, for `await`.
    int output() const { return *output_; }

    /// Waits until one of these programs writes, one of the descriptors can be read (-1: none), or
    /// the time is over (less than 0: never), and takes what the programs have written.
    static void await(const std::vector<Child*>& children, const std::vector<int>& others,
                      int milliseconds);

    /// Says how it ended, after `read` failed: "was stopped by signal 11 (Segmentation fault)".
    /// Waits for it.
    std::string ending();
    /// Returns its exit status; -1 where it was killed. Waits for it.
    int exit_status();
    /// Returns the last line of its standard error, without unprintable bytes.
    std::string last_words();

private:
    Child(pid_t process, const Options& options, Descriptor input, Descriptor output,
          Descriptor errors)
        : process_(process),
          options_(options),
          input_(std::move(input)),
          output_(std::move(output)),
          errors_(std::move(errors)) {}

    /// Waits until it can read or write, and writes `bytes` from the front; false where there is
    /// nothing to wait for, or it was silent too long.
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
    std::size_t taken_ = 0;  ///< bytes of arrived_ that were read
    std::string said_;       ///< the end of its standard error
    int status_ = 0;
    bool silent_ = false;
    bool deaf_ = false;  ///< it has stopped reading
};

/// Finds a program that belongs to etlc: beside it in the build folder, below libexec/ in an
/// installation.
std::string helper_path(std::string_view name);

}  // namespace etlc::data
