// A spec that is open: what a session of the C interface owns.
// Takes: a spec's text, and how it is compiled. Gives: its monitors, stepped, and what they say.
// Keeps true: all memory for steps is asked for when it is made; a call that is refused changes
// nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diag/diag.hpp"
#include "etlmon/temporal/verdict.hpp"
#include "explain/observations.hpp"
#include "library/etlc.h"
#include "library/open.hpp"
#include "plan/evaluate/evaluator.hpp"
#include "plan/evaluate/flight_recorder.hpp"
#include "source/source.hpp"

namespace etlc::library {

using check::Index;

class Session {
public:
    /// `compiled`, of `file`, as the sink has found it. `history`: steps that explain() can look
    /// back at.
    Session(source::File file, pipeline::Compiled compiled, const diag::Sink& sink,
            std::uint64_t history);
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    const plan::Plan& plan() const { return compiled_.plan; }
    const check::Model& model() const { return *compiled_.model; }
    plan::Evaluator& evaluator() { return evaluator_; }
    std::uint64_t steps() const { return steps_; }
    bool is_ended() const { return is_ended_; }
    const etlmon::Verdict& verdict(std::size_t monitor) const { return verdicts_[monitor]; }
    const std::string& warnings() const { return warnings_; }

    /// Texts of the description, by index.
    const std::string& formula(std::size_t monitor) const { return formulas_[monitor]; }
    const std::string& predicate_name(Index predicate) const { return names_[predicate]; }
    const std::string& predicate_text(Index predicate) const { return texts_[predicate]; }
    bool is_used(Index input) const { return is_used_[input]; }
    bool is_measured(Index predicate) const { return is_measured_[predicate]; }

    /// Where the next step's sample of an input goes. Its `values` have room for it.
    plan::Sample& sample(Index input) { return samples_[input]; }
    /// With these samples.
    const std::vector<etlmon::Verdict>& step();
    const std::vector<etlmon::Verdict>& finish();
    void reset();
    void restart(std::size_t monitor);
    void observe(Index predicate, float distance, bool truth);

    /// Null: the spec was opened without one.
    plan::FlightRecorder* recorder() { return recorder_ ? &*recorder_ : nullptr; }

    /// Why there is no explanation of the last verdict; empty where there is one.
    std::string why_unexplained() const;
    const std::string& explain(std::size_t monitor, bool as_json);

private:
    source::File file_;
    pipeline::Compiled compiled_;
    std::string warnings_;
    std::vector<std::string> formulas_;  ///< per monitor of the plan
    std::vector<std::string> names_;     ///< per predicate of the model
    std::vector<std::string> texts_;
    std::vector<bool> is_used_;      ///< per input
    std::vector<bool> is_measured_;  ///< per predicate
    std::vector<plan::Sample> samples_;
    plan::Evaluator evaluator_;
    std::uint64_t steps_ = 0;
    bool is_ended_ = false;
    std::vector<etlmon::Verdict> verdicts_;  ///< the last ones
    std::optional<plan::FlightRecorder> recorder_;

    /// What happened so far, and who measures it: monitors measure only what they need.
    std::uint64_t history_;
    std::optional<explain::Observations> observations_;
    std::optional<plan::Evaluator> atoms_;
    bool thresholds_moved_ = false;
    std::string explanation_;
};

}  // namespace etlc::library
