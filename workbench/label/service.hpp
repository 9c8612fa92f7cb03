// A page on the loopback: etlc-serve, which listens, and the requests and events of the page.
// Takes: answers, one a request, and events for all pages that listen. Keeps true: nobody without
// the address can ask; requests come one after the other.
#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "data/files/child.hpp"
#include "diag/diag.hpp"
#include "label/desk.hpp"
#include "label/propose.hpp"

namespace etlc::label {

struct Asked {
    std::string path;  ///< "/", "/state", ...
    std::string content;
};

struct Answer {
    std::uint32_t status = 200;
    std::string type = "application/json";
    std::string content;
};

class Service {
public:
    /// Starts to listen; `port`: 0 for any free one.
    static diag::Result<std::unique_ptr<Service>> start(std::uint32_t port);

    /// The address of the page, with its token: "http://127.0.0.1:1234/TOKEN/".
    const std::string& address() const { return address_; }

    /// Waits for a request; returns nothing where the descriptor `or_this` can be read before (-1:
    /// none), or where the service has ended.
    std::optional<Asked> next(int or_this = -1);
    /// Answers it; false where the service has ended.
    bool answer(const Answer& answer);
    /// Sends an event to the pages that listen to "/events"; false where the service has ended.
    bool publish(std::string_view event);

    bool has_ended() const { return has_ended_; }
    /// Says why it has ended.
    diag::Failure ending();

private:
    explicit Service(std::unique_ptr<data::Child> child) : child_(std::move(child)) {}
    std::optional<std::string> read_text();

    std::unique_ptr<data::Child> child_;
    std::string address_;
    bool has_ended_ = false;
};

/// Says why this etlc cannot serve pages, or returns an empty text.
std::string what_serving_lacks();

// Makes proposals in the background, in another process: no fault there ends the page.
// Keeps true: nothing here waits for that process while the page does.

class Background {
public:
    /// `call`: arguments with which this program prints proposals.
    explicit Background(std::vector<std::string> call) : call_(std::move(call)) {}

    /// Takes the proposals that are ready, and starts to make others where the labels have changed
    /// and nobody has changed them for a moment.
    void look_after(const Desk& desk);

    const Proposals& proposals() const { return proposals_; }
    /// Whether others are being made, or will be unless the labels are those of the last ones.
    bool is_busy() const { return running_.valid() || is_due_; }
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
    bool is_due_ = false;  ///< the labels have changed, and nobody has looked at them
    std::string learned_;  ///< labels that the running or last process learned from, if it is known
};

}  // namespace etlc::label
