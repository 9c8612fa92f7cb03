// same_bits FOLDER: steps random specs through libetlc and by generated classes: every verdict has
// the same bits. Writes the specs, traces and verdicts to FOLDER, for same_bits_test.py: the text
// of spec N, N.etl; the elements of an input at all steps, one trace after the other, and a byte
// per step for its presence, N.INPUT and N.INPUT.present; the verdicts, N.verdicts; the steps of
// each trace, N.episodes; names and numbers of monitors that restart, N.restarts.
#include <etlc.h>
#include <fmt/format.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "driver/restarts_before.hpp"
#include "generated_program.hpp"
#include "generated_wire.hpp"
#include "loading.hpp"
#include "random_spec.hpp"
#include "random_trace.hpp"

namespace etlc::tests {
namespace {

using Formulas = SpecShape::Formulas;

constexpr std::size_t kSteps = 1'000'000;
constexpr std::size_t kStepsPerTrace = 2000;
/// The compiler may not fuse a multiplication with an addition, like etlc.
const Build kBuild{"same_bits", "g++", "-O1 -ffp-contract=off"};

const std::vector<SpecShape> kShapes = {
    {.formulas = Formulas::unnested, .monitors = 5, .depth = 3, .exact = false},
    {.formulas = Formulas::unbounded_nesting, .monitors = 5, .depth = 3},
    {.formulas = Formulas::prefix, .monitors = 4, .depth = 3, .window = 3, .exact = false},
    {.formulas = Formulas::sliding, .monitors = 5, .depth = 3, .window = 3, .missing = 0.4},
    {.formulas = Formulas::mixed, .monitors = 5, .depth = 3, .restarts = 0.9, .missing = 0.4},
};

bool is_ok(etlc_status status) {
    if (status != ETLC_OK) fmt::print("libetlc: {}\n", etlc_message());
    return status == ETLC_OK;
}

/// One spec in libetlc, and its files.
class Opened {
public:
    Opened(const check::Model& model, const std::filesystem::path& folder, std::size_t number)
        : model_(model), stem_(folder / std::to_string(number)) {
        const std::string text(model.file.text());
        etlc_options options = ETLC_OPTIONS;
        options.text = text.c_str();
        options.max_state = options.max_code = options.max_work = std::uint64_t{64} << 20U;
        is_open_ = is_ok(etlc_open(&options, &session_));
        std::ofstream(stem_.string() + ".etl") << text;
        std::ofstream restarts = file(".restarts");
        for (std::size_t m = 0; m < model.monitors.size(); ++m)
            if (model.monitors[m].restarts != check::Restarts::never)
                restarts << model.monitors[m].name << " " << m << "\n";
        for (const check::Input& input : model.inputs) {
            elements_.push_back(file("." + input.name));
            present_.push_back(file("." + input.name + ".present"));
        }
        verdicts_ = file(".verdicts");
        episodes_ = file(".episodes");
    }
    ~Opened() { etlc_close(session_); }
    Opened(const Opened&) = delete;
    Opened& operator=(const Opened&) = delete;

    bool is_open() const { return is_open_; }

    /// Returns whether the trace's verdicts equal the observed ones.
    bool agrees(const reference::Trace& trace, const Observed& observed) {
        if (!is_ok(etlc_reset(session_))) return false;
        std::vector<etlc_verdict> verdicts(model_.monitors.size());
        for (std::size_t n = 0; n < trace.size(); ++n) {
            if (!restart_before(n) || !step(trace[n], verdicts)) return false;
            for (std::size_t m = 0; m < verdicts.size(); ++m)
                if (!is_same(verdicts[place(m)], observed.verdicts[n][m]))
                    return told(n, m, verdicts[place(m)], observed.verdicts[n][m]);
            write(verdicts_, verdicts.data(), verdicts.size() * sizeof verdicts[0]);
        }
        episodes_ << trace.size() << "\n";
        return true;
    }

private:
    std::ofstream file(const std::string& ending) const {
        return std::ofstream(stem_.string() + ending, std::ios::binary);
    }
    static void write(std::ofstream& file, const void* bytes, std::size_t size) {
        file.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
    }

    std::uint32_t place(std::size_t monitor) const {
        std::uint32_t index = 0;
        is_ok(etlc_find(session_, ETLC_MONITORS, model_.monitors[monitor].name.c_str(), &index));
        return index;
    }

    bool restart_before(std::size_t step) const {
        for (std::size_t m = 0; m < model_.monitors.size(); ++m)
            if (model_.monitors[m].restarts != check::Restarts::never && restarts_before(step, m) &&
                !is_ok(etlc_restart(session_, place(m))))
                return false;
        return true;
    }

