// Makes proposals in the background, in another process: no fault there ends the page.
// Keeps true: nothing here waits for that process while the page does.
#pragma once

#include <chrono>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "label/desk.hpp"
#include "label/propose.hpp"

namespace etlc::label {

class Background {
public:
    /// `call`: arguments with which this program prints proposals.
    explicit Background(std::vector<std::string> call) : call_(std::move(call)) {}

    /// Takes the proposals that are ready, and starts to make others where the labels have changed
    /// and nobody has changed them for a moment.
    void look_after(const Desk& desk);

    const Proposals& proposals() const { return proposals_; }
    bool is_busy() const { return running_.valid(); }
    /// Returns a number that grows with each answer.
    std::uint64_t version() const { return version_; }

private:
    using Clock = std::chrono::steady_clock;

    std::vector<std::string> call_;
    std::future<std::string> running_;
    Proposals proposals_;
    std::uint64_t version_ = 0;
    std::uint64_t seen_ = 0;  ///< version of the desk
    Clock::time_point changed_;
    std::string learned_;  ///< labels that the running or last process learned from
};

}  // namespace etlc::label
