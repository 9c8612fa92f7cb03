#include "explain/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "source/text.hpp"

namespace etlc::explain {

namespace {

std::string name_of(const Observations& observations, Index atom) {
    if (observations.atoms()[atom].is_predicate) return observations.predicate(atom).shown();
    return observations.model().inputs[observations.atoms()[atom].index].name;
}

/// Returns the threshold of a predicate that decides a sample: of two, that within which it is
/// true, or that beyond which it is false.
float threshold(const Observations& observations, Sample sample) {
    const check::Threshold& of = observations.predicate(sample.atom).threshold;
    return observations.value(sample).high < 0 ? of.value : of.low();
}

/// Returns the distance of a measurement from its threshold.
float margin(const Observations& observations, Sample sample) {
    if (!observations.atoms()[sample.atom].is_predicate) return 0;
    return std::abs(observations.measured(sample) - threshold(observations, sample));
}

/// The nearest row of a distance that takes the minimum.
struct Nearest {
    const check::Distance* distance = nullptr;
    std::uint32_t row = 0;
};

std::vector<Nearest> nearest(const Observations& observations, Sample sample) {
    std::vector<Nearest> result;
    if (!observations.atoms()[sample.atom].is_predicate) return result;
    const std::vector<Index> distances =
        check::measured_targets(observations.model(), observations.predicate(sample.atom));
    for (std::size_t n = 0; n < distances.size(); ++n) {
        const check::Distance& distance = observations.model().distances[distances[n]];
        if (distance.aggregation == check::Aggregation::min)
            result.push_back({&distance, observations.nearest(sample, n)});
    }
    return result;
}

/// The report that both forms print.
class Printed {
protected:
    explicit Printed(const Report& report) : report_(report) {}

    const Report& report_;
    const Explanation& explained_ = report_.explanation;
    const Observations& observations_ = report_.observations;
    const check::Model& model_ = observations_.model();
};

class Text : Printed {
public:
    explicit Text(const Report& report) : Printed(report) {}

