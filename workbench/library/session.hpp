// The sessions of the C interface, and the numbers that stand for them.
// Keeps true: a session allocates all memory for its steps when it is opened; a refused call
// changes nothing. A number is never reused, so closed and invalid numbers are detected; looking
// one up takes no lock and allocates no memory.
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

/// An open spec with its monitors.
class Session {
public:
    /// Takes the compiled `file` and its findings. `history`: the number of steps that explain()
    /// can look back at.
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

    /// Returns the place for the next sample of an input, with room for its `values`.
    plan::Sample& sample(Index input) { return samples_[input]; }
    /// Steps the monitors with these samples.
    const std::vector<etlmon::Verdict>& step();
    const std::vector<etlmon::Verdict>& finish();
    void reset();
    void restart(std::size_t monitor);
    void observe(Index predicate, float distance, bool truth);

    /// Returns the recorder; null where the spec was opened without one.
    plan::FlightRecorder* recorder() { return recorder_ ? &*recorder_ : nullptr; }

    /// Says why the last verdict cannot be explained; empty where it can.
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

    /// Observations of the steps so far, and the evaluator that measures them: monitors measure
    /// only what they need.
    std::uint64_t history_;
    std::optional<explain::Observations> observations_;
    std::optional<plan::Evaluator> atoms_;
    bool thresholds_moved_ = false;
    std::string explanation_;
};

struct Slot;

/// A session in use by this thread, or the reason that there is none.
class Held {
public:
    enum class State : std::uint8_t { held, absent, busy };

    explicit Held(std::uint64_t number) noexcept;
    ~Held();
    Held(const Held&) = delete;
    Held& operator=(const Held&) = delete;

    State state() const { return state_; }
    Session* operator->() const { return session_; }
    Session& operator*() const { return *session_; }
    /// Removes the session from its number.
    std::unique_ptr<Session> close();

private:
    Slot* slot_ = nullptr;
    Session* session_ = nullptr;
    State state_ = State::absent;
};

/// Stores a session and returns its number; 0 where there are too many.
std::uint64_t hold(std::unique_ptr<Session> session);

}  // namespace etlc::library
