// A program that is run for what it writes to its standard output.
// Takes: its path and arguments. Gives: its output as it comes, and how it ended.
// Keeps true: it has no other input, its standard error is dropped; it ends with this object at the
// latest; a program that neither writes nor ends for too long is stopped.
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::data {

class Child {
public:
    /// Nothing where the program cannot be run.
    static std::unique_ptr<Child> start(const std::string& program,
                                        const std::vector<std::string>& arguments,
                                        int max_silence_seconds);
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child();

    /// Exactly `n` bytes; false where there are fewer, or where the program was stopped for its
    /// silence.
    bool read(char* to, std::size_t n);
    /// How it ended, after `read` failed: "was stopped by signal 11 (Segmentation fault)". Waits
    /// for it.
    std::string ending();

private:
    Child(pid_t process, int output, int max_silence_seconds)
        : process_(process), output_(output), max_silence_seconds_(max_silence_seconds) {}

    void stop();

    pid_t process_;
    int output_;
    int max_silence_seconds_;
    bool silent_ = false;
};

}  // namespace etlc::data
