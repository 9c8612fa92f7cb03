// same_batch SPECS: environments of a batch have the verdicts of sessions of their own, bit for
// bit, over random specs; with any number of threads, whatever is restarted, reset, finished, saved
// and loaded in between; and looking ahead gives the verdicts of copies that are stepped.
#include <etlc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "all_kinds.hpp"
#include "random_spec.hpp"

namespace {

constexpr uint32_t kEnvironments = 6;
constexpr uint32_t kSteps = 40;
constexpr uint32_t kPlans = 2;
constexpr uint32_t kAhead = 7;

using Verdicts = std::vector<etlc_verdict>;
using Chosen = std::vector<uint8_t>;

void check(etlc_status status) {
    if (status != ETLC_OK) throw std::runtime_error(etlc_message());
}

/// Samples of one input in rows of steps.
struct Column {
    uint32_t type, dimension, steps;
    std::vector<unsigned char> data;
    std::vector<uint8_t> present;

    uint32_t bytes() const { return dimension * (type == ETLC_F32 ? 4 : type == ETLC_F16 ? 2 : 1); }
    etlc_grid grid() const {
        return {data.data(),      present.data(), int64_t{bytes()} * steps,
                int64_t{bytes()}, dimension,      type};
    }
    etlc_sample sample(uint32_t row, uint32_t step) const {
        const size_t at = size_t{row} * steps + step;
        return {present[at] != 0 ? &data[at * bytes()] : nullptr, dimension, type};
    }
};

class Random {
public:
    explicit Random(uint64_t seed) : engine_(seed) {}

    uint32_t below(uint32_t n) { return static_cast<uint32_t>(engine_() % n); }
    Chosen chosen(uint32_t one_in) {
        Chosen result(kEnvironments);
        for (uint8_t& one : result) one = below(one_in) == 0;
        return result;
    }
    Column column(const etlc_input& input, uint32_t rows, uint32_t steps) {
        Column made{input.type, input.dimension, steps, {}, {}};
        const size_t samples = size_t{rows} * steps;
        for (size_t s = 0; s < samples; ++s) {
            made.present.push_back(below(8) != 0);
            for (uint32_t i = 0; i < input.dimension; ++i) append(made, i);
        }
        return made;
    }

private:
    template <class Number>
    static void put(Column& to, Number number) {
        unsigned char bytes[sizeof number];
        memcpy(bytes, &number, sizeof number);
        to.data.insert(to.data.end(), bytes, bytes + sizeof number);
    }
    void append(Column& to, uint32_t element) {
        const uint32_t random = below(1U << 30U);
        if (to.type == ETLC_BOOL) return put(to, static_cast<uint8_t>(random % 2));
        if (to.type == ETLC_F16) return put(to, static_cast<uint16_t>(0x3000 + random % 0x1000));
        if (to.type == ETLC_I8) return put(to, static_cast<int8_t>(random % 256));
        const bool is_nan = element == 0 && below(16) == 0;
        put(to, is_nan ? NAN : static_cast<float>(random % 33) / 4 - 4);
    }

    std::mt19937_64 engine_;
};

/// A spec in two batches, of one thread and of three, and in sessions.
class Spec {
public:
    Spec(const std::string& text, uint64_t seed) : random_(seed) {
        options_.text = text.c_str();
        options_.max_state = options_.max_code = options_.max_work = uint64_t{64} << 20U;
        description_.struct_size = sizeof description_;
        for (etlc_session& session : sessions_) check(etlc_open(&options_, &session));
        for (etlc_session& batch : batches_)
            check(etlc_open_batch(sessions_[0], kEnvironments, &batch));
        check(etlc_describe(batches_[0], &description_));
        for (uint32_t i = 0; i < description_.inputs; ++i) {
            etlc_input& input = inputs_.emplace_back();
            input.struct_size = sizeof input;
            check(etlc_describe_input(batches_[0], i, &input));
        }
        for (uint32_t m = 0; m < description_.monitors; ++m) {
            etlc_monitor monitor{};
            monitor.struct_size = sizeof monitor;
            check(etlc_describe_monitor(batches_[0], m, &monitor));
            if (monitor.restarts != ETLC_NEVER) restartable_.push_back(m);
        }
    }
    ~Spec() {
        for (const etlc_session session : sessions_) etlc_close(session);
        for (const etlc_session batch : batches_) etlc_close(batch);
    }
    Spec(const Spec&) = delete;
    Spec& operator=(const Spec&) = delete;

