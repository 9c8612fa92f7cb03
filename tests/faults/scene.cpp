#include "scene.hpp"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

namespace etlc::faults {

namespace {

namespace fs = std::filesystem;

constexpr const char* kSpec = R"(spec dock;
rate 10 Hz;
input z : f32[2];
input px : f32;
target goal = [[1, {0}]];
target unused = load("stored.npz", "goal");
predicate near = l2(z, goal) <= 0.5;
truth near = px > 0;
monitor arrive = F near;
sliding monitor close = F[0, 2] near;
)";

constexpr const char* kCalibrated = R"(spec fit;
input z : f32[2];
input px : f32;
target goal = [[1, {0}]];
predicate near = l2(z, goal) <= calibrated(conformal, alpha = 0.5);
truth near = px > 0;
monitor arrive = F near;
)";

constexpr const char* kWhole = R"(spec whole;
input z : f32[2];
input px : f32;
target goal = [[1, {0}]];
predicate near = l2(z, goal) <= 0.5;
truth near = px > 0;
monitor arrive = F near calibrated(conformal, alpha = 0.5, against = missed_success);
)";

constexpr const char* kArrays = R"(spec arrays;
input z_turned : f32[3];
input held : bool;
target origin = [[0, 0, {0}]];
predicate far = l2(z_turned, origin) > 3.5;
monitor m = F (far && held);
)";

constexpr const char* kGroups = R"(spec groups;
input z : f32[3];
target origin = [[0, 0, {0}]];
predicate at_a = l2(z, origin) > 3.5;
monitor m = F at_a;
)";

constexpr const char* kWrong = R"(spec wrong;
input z : f32[2];
monitor m = F neer;
)";

constexpr int kEpisodes = 6;

std::string episode(int e) {
    std::string text = "px,z[0],z[1]\n";
    for (int t = 0; t < 40; ++t) {
        const double px = (t * (e + 3)) % 7 - 3.5;
        text += fmt::format("{},{},{}\n", px, px > 0 || (t + e) % 5 == 0 ? 1.25 + 0.001 * t : 3,
                            1 + 0.01 * e);
    }
    return text;
}

void write_text(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

}  // namespace

std::string read_text(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

Scene::Scene(std::string etlc, const fs::path& data) : etlc_(std::move(etlc)) {
    std::string folder = (fs::temp_directory_path() / "etlc-faults-XXXXXX").string();
    if (::mkdtemp(folder.data()) == nullptr) throw std::runtime_error("no temporary folder");
    counts_ = folder + ".counts";
    folder_ = folder;
    write_inputs(data);
    const std::vector<std::string> episodes = {"--data", "episodes", "-j", "3"};
    const auto with = [](std::vector<std::string> words, const std::vector<std::string>& more) {
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    commands_ = {
        {"compile",
         {"dock.etl", "-o", "dock.hpp", "--inline-targets", "0", "--depfile", "dock.d"},
         {"dock.targets.bin", "dock.d", "dock.hpp"}},
        {"compile to standard output", {"dock.etl", "-o", "-"}, {}},
        {"emit", {"dock.etl", "--emit", "plan", "-o", "dock.plan"}, {"dock.plan"}},
        {"check", {"dock.etl", "--check", "--diagnostics", "json"}, {}},
        {"a wrong spec", {"wrong.etl", "--check"}, {}},
        {"run",
         {"run", "dock.etl", "--trace", "episodes/0.csv", "-o", "verdicts.csv"},
         {"verdicts.csv"}},
        {"run of .npz", {"run", "arrays.etl", "--trace", "trace_stored.npz"}, {}},
        {"run of .h5",
         {"run", "groups.etl", "--trace", "trace.h5:data/demo_1", "--map", "z=obs/z", "-o",
          "h5.csv"},
         {"h5.csv"}},
        {"calibrate", with({"calibrate", "fit.etl"}, episodes), {"fit.thresholds.json"}},
        {"calibrate to standard output", with({"calibrate", "fit.etl", "-o", "-"}, episodes), {}},
        {"calibrate monitors",
         with({"calibrate", "whole.etl"}, episodes),
         {"whole.thresholds.json"}},
        {"evaluate",
         with({"evaluate", "dock.etl", "--json", "all.json", "--csv", "all.csv"}, episodes),
         {"all.json", "all.csv"}},
        {"a file that is no incident",
         {"incident", "stored.npz", "--spec", "groups.etl", "-o", "incident.txt"},
         {}},
        {"help", {"--help"}, {}},
        {"help of a command", {"run", "--help"}, {}},
        {"version", {"--version"}, {}},
    };
    learn();
}

Scene::~Scene() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
    fs::remove(counts_, ignored);
}

void Scene::write_inputs(const fs::path& data) const {
    fs::create_directory(folder_ / "episodes");
    for (int e = 0; e < kEpisodes; ++e)
        write_text(folder_ / "episodes" / fmt::format("{}.csv", e), episode(e));
    for (const char* file : {"stored.npz", "trace_stored.npz", "trace.h5"})
        fs::copy(data / file, folder_ / file);
    write_text(folder_ / "wrong.etl", kWrong);
}

void Scene::write_specs(bool now) const {
    const std::vector<std::pair<const char*, const char*>> specs = {{"dock.etl", kSpec},
                                                                    {"fit.etl", kCalibrated},
                                                                    {"whole.etl", kWhole},
                                                                    {"arrays.etl", kArrays},
                                                                    {"groups.etl", kGroups}};
    for (const auto& [name, text] : specs)
        write_text(folder_ / name, fmt::format(fmt::runtime(text), now ? 1 : 0.75));
}

std::string Scene::write_earlier_spec() {
    write_text(folder_ / "earlier.etl", fmt::format(fmt::runtime(kSpec), 0.75));
    inputs_.emplace_back("earlier.etl");
    return "earlier.etl";
}

void Scene::learn() {
    for (const bool now : {false, true}) {
        write_specs(now);
        for (Command& command : commands_) {
            Surroundings around;
            if (now) around.counts = counts_.string();
            command.undisturbed = run(command, around);
            (now ? command.after : command.before) = written(command);
            if (command.undisturbed.status > 1 || written(command).size() != command.files.size())
                throw std::runtime_error(command.name +
                                         " fails by itself: " + command.undisturbed.error);
            std::istringstream counts(now ? read_text(counts_) : "");
            std::string call;
            for (long n = 0; counts >> call >> n;) command.calls[call] = n;
        }
    }
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
        if (entry.is_regular_file())
            inputs_.push_back(fs::relative(entry.path(), folder_).string());
}

void Scene::restore(const Command& command) const {
    for (const auto& [name, text] : command.before) write_text(folder_ / name, text);
    for (const std::string& name : left_over(command)) fs::remove(folder_ / name);
}

Process Scene::start(const Command& command, const Surroundings& around) const {
    std::vector<std::string> words = {etlc_};
    words.insert(words.end(), command.words.begin(), command.words.end());
    return Process(words, folder_.string(), around);
}

Outcome Scene::run(const Command& command, const Surroundings& around) const {
    return start(command, around).outcome();
}

Files Scene::written(const Command& command) const {
    Files files;
    for (const std::string& name : command.files)
        if (fs::exists(folder_ / name)) files[name] = read_text(folder_ / name);
    return files;
}

std::vector<std::string> Scene::left_over(const Command&) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) {
        const std::string name = entry.path().filename().string();
        if (entry.is_regular_file() &&
            std::find(inputs_.begin(), inputs_.end(), name) == inputs_.end())
            names.push_back(name);
    }
    return names;
}

}  // namespace etlc::faults
