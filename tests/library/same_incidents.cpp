// same_incidents FOLDER: steps random specs with a flight recorder through libetlc and by generated
// classes: every incident has the same bytes, and `etlc incident` reads it.
#include <etlc.h>
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
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

constexpr const char* kRecorder = "4,3,5";
/// The compiler may not fuse a multiplication with an addition, like etlc.
const Build kBuild{"same_incidents", "g++", "-O1 -ffp-contract=off"};

const std::vector<SpecShape> kShapes = {
    {.formulas = Formulas::unnested, .monitors = 5, .depth = 3, .exact = false},
    {.formulas = Formulas::sliding, .monitors = 5, .depth = 3, .window = 3, .missing = 0.4},
    {.formulas = Formulas::mixed, .monitors = 5, .depth = 3, .restarts = 0.9, .missing = 0.4},
};
const SpecShape kAdaptive = {
    .formulas = Formulas::mixed, .monitors = 5, .depth = 3, .exact = false};

/// Features that random specs lack: contrasts, also of rows that int8 does not distinguish;
/// expressions with distances and without a name; narrow embeddings; projections; alarms of
/// repeating monitors at every step.
constexpr const char* kAllKinds = R"(spec kinds;
input z : f32[3] hold 1;
input h : f16[2];
input b : i8[2] scale 0.25;
input x : f32 in [-3, 3];
input f : bool hold 1;
input g : bool;
projection P = [[1, 0, 0], [0, 1, 1]];
target t = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
target s = [[1.1, 0.3, 0], [0.2, 1, 0.7]];
target u = [[0, 1], [1, 1], [2, 0]];
target w = [[0, 0], [1, 1]] of P(z);
predicate mapped = min l2(P(z), w) <= 1.5;
predicate third = kth(2) cosine(h, u) <= 0.5;
predicate nearer = min l2(z, t) - min l2(z, s) <= 0.125;
predicate bytes = min linf(b, u) <= 3;
target left = [[0.5, 0.25, 1], [0.501, 0.251, 1.001]];
target right = [[0.5005, 0.2505, 1.0005], [0.502, 0.252, 1.002]];
predicate alike = min l2(z, left) - min l2(z, right) <= 0;
monitor a = G (mapped || third || f);
monitor c = G (min l2(z, t) * 2 - x <= 6 || g);
repeating monitor r = F[0, 2] (nearer && bytes);
repeating monitor q = bytes;
monitor v = G (alike || f || g);
restartable monitor d = G (bytes -> F[0, 2] nearer);
sliding monitor e = G[0, 2] (third || nearer);
)";

bool is_ok(etlc_status status) {
    if (status != ETLC_OK) fmt::print("libetlc: {}\n", etlc_message());
    return status == ETLC_OK;
}

template <class T>
T take(std::string_view& bytes) {
    T value{};
    if (bytes.size() < sizeof value) return value;
    std::memcpy(&value, bytes.data(), sizeof value);
    bytes.remove_prefix(sizeof value);
    return value;
}

class Opened {
public:
    Opened(const check::Model& model, const std::filesystem::path& folder, std::uint32_t targets_as)
        : model_(model), spec_((folder / (model.name + ".etl")).string()) {
        etlc_options options = ETLC_OPTIONS;
        options.path = spec_.c_str();
        options.recorder = kRecorder;
        options.targets_as = targets_as;
        options.max_state = options.max_code = options.max_work = std::uint64_t{64} << 20U;
        is_open_ = is_ok(etlc_open(&options, &session_));
        for (const check::Monitor& monitor : model.monitors) {
            etlc_monitor description{};
            description.struct_size = sizeof description;
            std::uint32_t at = 0;
            is_ok(etlc_find(session_, ETLC_MONITORS, monitor.name.c_str(), &at));
            is_ok(etlc_describe_monitor(session_, at, &description));
            places_.push_back(at);
            horizon_ = std::max(horizon_, description.horizon);
        }
    }
    ~Opened() { etlc_close(session_); }
    Opened(const Opened&) = delete;
    Opened& operator=(const Opened&) = delete;

