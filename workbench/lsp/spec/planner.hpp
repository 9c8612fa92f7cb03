// Plans the monitors of a spec in a thread of its own, while the server answers.
// Takes: a checked model. Gives: its plan.
// Keeps true: one plan is in work at a time; the threads share only the model, which is constant.
#pragma once

#include <future>
#include <memory>
#include <optional>

#include "check/check.hpp"
#include "data/files/descriptor.hpp"
#include "diag/diag.hpp"
#include "pipeline/compile.hpp"

namespace etlc::lsp {

struct Planned {
    diag::Sink sink;
    std::optional<pipeline::Compiled> compiled;
};

class Planner {
public:
    using Checked = std::shared_ptr<const check::Inspected>;

    Planner();

    /// Whether a plan was started and not taken.
    bool is_busy() const { return checked_ != nullptr; }
    /// Starts to plan a complete model; where no thread can be had, take() does the work.
    void start(Checked checked);
    /// Returns a descriptor that can be read once the plan is there.
    int ready() const { return *ready_; }
    /// Returns the model whose plan is in work.
    const Checked& checked() const { return checked_; }
    /// Returns the plan, for which it waits. Throws what stopped the planning.
    std::unique_ptr<Planned> take();

private:
    data::Descriptor ready_;
    data::Descriptor done_;  ///< the end of the pipe that is written
    Checked checked_;
    std::future<std::unique_ptr<Planned>> plan_;
};

}  // namespace etlc::lsp
