// Prints an explanation as text.
#include <fmt/format.h>

#include <algorithm>

#include "explain/report.hpp"

namespace etlc::explain {

namespace {

class Text {
public:
    explicit Text(const Report& report)
        : observations_(report.observations),
          model_(report.observations.model()),
          report_(report),
          explained_(report.explanation) {}

    std::string write() {
        head();
        if (explained_.status == Status::unknown) {
            section("missing samples within reach");
            for (const Interval& i : intervals(observations_, explained_.missing))
                line("{} at {}", name_of(observations_, i.atom), steps(i.first, i.last));
            return std::move(text_);
        }
        section("samples that decide it");
        if (explained_.samples.empty()) line("no sample");
        for (const Interval& i : intervals(observations_, explained_.samples)) interval(i);
        section(*bound() != 0 ? "the bound comes from" : "its robustness comes from");
        critical();
        for (const Link& link : explained_.chain)
            line("{:>10.6g}  {} at {}", link.robustness, check::shown(model_, link.formula),
                 link.position > report_.question.step ? "any later step" : when(link.position));
        section("smallest change that flips it");
        change();
        return std::move(text_);
    }

private:
    template <class... Parts>
    void line(fmt::format_string<Parts...> form, Parts&&... parts) {
        text_ += "  " + fmt::format(form, std::forward<Parts>(parts)...) + "\n";
    }
    void section(const std::string& title) { text_ += title + ":\n"; }

    void head() {
        const check::Monitor& monitor = model_.monitors[report_.question.monitor];
        text_ += fmt::format("{} = {}\n", monitor.name, check::shown(model_, monitor.formula));
        text_ += fmt::format("after {}, about {}: {}", when(report_.question.step),
                             when(report_.question.position), word(explained_.status));
        if (explained_.status != Status::unknown)
            text_ += fmt::format("{}, robustness {}{:.6g}", report_.is_final ? " for good" : "",
                                 bound(), explained_.robustness);
        text_ += "\n";
    }

    /// Qualifies the robustness of a verdict whose value may still change.
    const char* bound() const {
        if (model_.monitors[report_.question.monitor].sliding || !explained_.for_good) return "";
        return explained_.status == Status::satisfied ? "at least " : "at most ";
    }

    /// "step 5 (1.25 s)"
    std::string when(std::uint64_t step) const { return "step " + numbered(step); }
    std::string numbered(std::uint64_t step) const {
        if (model_.step_seconds == 0) return std::to_string(step);
        return fmt::format("{} ({:.6g} s)", step, static_cast<double>(step) * model_.step_seconds);
    }
    std::string steps(std::uint64_t first, std::uint64_t last) const {
        if (first == last) return when(first);
        return fmt::format("steps {} to {}", numbered(first), numbered(last));
    }

    void interval(const Interval& i) {
        const std::string name = name_of(observations_, i.atom);
        if (i.is_missing)
            return line("{} counts as {} at {}: its sample is missing", name,
                        i.holds ? "true" : "false", steps(i.first, i.last));
        if (!observations_.atoms()[i.atom].is_predicate)
            return line("{} is {} at {}", name, i.holds ? "true" : "false", steps(i.first, i.last));
        const float least = margin(observations_, {i.atom, i.closest});
        const std::string by = i.first == i.last ? fmt::format("by {:.6g}", least)
                                                 : fmt::format("by {:.6g} or more, least at {}",
                                                               least, when(i.closest));
        line("{} {} at {} {}: {}", name, i.holds ? "holds" : "fails", steps(i.first, i.last), by,
             measured(i));
    }

    /// "min l2(z, people) 0.2 to 0.4 <= 0.5, nearest row 3"
    std::string measured(const Interval& i) const {
        const check::Predicate& predicate = observations_.predicate(i.atom);
        float low = observations_.measured({i.atom, i.first});
        float high = low;
        for (std::uint64_t step = i.first; step <= i.last; ++step) {
            low = std::min(low, observations_.measured({i.atom, step}));
            high = std::max(high, observations_.measured({i.atom, step}));
        }
        std::string text =
            fmt::format("{} is {:.6g}", check::print(model_, predicate.expression), low);
        if (low < high) text += fmt::format(" to {:.6g}", high);
        text += fmt::format(", threshold {:.6g}", predicate.threshold.value);
        return text + nearest(i);
    }

    /// ", nearest row 3 then"; for several distances ", nearest row 3 of people, 0 of walls".
    std::string nearest(const Interval& i) const {
        const std::vector<Nearest> rows = explain::nearest(observations_, {i.atom, i.closest});
        std::string text;
        for (const Nearest& one : rows) {
            text += fmt::format("{}{}", text.empty() ? ", nearest row " : ", ", one.row);
            if (!observations_.predicate(i.atom).plain_distance())
                text += " of " + model_.targets[one.distance->target].name;
        }
        return text.empty() || i.first == i.last ? text : text + " then";
    }

    void critical() {
        if (!explained_.critical)
            return line("no sample: an empty window, a constant, or the end of a range");
        const Sample& sample = *explained_.critical;
        const std::string name = name_of(observations_, sample.atom);
        if (observations_.is_missing(sample))
            return line("{} at {}, which is missing", name, when(sample.step));
        line("{} at {}", name, when(sample.step));
    }

    void change() {
        if (!explained_.change) return line("no other measurement at a single step does");
        const Change& change = *explained_.change;
        const Index atom = change.sample.atom;
        const std::string then =
            fmt::format("{}{}", word(change.status),
                        change.for_good                      ? " for good"
                        : change.status == explained_.status ? ", but no longer for good"
                                                             : "");
        if (!observations_.atoms()[atom].is_predicate)
            return line("{} {} at {}: {}", name_of(observations_, atom),
                        change.measured != 0 ? "true" : "false", when(change.sample.step), then);
        line("{} {:.9g} instead of {:.9g} at {}: {}",
             check::print(model_, observations_.predicate(atom).expression), change.measured,
             observations_.measured(change.sample), when(change.sample.step), then);
    }

    const Observations& observations_;
    const check::Model& model_;
    const Report& report_;
    const Explanation& explained_;
    std::string text_;
};

}  // namespace

std::string text(const Report& report) {
    return Text(report).write();
}

}  // namespace etlc::explain