    std::string write() {
        head();
        if (explained_.status == Status::unknown) {
            if (explained_.between.empty() || !explained_.missing.empty())
                section("missing samples within reach");
            for (const Interval& i : intervals(observations_, explained_.missing))
                line("{} at {}", name_of(observations_, i.atom), steps(i.first, i.last));
            if (!explained_.between.empty()) section("between two thresholds, within reach");
            for (const Interval& i : intervals(observations_, explained_.between)) between(i);
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
        if (report_.is_final && (explained_.status != Status::unknown || !monitor.sliding))
            text_ += " for good";
        if (explained_.status != Status::unknown)
            text_ += fmt::format(", robustness {}{:.6g}", bound(), explained_.robustness);
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

    void between(const Interval& i) {
        const check::Threshold& of = observations_.predicate(i.atom).threshold;
        const bool upper = observations_.predicate(i.atom).upper_bound();
        line("{} is unknown at {}: {}, called true {} {:.6g}, called false {} {:.6g}",
             name_of(observations_, i.atom), steps(i.first, i.last), measured_numbers(i),
             upper ? "up to" : "from", of.low(), upper ? "beyond" : "below", of.value);
    }

    /// "min l2(z, people) is 0.2 to 0.4, threshold 0.5, nearest row 3"
    std::string measured(const Interval& i) const {
        return fmt::format("{}, threshold {:.6g}{}", measured_numbers(i),
                           threshold(observations_, {i.atom, i.first}), nearest(i));
    }

    std::string measured_numbers(const Interval& i) const {
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
        return text;
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

    std::string text_;
};

std::string number(float value) {
    return std::isfinite(value) ? fmt::format("{:.9g}", value) : "null";
}

/// Infinite numbers are null.
class Json : Printed {
public:
    explicit Json(const Report& report) : Printed(report) {}

    std::string write() const {
        const check::Monitor& monitor = model_.monitors[report_.question.monitor];
        const bool is_known = explained_.status != Status::unknown;
        std::string text = "{\n";
        text += member("monitor", source::json_string(monitor.name));
        text += member("formula", formula(monitor.formula));
        text += member("step", std::to_string(report_.question.step));
        text += member("position", std::to_string(report_.question.position));
        text += member("seconds_per_step",
                       model_.step_seconds > 0 ? fmt::format("{}", model_.step_seconds) : "null");
        text += member("status", source::json_string(word(explained_.status)));
        text += member("final", report_.is_final ? "true" : "false");
        text += member("robustness", is_known ? number(explained_.robustness) : "null");
        text += member("samples", list(intervals(observations_, explained_.samples),
                                       [&](const Interval& i) { return interval(i); }));
        text += member("critical", explained_.critical ? sample(*explained_.critical) : "null");
        text +=
            member("chain", list(explained_.chain, [&](const Link& link) { return linked(link); }));
        text += member("change", explained_.change ? changed(*explained_.change) : "null");
        if (!explained_.between.empty())
            text += member("between", list(intervals(observations_, explained_.between),
                                           [&](const Interval& i) { return between(i); }));
        text +=
            fmt::format("  \"missing\": {}\n}}\n",
                        list(intervals(observations_, explained_.missing), [&](const Interval& i) {
                            return fmt::format("{{{}, \"first\": {}, \"last\": {}}}", named(i.atom),
                                               i.first, i.last);
                        }));
        return text;
    }

private:
    static std::string member(const char* key, const std::string& value) {
        return fmt::format("  \"{}\": {},\n", key, value);
    }

    template <class Items, class Print>
    static std::string list(const Items& items, const Print& print) {
        std::string text;
        for (const auto& item : items) text += (text.empty() ? "\n    " : ",\n    ") + print(item);
        return text.empty() ? "[]" : fmt::format("[{}\n  ]", text);
    }

    std::string formula(Index index) const {
        return source::json_string(check::shown(model_, index));
    }
    std::string named(Index atom) const {
        return fmt::format("\"name\": {}", source::json_string(name_of(observations_, atom)));
    }

    /// Prints a measurement; null where the sample is missing.
    std::string measured(Sample at) const {
        if (observations_.is_missing(at)) return "null";
        if (observations_.atoms()[at.atom].is_predicate) return number(observations_.measured(at));
        return observations_.measured(at) != 0 ? "true" : "false";
    }
    /// Prints the threshold that decides a sample.
    std::string threshold(Sample at) const {
        return observations_.atoms()[at.atom].is_predicate
                   ? number(explain::threshold(observations_, at))
                   : "null";
    }
    std::string between(const Interval& i) const {
        const check::Threshold& of = observations_.predicate(i.atom).threshold;
        std::string all;
        for (std::uint64_t step = i.first; step <= i.last; ++step)
            all += (step == i.first ? "" : ", ") + measured({i.atom, step});
        return fmt::format(
            "{{{}, \"first\": {}, \"last\": {}, \"inner_threshold\": {}, \"threshold\": {}, "
            "\"measured\": [{}]}}",
            named(i.atom), i.first, i.last, number(of.low()), number(of.value), all);
    }
    std::string nearest(Sample at) const {
        const std::vector<Nearest> rows = explain::nearest(observations_, at);
        if (rows.empty() || observations_.is_missing(at)) return "null";
        if (observations_.predicate(at.atom).plain_distance()) return std::to_string(rows[0].row);
        std::string text;
        for (const Nearest& one : rows)
            text += fmt::format("{}{}: {}", text.empty() ? "" : ", ",
                                source::json_string(one.distance->text), one.row);
        return "{" + text + "}";
    }

    std::string interval(const Interval& i) const {
        std::string all_measured;
        std::string all_nearest;
        for (std::uint64_t step = i.first; step <= i.last; ++step) {
            const char* separator = step == i.first ? "" : ", ";
            all_measured += separator + measured({i.atom, step});
            all_nearest += separator + nearest({i.atom, step});
        }
        return fmt::format(
            "{{{}, \"first\": {}, \"last\": {}, \"holds\": {}, \"threshold\": {}, "
            "\"margin\": {}, \"closest\": {}, \"measured\": [{}], \"nearest\": [{}]}}",
            named(i.atom), i.first, i.last, i.holds ? "true" : "false",
            threshold({i.atom, i.first}),
            i.is_missing ? "null" : number(margin(observations_, {i.atom, i.closest})), i.closest,
            all_measured, all_nearest);
    }

    std::string sample(Sample at) const {
        return fmt::format(
            "{{{}, \"step\": {}, \"measured\": {}, \"threshold\": {}, "
            "\"nearest\": {}}}",
            named(at.atom), at.step, measured(at), threshold(at), nearest(at));
    }

    std::string linked(const Link& link) const {
        return fmt::format("{{\"formula\": {}, \"position\": {}, \"robustness\": {}}}",
                           formula(link.formula), link.position, number(link.robustness));
    }

    std::string changed(const Change& change) const {
        const bool is_predicate = observations_.atoms()[change.sample.atom].is_predicate;
        const std::string other = is_predicate           ? number(change.measured)
                                  : change.measured != 0 ? "true"
                                                         : "false";
        return fmt::format(
            "{{{}, \"step\": {}, \"measured\": {}, \"instead\": {}, \"status\": \"{}\", "
            "\"final\": {}}}",
            named(change.sample.atom), change.sample.step, measured(change.sample), other,
            word(change.status), change.for_good ? "true" : "false");
    }
};

}  // namespace

Report report(const Observations& observations, const ir::Program& program,
              const Question& question, const etlmon::Verdict& verdict) {
    Report result{observations, question, verdict.final(),
                  explain(program, observations, question)};
    const Status status = verdict.satisfied()  ? Status::satisfied
                          : verdict.violated() ? Status::violated
                                               : Status::unknown;
    if (status != result.explanation.status)
        throw std::logic_error("an explanation of another verdict than the monitor's");
    return result;
}

std::vector<Interval> intervals(const Observations& observations,
                                const std::vector<Sample>& samples) {
    std::vector<Sample> order = samples;
    std::sort(order.begin(), order.end(), [](const Sample& a, const Sample& b) {
        return std::tie(a.atom, a.step) < std::tie(b.atom, b.step);
    });
    std::vector<Interval> result;
    for (const Sample& sample : order) {
        const bool holds = observations.value(sample).low >= 0;
        const bool is_missing = observations.is_missing(sample);
        const bool goes_on = !result.empty() && result.back().atom == sample.atom &&
                             result.back().last + 1 == sample.step &&
                             result.back().holds == holds && result.back().is_missing == is_missing;
        if (!goes_on) {
            result.push_back(
                {sample.atom, sample.step, sample.step, holds, is_missing, sample.step});
            continue;
        }
        Interval& interval = result.back();
        interval.last = sample.step;
        if (margin(observations, sample) < margin(observations, {sample.atom, interval.closest}))
            interval.closest = sample.step;
    }
    return result;
}

const char* word(Status status) {
    return status == Status::satisfied  ? "satisfied"
           : status == Status::violated ? "violated"
                                        : "unknown";
}

std::string text(const Report& report) {
    return Text(report).write();
}

std::string json(const Report& report) {
    return Json(report).write();
}

}  // namespace etlc::explain
