// Prints an explanation as JSON; docs/explanations.md lists the keys. Infinite numbers are null.
#include <fmt/format.h>

#include <cmath>

#include "explain/report.hpp"
#include "source/text.hpp"

namespace etlc::explain {

namespace {

std::string number(float value) {
    return std::isfinite(value) ? fmt::format("{:.9g}", value) : "null";
}

class Json {
public:
    explicit Json(const Report& report)
        : observations_(report.observations),
          model_(report.observations.model()),
          report_(report),
          explained_(report.explanation) {}

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
    std::string threshold(Index atom) const {
        return observations_.atoms()[atom].is_predicate
                   ? number(observations_.predicate(atom).threshold.value)
                   : "null";
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
            named(i.atom), i.first, i.last, i.holds ? "true" : "false", threshold(i.atom),
            i.is_missing ? "null" : number(margin(observations_, {i.atom, i.closest})), i.closest,
            all_measured, all_nearest);
    }

    std::string sample(Sample at) const {
        return fmt::format(
            "{{{}, \"step\": {}, \"measured\": {}, \"threshold\": {}, "
            "\"nearest\": {}}}",
            named(at.atom), at.step, measured(at), threshold(at.atom), nearest(at));
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

    const Observations& observations_;
    const check::Model& model_;
    const Report& report_;
    const Explanation& explained_;
};

}  // namespace

std::string json(const Report& report) {
    return Json(report).write();
}

}  // namespace etlc::explain