    /// Throws where they differ.
    void compare() {
        for (uint32_t step = 0; step < kSteps; ++step) {
            if (random_.below(5) == 0) reset();
            if (random_.below(3) == 0) restart();
            if (random_.below(6) == 0) look_ahead();
            if (random_.below(9) == 0) save_and_load();
            take_step();
            measure();
        }
        run();
        finish();
    }

private:
    std::vector<Column> columns(uint32_t rows, uint32_t steps) {
        std::vector<Column> made;
        for (const etlc_input& input : inputs_) made.push_back(random_.column(input, rows, steps));
        return made;
    }
    static std::vector<etlc_grid> grids(const std::vector<Column>& columns) {
        std::vector<etlc_grid> grids;
        for (const Column& column : columns) grids.push_back(column.grid());
        return grids;
    }
    Verdicts room(size_t rows, size_t steps = 1) const {
        return Verdicts(rows * steps * description_.monitors);
    }
    static void expect_same(const Verdicts& found, const Verdicts& expected, const char* what) {
        if (memcmp(found.data(), expected.data(), found.size() * sizeof found[0]) != 0)
            throw std::runtime_error(what);
    }
    void step_alone(etlc_session session, const std::vector<Column>& columns, uint32_t row,
                    uint32_t step, etlc_verdict* verdicts) const {
        std::vector<etlc_sample> samples;
        for (const Column& column : columns) samples.push_back(column.sample(row, step));
        check(etlc_step(session, samples.data(), samples.size(), verdicts, description_.monitors));
    }
    /// Steps both batches and the sessions.
    void take(uint32_t steps) {
        const std::vector<Column> samples = columns(kEnvironments, steps);
        const std::vector<etlc_grid> given = grids(samples);
        Verdicts alone = room(kEnvironments, steps), together = alone;
        for (uint32_t e = 0; e < kEnvironments; ++e)
            for (uint32_t step = 0; step < steps; ++step)
                step_alone(sessions_[e], samples, e, step,
                           &alone[(size_t{e} * steps + step) * description_.monitors]);
        for (uint32_t b = 0; b < 2; ++b) {
            check(etlc_run_batch(batches_[b], given.data(), given.size(), steps, 1 + 2 * b,
                                 together.data(), together.size()));
            expect_same(together, alone, b == 0 ? "one thread" : "three threads");
        }
    }
    void take_step() { take(1); }
    void run() { take(kAhead); }
    void measure() {
        std::vector<etlc_measured> all(kEnvironments);
        for (uint32_t p = 0; p < description_.predicates; ++p) {
            check(etlc_measure_batch(batches_[0], p, all.data(), kEnvironments));
            for (uint32_t e = 0; e < kEnvironments; ++e) {
                etlc_measured alone;
                check(etlc_measure(sessions_[e], p, &alone));
                if (memcmp(&alone, &all[e], sizeof alone) != 0)
                    throw std::runtime_error("a measurement");
            }
        }
    }
    void reset() {
        const Chosen which = random_.chosen(3);
        for (const etlc_session batch : batches_)
            check(etlc_reset_batch(batch, which.data(), kEnvironments));
        for (uint32_t e = 0; e < kEnvironments; ++e)
            if (which[e] != 0) check(etlc_reset(sessions_[e]));
        expect_steps();
    }
    void expect_steps() {
        uint64_t all[kEnvironments], alone = 0;
        check(etlc_steps_batch(batches_[0], all, kEnvironments));
        for (uint32_t e = 0; e < kEnvironments; ++e) {
            check(etlc_steps(sessions_[e], &alone));
            if (alone != all[e]) throw std::runtime_error("a number of steps");
        }
    }
    void restart() {
        if (restartable_.empty()) return;
        const uint32_t monitor = restartable_[random_.below(uint32_t(restartable_.size()))];
        const Chosen which = random_.chosen(2);
        for (const etlc_session batch : batches_)
            check(etlc_restart_batch(batch, monitor, which.data(), kEnvironments));
        for (uint32_t e = 0; e < kEnvironments; ++e)
            if (which[e] != 0) check(etlc_restart(sessions_[e], monitor));
    }
    void look_ahead() {
        const std::vector<Column> samples = columns(kEnvironments * kPlans, kAhead);
        const std::vector<etlc_grid> given = grids(samples);
        Verdicts alone = room(kEnvironments * kPlans, kAhead), ahead = alone;
        for (uint32_t row = 0; row < kEnvironments * kPlans; ++row) {
            etlc_session copy = 0;  // of the session, or of the environment
            check(row % kPlans == 0 ? etlc_copy(sessions_[row / kPlans], &copy)
                                    : etlc_copy_environment(batches_[0], row / kPlans, &copy));
            for (uint32_t step = 0; step < kAhead; ++step)
                step_alone(copy, samples, row, step,
                           &alone[(size_t{row} * kAhead + step) * description_.monitors]);
            check(etlc_close(copy));
        }
        for (const uint32_t threads : {1U, 4U}) {
            check(etlc_ahead(batches_[0], given.data(), given.size(), kPlans, kAhead, threads,
                             ahead.data(), ahead.size()));
            expect_same(ahead, alone, "ahead of a batch");
        }
        const size_t one = size_t{kPlans} * kAhead * description_.monitors;
        ahead.resize(one);
        check(etlc_ahead(sessions_[0], given.data(), given.size(), kPlans, kAhead, 1, ahead.data(),
                         one));
        expect_same(ahead, alone, "ahead of a session");
    }
    /// Goes on with sessions and batches that have loaded the states of the ones before.
    void save_and_load() {
        const auto replace = [&](etlc_session& before, const auto& open) {
            const void* bytes = nullptr;
            size_t size = 0;
            etlc_session after = 0;
            check(open(after));
            check(etlc_save(before, &bytes, &size));
            check(etlc_load(after, bytes, size));
            check(etlc_close(before));
            before = after;
        };
        replace(sessions_[random_.below(kEnvironments)],
                [&](etlc_session& to) { return etlc_open(&options_, &to); });
        replace(batches_[random_.below(2)], [&](etlc_session& to) {
            return etlc_open_batch(sessions_[0], kEnvironments, &to);
        });
    }
    void finish() {
        const Chosen which = random_.chosen(2);
        for (uint32_t n = 0; n <= description_.horizon; ++n) {
            Verdicts alone = room(kEnvironments), together = alone;
            for (uint32_t e = 0; e < kEnvironments; ++e)
                if (which[e] != 0)
                    check(etlc_finish(sessions_[e], &alone[size_t{e} * description_.monitors],
                                      description_.monitors));
            check(etlc_finish_batch(batches_[0], which.data(), kEnvironments, together.data(),
                                    together.size()));
            expect_same(together, alone, "finish");
        }
        expect_steps();
    }

