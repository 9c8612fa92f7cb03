#include "report.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "world.hpp"

namespace demo {
namespace {

constexpr int kColumn = 15;  // width of a monitor's column

enum class Colour { none, green, red, yellow, faint };

bool on_terminal() {
    const char* terminal = std::getenv("TERM");
    return isatty(STDOUT_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr &&
           terminal != nullptr && std::string(terminal) != "dumb";
}

std::string painted(const std::string& text, Colour colour, bool enabled) {
    if (!enabled || colour == Colour::none) return text;
    const char* codes[] = {"", "32", "31", "33", "2"};
    return fmt::format("\x1b[{}m{}\x1b[0m", codes[static_cast<int>(colour)], text);
}

/// Returns "yes  3.40 s": the verdict on the whole drive, and when it became final (nothing if only
/// the end of the drive decided it).
std::string cell(const Recording& recording, std::size_t monitor) {
    std::string decided = "";
    for (std::size_t i = 0; i < recording.steps.size(); ++i) {
        if (!recording.steps[i].claims[monitor].final) continue;
        decided = fmt::format("{:5.2f} s", static_cast<double>(i) * kTimeStep);
        break;
    }
    const Step& last = recording.steps.back();
    const bool wrong = last.claims[monitor].satisfied != last.true_so_far[monitor];
    return fmt::format("{:<3} {:<7} {}", last.claims[monitor].satisfied ? "yes" : "no", decided,
                       wrong ? "<>" : "  ");
}

Colour colour_of(const Recording& recording, std::size_t monitor) {
    const Step& last = recording.steps.back();
    if (last.claims[monitor].satisfied != last.true_so_far[monitor]) return Colour::yellow;
    return last.claims[monitor].satisfied ? Colour::green : Colour::none;
}

}  // namespace

Report::Report() : colour_(on_terminal()) {}

void Report::header() const {
    std::string line = fmt::format("{:>5}  {:<18}", "drive", "plan");
    for (const auto& name : kMonitors) line += fmt::format("  {:<{}}", name, kColumn);
    fmt::print("{}\n", painted(line, Colour::faint, colour_));
}

void Report::add(const Recording& recording) {
    ++drives_;
    std::string line = fmt::format("{:>5}  {:<18}", drives_, recording.episode.plan);
    for (std::size_t m = 0; m < kMonitors.size(); ++m) {
        const std::string text = fmt::format("{:<{}}", cell(recording, m), kColumn);
        line += "  " + painted(text, colour_of(recording, m), colour_);
        at_end_[m].count(recording.steps.back().claims[m].satisfied,
                         recording.steps.back().true_so_far[m]);
        for (const Step& step : recording.steps)
            at_steps_[m].count(step.claims[m].satisfied, step.true_so_far[m]);
    }
    for (const Step& step : recording.steps) {
        for (std::size_t p = 0; p < kPredicates.size(); ++p)
            frames_[p].count(step.seen[p], step.true_now[p]);
    }
    if (!colour_) line.erase(line.find_last_not_of(' ') + 1);
    fmt::print("{}\n", line);
}

void Report::summary() const {
    fmt::print("\n{}\n", painted("yes, no: the verdict on the whole drive; the time: when it "
                                 "became final; <>: the truth is the other",
                                 Colour::faint, colour_));
    fmt::print("\n{}\n",
               painted(fmt::format("{:<12}{:>16}{:>17}{:>17}{:>17}", "monitor", "drives agree",
                                   "truly satisfied", "false positives", "false negatives") +
                           fmt::format("{:>15}", "steps agree"),
                       Colour::faint, colour_));
    for (std::size_t m = 0; m < kMonitors.size(); ++m) {
        const Score& end = at_end_[m];
        fmt::print("{:<12}{:>16}{:>17}{:>17}{:>17}{:>13.2f} %\n", kMonitors[m],
                   fmt::format("{} of {}", end.true_positives + end.true_negatives, end.total()),
                   end.positives(), end.false_positives, end.false_negatives,
                   100 * at_steps_[m].agreement());
    }
    fmt::print("\n{}\n",
               painted(fmt::format("{:<12}{:>16}{:>17}{:>17}{:>17}{:>15}", "predicate",
                                   "frames inside", "F1", "precision", "recall", "frames agree"),
                       Colour::faint, colour_));
    for (std::size_t p = 0; p < kPredicates.size(); ++p) {
        const Score& frames = frames_[p];
        fmt::print("{:<12}{:>16}{:>15.3f}{:>15.3f}{:>17.3f}{:>13.2f} %\n", kPredicates[p],
                   fmt::format("{} of {}", frames.positives(), frames.total()), frames.f1(),
                   frames.precision(), frames.recall(), 100 * frames.agreement());
    }
}

}  // namespace demo
