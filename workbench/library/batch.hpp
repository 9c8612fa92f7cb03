// The states of many environments that share a spec, and the work of stepping them: each thread
// takes a part of the environments, so the results do not depend on the number of threads.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "execute/evaluator.hpp"
#include "library/etlc.h"
#include "library/program.hpp"

namespace etlc::library {

/// Samples of all inputs, in the order of the spec; row by row, and a row step by step. They have
/// been checked.
struct Grids {
    const etlc_grid* grids = nullptr;
    std::uint64_t rows = 0;
    std::uint64_t steps = 0;
};

/// Steps states in one thread.
class Worker {
public:
    explicit Worker(const Program& program);

    /// Steps a state with the samples of a row. `verdicts`: room for those of the row.
    void run(execute::State& state, const Grids& samples, std::uint64_t row,
             etlc_verdict* verdicts);
    /// The same with a copy of the state.
    void imagine(const execute::State& state, const Grids& samples, std::uint64_t row,
                 etlc_verdict* verdicts);

private:
    const float* elements_of(Index input, const void* data);

    const Program& program_;
    execute::Evaluator evaluator_;
    std::vector<execute::SampleView> views_;   ///< per input
    std::vector<std::vector<float>> widened_;  ///< per input; empty: its elements are float32
    std::optional<execute::State> imagined_;
};

/// Workers of a program: one, or as many as some call has asked for.
class Workers {
public:
    explicit Workers(std::shared_ptr<const Program> program) : program_(std::move(program)) {
        workers_.push_back(std::make_unique<Worker>(*program_));
    }

    /// Calls `work(worker, row)` for all rows, in `threads` >= 1 threads.
    template <class Work>
    void each(std::uint64_t rows, std::uint32_t threads, const Work& work);

private:
    std::shared_ptr<const Program> program_;
    std::vector<std::unique_ptr<Worker>> workers_;
};

class Batch {
public:
    Batch(std::shared_ptr<const Program> program, std::uint64_t environments);
    Batch(const Batch& other);
    Batch(Batch&&) = default;
    Batch& operator=(const Batch&) = delete;

    std::uint64_t size() const { return states_.size(); }
    execute::State& state(std::uint64_t environment) { return states_[environment]; }
    const execute::State& state(std::uint64_t environment) const { return states_[environment]; }
    /// Returns the number of steps of an environment's episode.
    std::uint64_t steps(std::uint64_t environment) const;
    bool is_ended(std::uint64_t environment) const { return states_[environment].finished > 0; }

    /// Steps all environments, one per row.
    void run(const Grids& samples, std::uint32_t threads, etlc_verdict* verdicts);
    void finish(std::uint64_t environment, etlc_verdict* verdicts);
    void reset(std::uint64_t environment);
    void restart(std::uint64_t environment, std::size_t monitor);

private:
    std::shared_ptr<const Program> program_;
    std::vector<execute::State> states_;
    Workers workers_;
    execute::Evaluator evaluator_;  ///< for what is done to one environment
};

/// Steps copies of the states, each with `plans` rows. `states`: one or more.
void look_ahead(const std::shared_ptr<const Program>& program,
                const std::vector<const execute::State*>& states, std::uint64_t plans,
                const Grids& samples, std::uint32_t threads, etlc_verdict* verdicts);

}  // namespace etlc::library