    bool is_open() const { return is_open_; }
    const std::string& spec() const { return spec_; }

    /// Runs a trace, finishes and resets, like driver/incidents.hpp.
    bool episode(const reference::Trace& trace, const Labels& labels) {
        std::vector<etlc_verdict> verdicts(model_.monitors.size());
        for (std::size_t n = 0; n < trace.size(); ++n)
            if (!(labels.empty() || observe(labels[n])) || !restart_before(n) ||
                !step(trace[n], verdicts))
                return false;
        for (std::uint32_t n = 0; n < horizon_; ++n)
            if (!is_ok(etlc_finish(session_, verdicts.data(), verdicts.size()))) return false;
        return is_ok(etlc_reset(session_));
    }

    /// Returns whether there are as many incidents as in the class.
    bool agrees_on_counts(std::string_view& answer) {
        std::uint32_t complete = 0, lost = 0;
        if (!is_ok(etlc_incidents(session_, &complete, &lost))) return false;
        const auto expected = take<std::uint32_t>(answer);
        const auto expected_lost = take<std::uint32_t>(answer);
        if (complete == expected && lost == expected_lost) return true;
        fmt::print("{}: libetlc has {} incidents and lost {}, the class has {} and lost {}\n",
                   spec_, complete, lost, expected, expected_lost);
        return false;
    }

    /// Returns whether an incident has the class's bytes, and writes them to a file.
    bool agrees(std::uint32_t n, std::string_view& answer, const std::string& path) {
        const auto size = take<std::uint32_t>(answer);
        const std::string_view expected = answer.substr(0, size);
        answer.remove_prefix(expected.size());
        const void* bytes = nullptr;
        std::size_t found_size = 0;
        if (!is_ok(etlc_incident(session_, n, &bytes, &found_size))) return false;
        const std::string_view found(static_cast<const char*>(bytes), found_size);
        std::ofstream(path, std::ios::binary) << found;
        if (found == expected) return true;
        std::ofstream(path + ".expected", std::ios::binary) << expected;
        fmt::print("{}: incident {} of libetlc ({}) has other bytes than the class's\n", spec_, n,
                   path);
        return false;
    }

private:
    bool observe(const std::vector<std::vector<Label>>& labels) {
        for (std::uint32_t p = 0; p < labels.size(); ++p)
            for (const Label& label : labels[p])
                if (model_.predicates[p].threshold.adaptation &&
                    !is_ok(etlc_observe(session_, p, label.distance, label.truth ? 1 : 0)))
                    return false;
        return true;
    }

    bool restart_before(std::size_t step) {
        for (std::size_t m = 0; m < model_.monitors.size(); ++m)
            if (model_.monitors[m].restarts != check::Restarts::never && restarts_before(step, m) &&
                !is_ok(etlc_restart(session_, places_[m])))
                return false;
        return true;
    }

    bool step(const reference::Step& step, std::vector<etlc_verdict>& verdicts) {
        std::vector<std::string> bytes;
        std::vector<etlc_sample> samples;
        bytes.reserve(step.size());
        for (std::uint32_t i = 0; i < step.size(); ++i) {
            etlc_input input{};
            input.struct_size = sizeof input;
            if (!is_ok(etlc_describe_input(session_, i, &input))) return false;
            bytes.push_back(encode_sample(model_.inputs[i], step[i]));
            samples.push_back(
                {step[i].empty() ? nullptr : bytes[i].data(), input.dimension, input.type});
        }
        return is_ok(
            etlc_step(session_, samples.data(), samples.size(), verdicts.data(), verdicts.size()));
    }

    const check::Model& model_;
    std::string spec_;
    etlc_session session_ = 0;
    bool is_open_ = false;
    std::vector<std::uint32_t> places_;
    std::uint32_t horizon_ = 0;
};