    bool step(const reference::Step& step, std::vector<etlc_verdict>& verdicts) {
        std::vector<std::string> bytes;
        std::vector<etlc_sample> samples;
        bytes.reserve(step.size());
        for (std::size_t i = 0; i < step.size(); ++i) {
            const check::Input& input = model_.inputs[i];
            const bool is_there = !step[i].empty();
            const std::vector<double> zeros(input.dimension);
            bytes.push_back(encode_sample(input, is_there ? step[i] : zeros));
            write(elements_[i], bytes[i].data(), bytes[i].size());
            present_[i].put(is_there ? 1 : 0);
            const auto type = input.type == check::InputType::boolean ? ETLC_BOOL
                              : input.type == check::InputType::f16   ? ETLC_F16
                              : input.type == check::InputType::i8    ? ETLC_I8
                                                                      : ETLC_F32;
            samples.push_back({is_there ? bytes[i].data() : nullptr, input.dimension,
                               static_cast<std::uint32_t>(type)});
        }
        return is_ok(
            etlc_step(session_, samples.data(), samples.size(), verdicts.data(), verdicts.size()));
    }

    static bool is_same(const etlc_verdict& found, const reference::Verdict& expected) {
        using reference::Status;
        std::uint32_t status = expected.final ? ETLC_FINAL : 0;
        if (expected.status != Status::undecided) status |= ETLC_DECIDED;
        if (expected.status == Status::satisfied) status |= ETLC_SATISFIED;
        if (expected.status == Status::violated) status |= ETLC_VIOLATED;
        if (found.status != status) return false;
        if (expected.status == Status::undecided) return true;
        const float numbers[] = {static_cast<float>(expected.robustness),
                                 static_cast<float>(expected.lower),
                                 static_cast<float>(expected.upper)};
        return std::memcmp(&found, numbers, sizeof numbers) == 0;
    }

    bool told(std::size_t step, std::size_t monitor, const etlc_verdict& found,
              const reference::Verdict& expected) const {
        fmt::print("step {}, {}: libetlc says {} in [{}, {}] ({}), the class {} in [{}, {}]\n{}",
                   step, model_.monitors[monitor].name, found.robustness, found.lower, found.upper,
                   found.status, expected.robustness, expected.lower, expected.upper,
                   model_.file.text());
        return false;
    }

    const check::Model& model_;
    std::filesystem::path stem_;
    etlc_session session_ = 0;
    bool is_open_ = false;
    std::vector<std::ofstream> elements_;
    std::vector<std::ofstream> present_;
    std::ofstream verdicts_;
    std::ofstream episodes_;
};

Request request_for(const check::Model& model, std::uint32_t spec, std::uint64_t round) {
    TraceShape shape{.steps = kStepsPerTrace, .grid = false};
    if (round % 3 > 0) shape.missing = 0.1;
    if (round % 3 > 1) shape.invalid = 0.1;
    const std::uint64_t seed = 1000 * round + spec;
    return {spec, random_trace(model, 2 * seed, shape), random_trace(model, 2 * seed + 1, shape)};
}

int compare(const std::filesystem::path& folder) {
    GeneratedProgram program("same_bits");
    for (std::size_t n = 0; n < kShapes.size(); ++n) {
        const auto model = load(random_spec(4000 + n, kShapes[n]));
        if (!model || !program.add(*model)) return 1;
    }
    if (!program.compile(kBuild)) return 1;
    std::vector<std::unique_ptr<Opened>> opened;
    for (std::size_t n = 0; n < program.size(); ++n) {
        opened.push_back(std::make_unique<Opened>(program.model(n), folder, n));
        if (!opened.back()->is_open()) return 1;
    }
    std::size_t steps = 0;
    for (std::uint64_t round = 0; steps < kSteps; ++round) {
        std::vector<Request> requests;
        for (std::uint32_t n = 0; n < program.size(); ++n)
            requests.push_back(request_for(program.model(n), n, round));
        const auto result = program.run(requests);
        if (result.answers.size() != requests.size()) return 1;
        for (std::size_t n = 0; n < requests.size(); ++n) {
            if (!opened[n]->agrees(requests[n].first, result.answers[n][0]) ||
                !opened[n]->agrees(requests[n].second, result.answers[n][1]))
                return 1;
            steps += requests[n].first.size() + requests[n].second.size();
        }
    }
    fmt::print("{} steps of {} specs agree\n", steps, program.size());
    return 0;
}

}  // namespace
}  // namespace etlc::tests

int main(int argc, char** argv) {
    if (argc == 2) return etlc::tests::compare(argv[1]);
    std::fputs("usage: same_bits FOLDER\n", stderr);
    return 2;
}
