#include "library/batch.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>
#include <thread>

namespace etlc::library {

namespace {

/// Brings what the next environment needs into the cache while this one is measured: memory is
/// slower than kernels.
void fetch_ahead(const void* data, std::size_t size) {
    constexpr std::size_t kLine = 64, kMost = 64 * kLine;
    if (data == nullptr) return;
    const auto* const first = static_cast<const char*>(data);
    for (std::size_t at = 0; at < std::min(size, kMost); at += kLine)
        __builtin_prefetch(first + at);
}

}  // namespace

Worker::Worker(const Program& program)
    : program_(program),
      evaluator_(program.plan(), program.tables()),
      views_(program.model().inputs.size()),
      widened_(program.model().inputs.size()) {
    for (const Index i : program.plan().inputs) {
        const check::Input& input = program.model().inputs[i];
        if (type_of(input) != ETLC_F32) widened_[i].resize(input.dimension);
    }
}

void Worker::run(execute::State& state, const Grids& samples, std::uint64_t row,
                 etlc_verdict* verdicts) {
    const std::size_t monitors = program_.plan().monitors.size();
    etlc_verdict* to = verdicts + row * samples.steps * monitors;
    evaluator_.use(state);
    for (std::uint64_t step = 0; step < samples.steps; ++step, to += monitors) {
        for (const Index i : program_.plan().inputs) {
            views_[i].elements = elements_of(i, at(samples.grids[i], samples.steps, row, step));
            if (samples.steps == 1 && row + 1 < samples.rows && widened_[i].empty())
                fetch_ahead(at(samples.grids[i], 1, row + 1, 0),
                            program_.model().inputs[i].dimension * sizeof(float));
        }
        std::memcpy(to, evaluator_.step_on(views_.data()).data(), monitors * sizeof *to);
    }
}

void Worker::imagine(const execute::State& state, const Grids& samples, std::uint64_t row,
                     etlc_verdict* verdicts) {
    imagined_ = state;
    run(*imagined_, samples, row, verdicts);
}

/// Returns the elements in float32: in the memory of the caller if they are there.
const float* Worker::elements_of(Index index, const void* data) {
    if (data == nullptr || widened_[index].empty()) return static_cast<const float*>(data);
    widen(program_.model().inputs[index], data, widened_[index].data());
    return widened_[index].data();
}

template <class Work>
void Workers::each(std::uint64_t rows, std::uint32_t threads, const Work& work) {
    while (workers_.size() < threads) workers_.push_back(std::make_unique<Worker>(*program_));
    const auto part = [&](std::uint64_t thread) {
        // Rows and threads are far below 2^32, so the products do not overflow.
        const std::uint64_t end = rows * (thread + 1) / threads;
        for (std::uint64_t row = rows * thread / threads; row < end; ++row)
            work(*workers_[thread], row);
    };
    if (threads == 1) return part(0);
    std::vector<std::exception_ptr> failures(threads);
    const auto guarded = [&](std::uint64_t thread) noexcept {
        try {
            part(thread);
        } catch (...) {
            failures[thread] = std::current_exception();
        }
    };
    std::vector<std::thread> others;
    others.reserve(threads - 1);
    std::uint32_t started = 1;
    try {
        for (; started < threads; ++started) others.emplace_back(guarded, started);
    } catch (const std::system_error&) {  // the system allows no more threads
    } catch (const std::bad_alloc&) {     // nor does memory
    }
    guarded(0);
    for (std::uint32_t thread = started; thread < threads; ++thread) guarded(thread);
    for (std::thread& other : others) other.join();
    for (const std::exception_ptr& failure : failures)
        if (failure) std::rethrow_exception(failure);
}

Batch::Batch(std::shared_ptr<const Program> program, std::uint64_t environments)
    : program_(std::move(program)),
      workers_(program_),
      evaluator_(program_->plan(), program_->tables()) {
    states_.reserve(environments);
    while (states_.size() < environments) states_.push_back(evaluator_.new_state());
}

Batch::Batch(const Batch& other) : Batch(other.program_, other.size()) {
    std::copy(other.states_.begin(), other.states_.end(), states_.begin());
}

std::uint64_t Batch::steps(std::uint64_t environment) const {
    const execute::State& state = states_[environment];
    return state.started ? state.steps + 1 - state.finished : 0;
}

void Batch::run(const Grids& samples, std::uint32_t threads, etlc_verdict* verdicts) {
    workers_.each(samples.rows, threads, [&](Worker& worker, std::uint64_t row) {
        if (row + 1 < states_.size()) fetch_ahead(&states_[row + 1], sizeof(execute::State));
        worker.run(states_[row], samples, row, verdicts);
    });
}

void Batch::finish(std::uint64_t environment, etlc_verdict* verdicts) {
    evaluator_.use(states_[environment]);
    const std::vector<etlmon::Verdict>& last = evaluator_.finish();
    std::memcpy(verdicts, last.data(), last.size() * sizeof *verdicts);
}

void Batch::reset(std::uint64_t environment) {
    evaluator_.use(states_[environment]);
    evaluator_.reset();
}

void Batch::restart(std::uint64_t environment, std::size_t monitor) {
    evaluator_.use(states_[environment]);
    evaluator_.restart(monitor);
}

void look_ahead(const std::shared_ptr<const Program>& program,
                const std::vector<const execute::State*>& states, std::uint64_t plans,
                const Grids& samples, std::uint32_t threads, etlc_verdict* verdicts) {
    Workers workers(program);
    workers.each(samples.rows, threads, [&](Worker& worker, std::uint64_t row) {
        worker.imagine(*states[row / plans], samples, row, verdicts);
    });
}

}  // namespace etlc::library
