// The sessions of the C interface: an open spec with the state of its monitors, or of those of a
// batch of environments.
// Keeps true: a session allocates all memory for its steps when it is opened; a refused call
// changes nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "etlmon/temporal/verdict.hpp"
#include "execute/evaluator.hpp"
#include "execute/flight_recorder.hpp"
#include "explain/observations.hpp"
#include "library/batch.hpp"
#include "library/program.hpp"

namespace etlc::library {

class Session {
public:
    /// `history`: the number of steps that explain() can look back at.
    Session(std::shared_ptr<const Program> program, std::uint64_t history);
    /// Makes a session for a batch of environments before their first step.
    Session(std::shared_ptr<const Program> program, Batch batch);
    /// Makes a session for one environment of a batch, as it is now.
    Session(std::shared_ptr<const Program> program, const Batch& batch, std::uint64_t environment);
    /// Copies a session, which goes on apart from it.
    explicit Session(const Session& other);
    Session& operator=(const Session&) = delete;

    const std::shared_ptr<const Program>& program() const { return program_; }
    const plan::Plan& plan() const { return program_->plan(); }
    const check::Model& model() const { return program_->model(); }
    execute::Evaluator& evaluator() { return evaluator_; }
    std::uint64_t steps() const { return steps_; }
    bool is_ended() const { return is_ended_; }
    const etlmon::Verdict& verdict(std::size_t monitor) const { return verdicts_[monitor]; }

    /// Returns the batch; null for a session of one environment.
    Batch* batch() { return batch_ ? &*batch_ : nullptr; }
    const Batch* batch() const { return batch_ ? &*batch_ : nullptr; }

    /// Returns the place for the next sample of an input, with room for its `values`.
    execute::Sample& sample(Index input) { return samples_[input]; }
    /// Steps the monitors with these samples.
    const std::vector<etlmon::Verdict>& step();
    const std::vector<etlmon::Verdict>& finish();
    void reset();
    void restart(std::size_t monitor);
    void observe(Index predicate, float distance, bool truth);

    /// Returns the recorder; null where the spec was opened without one.
    execute::FlightRecorder* recorder() { return recorder_ ? &*recorder_ : nullptr; }

    /// Says why the last verdict cannot be explained; empty where it can.
    std::string why_unexplained() const;
    const std::string& explain(std::size_t monitor, bool as_json);

    /// Writes the state of the monitors, with the history; not a recorder.
    const std::vector<std::uint8_t>& save();
    /// Takes the state that save() wrote; returns what is wrong with it, and changes nothing then.
    std::string load(std::span<const std::uint8_t> bytes);

private:
    void make_room();
    void write_state(std::vector<std::uint8_t>& bytes) const;
    bool read_state(std::span<const std::uint8_t>& bytes);

    std::shared_ptr<const Program> program_;
    std::vector<execute::Sample> samples_;
    execute::Evaluator evaluator_;
    std::uint64_t steps_ = 0;
    bool is_ended_ = false;
    std::vector<etlmon::Verdict> verdicts_;  ///< the last ones
    std::optional<execute::FlightRecorder> recorder_;
    std::optional<Batch> batch_;

    /// Observations of the steps so far, and the evaluator that measures them: monitors measure
    /// only what they need.
    std::uint64_t history_ = 0;
    std::optional<explain::Observations> observations_;
    std::optional<execute::Evaluator> atoms_;
    bool thresholds_moved_ = false;
    std::string explanation_;
    std::vector<std::uint8_t> saved_;
};

// The numbers that stand for sessions.
// Keeps true: a number is never reused, so closed and invalid numbers are detected; looking one up
// takes no lock and allocates no memory.

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