    Random random_;
    etlc_options options_ = ETLC_OPTIONS;
    etlc_description description_{};
    std::vector<etlc_input> inputs_;
    std::vector<uint32_t> restartable_;
    etlc_session sessions_[kEnvironments] = {};
    etlc_session batches_[2] = {};
};

}  // namespace

int main(int argc, char** argv) {
    const uint64_t specs = argc > 1 ? strtoull(argv[1], nullptr, 10) : 0;
    for (uint64_t seed = 0; seed < specs; ++seed) {
        etlc::tests::SpecShape shape =
            etlc::tests::kSmallShapes[seed % std::size(etlc::tests::kSmallShapes)];
        shape.restarts = seed % 2 == 0 ? 0.5 : 0;
        const std::string text =
            seed % 16 == 0 ? etlc::tests::kAllKinds : etlc::tests::random_spec(seed, shape);
        try {
            Spec(text, seed).compare();
        } catch (const std::exception& error) {
            printf("seed %lu: other results: %s\n%s\n", static_cast<unsigned long>(seed),
                   error.what(), text.c_str());
            return 1;
        }
    }
    printf("%lu monitors of %lu specs agree in %lu steps\n",
           static_cast<unsigned long>(specs * kEnvironments), static_cast<unsigned long>(specs),
           static_cast<unsigned long>(specs * kEnvironments * (kSteps + kAhead)));
    return specs > 0 ? 0 : 1;
}