Request request_for(const check::Model& model, std::uint32_t spec) {
    const TraceShape shape{.steps = 60, .missing = 0.1, .invalid = 0.05, .grid = false};
    Request request{spec, random_trace(model, 2 * spec, shape),
                    random_trace(model, 2 * spec + 1, shape)};
    request.first_labels = random_labels(model, request.first, 2 * spec);
    request.second_labels = random_labels(model, request.second, 2 * spec + 1);
    for (Labels* labels : {&request.first_labels, &request.second_labels})
        for (auto& step : *labels)
            for (auto& predicate : step)  // libetlc accepts only finite distances
                std::erase_if(predicate, [](const Label& l) { return !std::isfinite(l.distance); });
    return request;
}

/// Compares the program's incidents with those of libetlc; returns how many, or -1.
int compare(GeneratedProgram& program, std::uint32_t targets_as,
            const std::filesystem::path& folder) {
    if (!program.compile(kBuild)) return -1;
    std::vector<Request> requests;
    for (std::uint32_t n = 0; n < program.size(); ++n)
        requests.push_back(request_for(program.model(n), n));
    const auto answers = program.answers(requests);
    if (!answers) return -1;
    std::string_view answer = *answers;
    int incidents = 0;
    for (const Request& request : requests) {
        Opened opened(program.model(request.spec), program.folder(), targets_as);
        if (!opened.is_open() || !opened.episode(request.first, request.first_labels) ||
            !opened.agrees_on_counts(answer) ||
            !opened.episode(request.second, request.second_labels))
            return -1;
        std::string_view counts = answer;
        const auto complete = take<std::uint32_t>(counts);
        if (!opened.agrees_on_counts(answer)) return -1;
        for (std::uint32_t n = 0; n < complete; ++n) {
            const std::string path = (folder / fmt::format("incident{}", incidents++)).string();
            if (!opened.agrees(n, answer, path)) return -1;
            const std::string call = fmt::format(
                "'{}' incident '{}' --spec '{}' --targets-as {} --max-state 67108864 "
                "--max-code 67108864 --max-work 67108864 > '{}.txt'",
                ETLC_COMMAND, path, opened.spec(), targets_as == 0 ? "f32" : "i8", path);
            if (std::system(call.c_str()) != 0) return fmt::print("{} fails\n", call), -1;
        }
    }
    return incidents;
}

int compare_all(const std::filesystem::path& folder) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    const std::string recorder = fmt::format("--recorder {}", kRecorder);
    GeneratedProgram wide("same_incidents", {recorder, "harness::Incidents"});
    for (std::size_t n = 0; n < kShapes.size(); ++n) {
        const auto model = load(random_spec(6000 + n, kShapes[n]));
        if (!model || !wide.add(*model)) return 1;
    }
    const AdaptiveSpec adaptive = random_adaptive_spec(7000, kAdaptive);
    if (!adaptive.model ||
        !wide.add(*adaptive.model, check::Values::robustness, adaptive.thresholds))
        return 1;
    const auto kinds = load(kAllKinds);
    if (!kinds || !wide.add(*kinds)) return 1;
    GeneratedProgram narrow("same_incidents_i8",
                            {recorder + " --targets-as i8", "harness::Incidents"});
    if (!narrow.add(*kinds)) return 1;
    const int of_wide = compare(wide, ETLC_AS_F32, folder);
    if (of_wide < 10) return 1;
    const int of_narrow = compare(narrow, ETLC_AS_I8, folder);
    if (of_narrow < 2) return 1;
    fmt::print("{} incidents are the same\n", of_wide + of_narrow);
    return 0;
}

}  // namespace
}  // namespace etlc::tests

int main(int argc, char** argv) {
    if (argc == 2) return etlc::tests::compare_all(argv[1]);
    std::fputs("usage: same_incidents FOLDER\n", stderr);
    return 2;
}
