// Compares a step of a batch with the distance kernels alone on the same samples, and with a
// session per environment. bench_batch [ENVIRONMENTS [DIMENSION]]
#include <etlc.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "compile.hpp"
#include "diag/diag.hpp"
#include "plan/targets/kernels.hpp"
#include "timing.hpp"

namespace {

using namespace etlc;

constexpr std::uint32_t kSessions = 100;  // of so many the time is measured, and multiplied

std::vector<float> random_numbers(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> number;
    std::vector<float> numbers(count);
    for (float& one : numbers) one = number(random);
    return numbers;
}

/// A grasp: one distance to a target set, a scalar, and two formulas.
std::string spec_of(std::uint32_t dimension, std::uint32_t rows) {
    std::string text =
        fmt::format("spec reach;\ninput z : f32[{}];\ninput gripper : f32;\n", dimension);
    text += "target goal = [";
    const std::vector<float> numbers = random_numbers(std::size_t{rows} * dimension, 1);
    for (std::uint32_t row = 0; row < rows; ++row) {
        text += row == 0 ? "[" : ", [";
        for (std::uint32_t i = 0; i < dimension; ++i)
            text += fmt::format("{}{}", i == 0 ? "" : ", ", numbers[row * dimension + i]);
        text += "]";
    }
    return text +
           "];\npredicate at_goal = min l2(z, goal) <= 20;\n"
           "monitor careful = G (gripper > 0.5 -> at_goal);\nmonitor arrives = F[0, 30] at_goal;\n";
}

void check(etlc_status status) {
    if (status != ETLC_OK) throw std::runtime_error(etlc_message());
}

class Comparison {
public:
    Comparison(std::uint32_t environments, std::uint32_t dimension, std::uint32_t rows)
        : environments_(environments),
          dimension_(dimension),
          rows_(rows),
          text_(spec_of(dimension, rows)),
          z_(random_numbers(std::size_t{environments} * dimension, 2)),
          gripper_(random_numbers(environments, 3)),
          verdicts_(std::size_t{2} * environments) {
        source::File file("reach.etl", text_);
        diag::Sink sink;
        compiled_ = compile(file, {}, {}, sink);
        if (!compiled_) throw std::runtime_error(diag::render_text(file, sink));
        prepared_ = plan::prepared_rows(*compiled_->model, compiled_->model->distances[0]);
        etlc_options options = ETLC_OPTIONS;
        options.text = text_.c_str();
        sessions_.resize(std::min(environments, kSessions));
        for (etlc_session& session : sessions_) check(etlc_open(&options, &session));
        check(etlc_open_batch(sessions_[0], environments, &batch_));
    }
    ~Comparison() {
        for (const etlc_session session : sessions_) etlc_close(session);
        etlc_close(batch_);
    }
    Comparison(const Comparison&) = delete;
    Comparison& operator=(const Comparison&) = delete;

    void run() {
        const auto series = bench::measure({{"kernels", [&] { kernels(); }, 1},
                                            {"batch", [&] { batch(1); }, 1},
                                            {"2 threads", [&] { batch(2); }, 1},
                                            {"sessions", [&] { each(); }, 1}},
                                           {});
        const double alone = series[0].median(), together = series[1].median();
        std::printf(
            "%5u %9.1f %9.1f %9.2f %9.1f %9.1f\n", rows_, alone / 1e3, together / 1e3,
            together / alone, series[2].median() / 1e3,
            series[3].median() / 1e3 * environments_ / static_cast<double>(sessions_.size()));
    }

private:
    void kernels() {
        const check::Distance& distance = compiled_->model->distances[0];
        for (std::uint32_t e = 0; e < environments_; ++e)
            sum_ += plan::measure(distance, &z_[std::size_t{e} * dimension_], prepared_.data(),
                                  rows_, dimension_, nullptr)
                        .delta;
        if (sum_ < 0) std::abort();
    }
    void batch(std::uint32_t threads) {
        const auto row = static_cast<std::int64_t>(dimension_ * sizeof(float));
        const etlc_grid grids[] = {{z_.data(), nullptr, row, row, dimension_, ETLC_F32},
                                   {gripper_.data(), nullptr, 4, 4, 1, ETLC_F32}};
        check(etlc_run_batch(batch_, grids, 2, 1, threads, verdicts_.data(), verdicts_.size()));
    }
    void each() {
        for (std::uint32_t e = 0; e < sessions_.size(); ++e) {
            const etlc_sample samples[] = {{&z_[std::size_t{e} * dimension_], dimension_, ETLC_F32},
                                           {&gripper_[e], 1, ETLC_F32}};
            check(etlc_step(sessions_[e], samples, 2, &verdicts_[std::size_t{2} * e], 2));
        }
    }

    std::uint32_t environments_, dimension_, rows_;
    std::string text_;
    std::vector<float> z_, gripper_;
    std::vector<etlc_verdict> verdicts_;
    std::optional<Compiled> compiled_;
    std::vector<float> prepared_;
    std::vector<etlc_session> sessions_;
    etlc_session batch_ = 0;
    float sum_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
    const auto environments = static_cast<std::uint32_t>(argc > 1 ? std::atoi(argv[1]) : 1000);
    const auto dimension = static_cast<std::uint32_t>(argc > 2 ? std::atoi(argv[2]) : 512);
    std::printf("%u environments, %u numbers; us a step\n", environments, dimension);
    std::printf("%5s %9s %9s %9s %9s %9s\n", "rows", "kernels", "batch", "ratio", "2 threads",
                "sessions");
    try {
        for (const std::uint32_t rows : {1U, 4U, 16U, 64U})
            Comparison(environments, dimension, rows).run();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
