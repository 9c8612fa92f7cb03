// Serves the page of `etlc label` until it is stopped: answers what etlc-serve passes on.
// Keeps true: a label is on disk before the page hears of it; one page at a time may label.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "label/background.hpp"
#include "label/desk.hpp"
#include "label/frames.hpp"

namespace etlc::label {

struct ServeRequest {
    std::string page;
    std::uint32_t port = 0;  ///< 0: any free one
    /// Called once with the address of the page; false ends the service.
    std::function<bool(const std::string& address)> ready;
};

/// Serves until the process is stopped. Returns why it ended otherwise.
diag::Failure serve(Desk& desk, Frames& frames, Background& background,
                    const ServeRequest& request);

}  // namespace etlc::label
