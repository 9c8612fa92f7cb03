// Evaluations as aligned tables for people, with the baselines below each score; as JSON for
// programs and as CSV for spreadsheets, whose keys docs/calibration.md lists. An undefined figure
// is null in JSON and an empty cell in CSV. With several specs, the spec is the first column.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <tuple>

#include "evaluate/evaluate.hpp"
#include "source/text.hpp"

namespace etlc::evaluate {

// ---- tables for people --------------------------------------------------------------------------
// Evaluations for people: aligned columns, with the baselines below each score.

namespace {

using Row = std::vector<std::string>;

constexpr std::size_t kMostEpisodes = 20;  ///< rows of the table by episode

/// Returns the number of code points, by which a terminal aligns.
std::size_t width(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U;
    }));
}

/// Aligns the first column left and the others right, two blanks apart.
std::string aligned(const std::vector<Row>& rows) {
    std::vector<std::size_t> widths;
    for (const Row& row : rows) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
    }
    std::string text;
    for (const Row& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string pad(widths[i] - width(row[i]), ' ');
            line += i == 0 ? row[i] + pad : "  " + pad + row[i];
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

std::string number(const std::optional<double>& value) {
    return value ? fmt::format("{:.3f}", *value) : "-";
}

std::string figure(const Figure& f) {
    if (!f.interval) return number(f.value);
    return fmt::format("{} [{:.3f}, {:.3f}]", number(f.value), f.interval->low, f.interval->high);
}

std::string difference(const Figure& f) {
    if (!f.value) return "-";
    std::string text = fmt::format("{:+.3f}", *f.value);
    if (f.interval) text += fmt::format(" [{:+.3f}, {:+.3f}]", f.interval->low, f.interval->high);
    return text;
}

std::string percent(std::uint64_t part, std::uint64_t whole) {
    if (whole == 0) return "-";
    return fmt::format("{:.2f} %", 100 * static_cast<double>(part) / static_cast<double>(whole));
}

Row heading(const std::string& what, const std::string& positive) {
    return {what, "F1", "precision", "recall", "agreement", positive};
}

void add_figures(std::vector<Row>& rows, const std::string& name, const Score& score) {
    const Counts& c = score.counts;
    Row row{name};
    score.for_each([&](const char*, const Figure& rate) { row.push_back(figure(rate)); });
    row.push_back(
        fmt::format("{} of {} ({})", c.positives(), c.total(), percent(c.positives(), c.total())));
    rows.push_back(std::move(row));
}

void add_baselines(std::vector<Row>& rows, const Score& score) {
    for (auto [what, blind] : baselines(score)) {
        std::replace(what.begin(), what.end(), '_', ' ');
        Row& baseline = rows.emplace_back(Row{"  " + what});
        blind.for_each([&](const char*, const auto& rate) { baseline.push_back(number(rate)); });
    }
}

void add(std::vector<Row>& rows, const std::string& name, const Score& score) {
    add_figures(rows, name, score);
    add_baselines(rows, score);
}

/// Adds a line for cases without a known truth.
void add_remarks(std::string& text, const std::string& name, const Counts& counts,
                 const std::string& unit) {
    if (counts.unlabelled > 0)
        text += fmt::format("{}: {} of unknown truth left out\n", name,
                            diag::counted(counts.unlabelled, unit));
}

/// The unknown predictions beside both errors. Nothing is printed where every prediction is known.
class Errors {
public:
    void add(const std::string& name, const Score& score, const Coverage* coverage = nullptr) {
        const Counts& c = score.counts;
        any_ |= c.unknown() > 0;
        Row row{name};
        score.for_each_error([&](const char*, const Figure& rate) { row.push_back(figure(rate)); });
        if (coverage)
            for (const Figure* share : {&coverage->of_positives, &coverage->of_negatives})
                row.push_back(figure(*share));
        else
            for (const auto& [right, wrong, unknown] :
                 {std::tuple(c.true_positives, c.false_negatives, c.unknown_positives),
                  std::tuple(c.true_negatives, c.false_positives, c.unknown_negatives)})
                row.push_back(fmt::format("{} right, {} wrong, {} unknown", right, wrong, unknown));
        rows_.push_back(std::move(row));
        of_episodes_ = coverage != nullptr;
    }

    std::string text() const {
        if (!any_) return "";
        std::vector<Row> rows{{"unknown, which agrees with nothing", "unknown",
                               "wrong when decided", "false where true", "true where false"}};
        for (const char* of : {"true", "false"})
            rows[0].push_back(of_episodes_ ? fmt::format("episodes, none wrong where {}", of)
                                           : fmt::format("truly {}", of));
        rows.insert(rows.end(), rows_.begin(), rows_.end());
        return aligned(rows);
    }

private:
    std::vector<Row> rows_;
    bool any_ = false;
    bool of_episodes_ = false;
};

std::string predicates_part(const Evaluation& evaluation) {
    std::vector<Row> rows = {heading("predicate, by frames", "frames inside")};
    rows[0].push_back("AUROC");
    rows[0].push_back("episodes without a miss");
    std::string remarks;
    Errors errors;
    for (const PredicateScore& p : evaluation.predicates) {
        const std::size_t first = rows.size();
        add(rows, p.name, p.frames);
        rows[first].push_back(figure(p.auroc));
        rows[first].push_back(figure(p.coverage.of_positives));
        errors.add(p.name, p.frames, &p.coverage);
        add_remarks(remarks, p.name, p.frames.counts, "frame");
        if (p.adaptive)
            remarks += fmt::format(
                "{}: evaluated with its initial threshold, which labels would adapt\n", p.name);
        if (p.arrays > 0)
            remarks +=
                fmt::format("{}: {} of the episodes have an array or a table of its labels\n",
                            p.name, p.arrays);
    }
    return "\n" + aligned(rows) + errors.text() + remarks;
}

std::string monitors_part(const Evaluation& evaluation, const std::string& what,
                          const std::string& positive, Score MonitorScore::*level,
                          const char* unit) {
    std::vector<Row> rows = {heading(what, positive)};
    std::string remarks;
    Errors errors;
    for (const MonitorScore& m : evaluation.monitors) {
        if (!m.lacking.empty()) continue;
        add(rows, m.name, m.*level);
        errors.add(m.name, m.*level, level == &MonitorScore::steps ? &m.coverage : nullptr);
        add_remarks(remarks, m.name, (m.*level).counts, unit);
    }
    return rows.size() == 1 ? "" : "\n" + aligned(rows) + errors.text() + remarks;
}

/// Lists how many variants there are, and the rates of each kind under those of all.
std::string variants_part(const Evaluation& evaluation) {
    std::vector<std::string> made;
    std::vector<std::string> left_out;
    for (const VariantsMade& kind : evaluation.variants) {
        made.push_back(fmt::format("{} {}", kind.made, episodes::name_of(kind.variant)));
        if (kind.left_out > 0)
            left_out.push_back(
                fmt::format("{} {}", kind.left_out, episodes::name_of(kind.variant)));
    }
    std::vector<Row> rows = {heading("monitor, by broken variants", "satisfied")};
    std::string remarks;
    Errors errors;
    for (const MonitorScore& m : evaluation.monitors) {
        if (m.variants.empty()) continue;
        const Score& all = m.variants.back();
        add_figures(rows, m.name, all);
        errors.add(m.name, all);
        for (std::size_t v = 0; v < evaluation.variants.size(); ++v)
            add_figures(rows,
                        fmt::format("  {}", episodes::name_of(evaluation.variants[v].variant)),
                        m.variants[v]);
        add_baselines(rows, all);
        add_remarks(remarks, m.name, all.counts, "variant");
    }
    if (rows.size() == 1) return "";
    std::string text =
        fmt::format("\nbroken variants of the episodes: {}\n", fmt::join(made, ", "));
    if (!left_out.empty())
        text += fmt::format("episodes too short, or without a change of a truth: {}\n",
                            fmt::join(left_out, ", "));
    return text + aligned(rows) + errors.text() + remarks;
}

std::string ordering_part(const Evaluation& evaluation) {
    std::vector<Row> rows = {{"ordering, where all stages were visited", "agreement",
                              "episodes in order", "in another order"}};
    for (const MonitorScore& m : evaluation.monitors)
        if (m.ordering)
            rows.push_back({m.name, figure(m.ordering->agreement),
                            std::to_string(m.ordering->counts.positives()),
                            std::to_string(m.ordering->counts.negatives())});
    return rows.size() == 1 ? "" : "\n" + aligned(rows);
}

std::string steps(const std::optional<double>& value) {
    return value ? fmt::format("{:+.1f}", *value) : "-";
}

std::string detection_part(const Evaluation& evaluation) {
    std::vector<Row> rows = {
        {"time to detection, steps", "true turns", "missed", "early", "median", "mean"}};
    if (evaluation.step_seconds > 0) rows[0].emplace_back("mean, s");
    for (const MonitorScore& m : evaluation.monitors) {
        if (!m.lacking.empty()) continue;
        const Detection& d = m.detection;
        std::string mean = steps(d.mean.value);
        if (d.mean.interval)
            mean += fmt::format(" [{:+.1f}, {:+.1f}]", d.mean.interval->low, d.mean.interval->high);
        rows.push_back({m.name, std::to_string(d.turns), std::to_string(d.missed),
                        std::to_string(d.early), steps(d.median), mean});
        if (evaluation.step_seconds > 0)
            rows.back().push_back(
                d.mean.value ? fmt::format("{:+.3f}", *d.mean.value * evaluation.step_seconds)
                             : "-");
    }
    return rows.size() == 1 ? "" : "\n" + aligned(rows);
}

std::string left_out(const Evaluation& evaluation) {
    std::string text;
    for (const MonitorScore& m : evaluation.monitors) {
        if (m.lacking.empty()) continue;
        std::string names;
        for (const std::string& name : m.lacking) names += (names.empty() ? "" : ", ") + name;
        text += fmt::format("{}: not evaluated, no labels for {}\n", m.name, names);
    }
    return text.empty() ? "" : "\n" + text;
}

/// Lists the number of episodes that each fold held out, and the thresholds from the others.
std::string folds_part(const Evaluation& evaluation) {
    std::vector<Row> rows = {{"fold", "episodes held out"}};
    for (const auto& [name, threshold] : evaluation.folds[0].thresholds)
        rows[0].push_back(fmt::format("{} of the others", name));
    for (std::size_t k = 0; k < evaluation.folds.size(); ++k) {
        const Judgement::Fold& fold = evaluation.folds[k];
        rows.push_back({std::to_string(k + 1), std::to_string(fold.episodes)});
        for (const auto& [name, threshold] : fold.thresholds)
            rows.back().push_back(fmt::format("{:.7g}", threshold));
    }
    return fmt::format(
        "{} folds: every episode is judged by monitors that have not seen its fold; no guarantee "
        "follows\n\n{}",
        evaluation.folds.size(), aligned(rows));
}

std::string by_episode_part(const Evaluation& evaluation) {
    const auto& episodes = evaluation.by_episode;
    std::vector<Row> rows = {{"by episode, the worst first", "frames", "F1", "agreement",
                              "first error", "wrong verdicts"}};
    for (std::size_t i = 0; i < std::min(episodes.size(), kMostEpisodes); ++i) {
        const EpisodeRow& e = episodes[i];
        const Rates of_predictions = rates(e.predictions);
        rows.push_back({e.path, std::to_string(e.frames), number(of_predictions.f1),
                        number(of_predictions.agreement),
                        e.first_error
                            ? fmt::format("step {}: {}", e.first_error->step, e.first_error->name)
                            : "-",
                        e.wrong.empty() ? "-" : fmt::format("{}", fmt::join(e.wrong, ", "))});
    }
    std::string text = "\n" + aligned(rows);
    if (episodes.size() > kMostEpisodes)
        text += fmt::format("{} more are not shown; --json and --csv write all {}\n",
                            episodes.size() - kMostEpisodes, episodes.size());
    return text;
}

std::string tables(const Evaluation& evaluation) {
    const auto& groups = evaluation.groups;
    std::string text = fmt::format(
        "{}{}, {}; in brackets 95 % intervals from {} resamples of the {}\n",
        diag::counted(evaluation.episodes, "episode"),
        groups ? " in " + diag::counted(*groups, "group") : "",
        diag::counted(evaluation.frames, "frame"), kResamples, groups ? "groups" : "episodes");
    if (evaluation.repeated > 0)
        text += fmt::format(
            "{} of the episodes repeat another's content: the intervals are too narrow\n",
            evaluation.repeated);
    if (evaluation.overlapping > 0)
        text += fmt::format(
            "{} of the episodes share most of their content with another: the intervals are too "
            "narrow\n",
            evaluation.overlapping);
    for (const std::string& reservation : evaluation.reservations) text += reservation + "\n";
    if (evaluation.leaked > 0)
        text += fmt::format(
            "{} of the episodes {} a target among the frames: the figures are better than on "
            "others\n",
            evaluation.leaked, evaluation.leaked == 1 ? "has" : "have");
    if (!evaluation.folds.empty()) text += folds_part(evaluation);
    if (!evaluation.predicates.empty()) text += predicates_part(evaluation);
    text +=
        monitors_part(evaluation, "monitor, by steps", "satisfied", &MonitorScore::steps, "step");
    text += monitors_part(evaluation, "monitor, by episodes", "satisfied", &MonitorScore::episodes,
                          "episode");
    text += variants_part(evaluation);
    text += ordering_part(evaluation) + detection_part(evaluation) + left_out(evaluation);
    return evaluation.by_episode.empty() ? text : text + by_episode_part(evaluation);
}

std::string differences_part(const SideBySide::Spec& spec, const std::string& first) {
    std::vector<Row> rows = {{fmt::format("{} less {}", spec.path, first), "F1", "precision",
                              "recall", "agreement", "AUROC"}};
    std::string remarks;
    for (const Difference& d : spec.differences) {
        const std::string name = fmt::format("{}, by {}", d.name, d.level);
        if (d.other_truths > 0) {
            remarks +=
                fmt::format("{}: not compared, {} of the episodes {} a different truth in {}\n",
                            name, d.other_truths, d.other_truths == 1 ? "has" : "have", spec.path);
            continue;
        }
        Row& row = rows.emplace_back(Row{name});
        d.for_each([&](const char*, const Figure& rate) { row.push_back(difference(rate)); });
        row.push_back(d.auroc ? difference(*d.auroc) : "");
    }
    if (spec.differences.empty())
        remarks =
            "nothing to compare: the specs have no predicate or monitor with a truth in common\n";
    return "\n" + aligned(rows) + remarks;
}

}  // namespace

std::string table(const SideBySide& specs) {
    const auto& all = specs.specs;
    if (all.size() == 1) return tables(all[0].evaluation);
    std::string text;
    for (const SideBySide::Spec& spec : all)
        text +=
            fmt::format("{}{}\n{}", text.empty() ? "" : "\n", spec.path, tables(spec.evaluation));
    for (std::size_t s = 1; s < all.size(); ++s) text += differences_part(all[s], all[0].path);
    return text;
}

// ---- JSON and CSV -------------------------------------------------------------------------------

namespace {

/// Joins JSON texts to an array.
std::string array(const std::vector<std::string>& items) {
    return fmt::format("[{}]", fmt::join(items, ", "));
}

/// A JSON object with one member per line.
class Object {
public:
    explicit Object(std::size_t indent) : indent_(indent) {}

    void raw(const std::string& key, const std::string& json) {
        text_ += fmt::format("{}\n{:{}}{}: {}", text_.empty() ? "" : ",", "", indent_ + 2,
                             source::json_string(key), json);
    }
    void operator()(const std::string& key, const std::optional<double>& value) {
        raw(key, value ? fmt::format("{}", *value) : "null");
    }
    void operator()(const std::string& key, const Figure& figure) {
        (*this)(key, figure.value);
        if (figure.interval)
            raw(key + "_interval",
                fmt::format("[{}, {}]", figure.interval->low, figure.interval->high));
    }
    void operator()(const std::string& key, std::unsigned_integral auto count) {
        raw(key, std::to_string(count));
    }
    void operator()(const std::string& key, const std::string& text) {
        raw(key, source::json_string(text));
    }
    void operator()(const std::string& key, const std::vector<std::string>& texts) {
        std::vector<std::string> items;
        for (const std::string& text : texts) items.push_back(source::json_string(text));
        raw(key, array(items));
    }
    void operator()(const std::string& key, const Rates& rates) {
        nested(key, [&](Object& object) { rates.for_each(object); });
    }
    /// Adds an object that `fill(object)` fills.
    template <class Fill>
    void nested(const std::string& key, const Fill& fill) {
        Object object(indent_ + 2);
        fill(object);
        raw(key, object.text());
    }
    /// Adds an array of objects that `fill(object, item)` fills.
    template <class Item, class Fill>
    void nested(const std::string& key, const std::vector<Item>& items, const Fill& fill) {
        std::vector<std::string> objects;
        for (const Item& item : items) {
            Object object(indent_ + 2);
            fill(object, item);
            objects.push_back(object.text());
        }
        raw(key, array(objects));
    }
    std::string text() const {
        return text_.empty() ? "{}" : fmt::format("{{{}\n{:{}}}}", text_, "", indent_);
    }

private:
    std::size_t indent_;
    std::string text_;
};

std::string cell(const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : "";
}

/// Rows `kind,name,level,figure,value,low,high`.
class Rows {
public:
    /// `prefix` begins every row and ends with a comma; `what` is "kind,name,level".
    Rows(std::string& text, const std::string& prefix, const std::string& what)
        : text_(text), prefix_(prefix + what + ",") {}

    void operator()(const std::string& figure, const std::optional<double>& value,
                    const std::optional<Interval>& interval = {}) {
        text_ += fmt::format("{}{},{},{},{}\n", prefix_, figure, cell(value),
                             interval ? fmt::format("{}", interval->low) : "",
                             interval ? fmt::format("{}", interval->high) : "");
    }
    void operator()(const std::string& figure, const Figure& value) {
        (*this)(figure, value.value, value.interval);
    }
    void operator()(const std::string& figure, std::unsigned_integral auto count) {
        text_ += fmt::format("{}{},{},,\n", prefix_, figure, count);
    }
    void operator()(const std::string& name, const Rates& rates) {
        (*this)(name + "_f1", rates.f1);
        (*this)(name + "_agreement", rates.agreement);
    }

private:
    std::string& text_;
    std::string prefix_;
};

// Lists of figures for both formats. JSON has a few more.

template <class To>
void list(To&& to, const Score& score) {
    const Counts& c = score.counts;
    score.for_each(to);
    score.for_each_error(to);
    if constexpr (std::is_same_v<To, Object&>) {
        const auto total = static_cast<double>(c.total());
        to("positive_rate",
           c.total() == 0 ? std::optional<double>{} : static_cast<double>(c.positives()) / total);
        to("positives", c.positives());
        to("negatives", c.negatives());
    }
    for (const auto& [name, count] : kCounts) to(name, c.*count);
    for (const auto& [name, rates] : baselines(score)) to(name, rates);
}

/// Calls `visit(name, score)` for the variants of each kind, then for all, which `all` names.
template <class Visit>
void for_each_variant(const Evaluation& evaluation, const MonitorScore& monitor,
                      const std::string& all, const Visit& visit) {
    for (std::size_t v = 0; v < monitor.variants.size(); ++v) {
        const bool is_kind = v < evaluation.variants.size();
        visit(is_kind ? std::string(episodes::name_of(evaluation.variants[v].variant)) : all,
              monitor.variants[v]);
    }
}

template <class To>
void list(To&& to, const Coverage& coverage) {
    to("coverage", coverage.of_positives);
    to("coverage_of_negatives", coverage.of_negatives);
}

template <class To>
void list(To&& to, const PredicateScore& score) {
    list(to, score.frames);
    to("auroc", score.auroc);
    list(to, score.coverage);
    if constexpr (std::is_same_v<To, Object&>) {
        to("unmeasured", score.unmeasured);
        to("episodes_labelled_by_array", score.arrays);
    }
}

template <class To>
void list(To&& to, const Difference& difference) {
    to("episodes_of_other_truth", difference.other_truths);
    if (difference.other_truths > 0) return;
    difference.for_each(to);
    difference.for_each_error(to);
    if (difference.auroc) to("auroc", *difference.auroc);
}

void fill(Object& to, const Detection& d, double step_seconds) {
    to("turns", d.turns);
    to("missed", d.missed);
    to("early", d.early);
    to("mean_steps", d.mean);
    to("median_steps", d.median);
    if (step_seconds > 0)
        to("mean_seconds",
           d.mean.value ? std::optional(*d.mean.value * step_seconds) : std::nullopt);
}

void fill(Object& to, const MonitorScore& m, const Evaluation& evaluation) {
    to.raw("evaluable", m.lacking.empty() ? "true" : "false");
    if (!m.lacking.empty()) return to("without_truth", m.lacking);
    const auto add_score = [&](const std::string& key, const Score& score) {
        to.nested(key, [&](Object& object) { list(object, score); });
    };
    to("step_agreement", m.steps.agreement);
    to("episode_agreement", m.episodes.agreement);
    if (m.ordering) to("ordering_agreement", m.ordering->agreement);
    to.nested("steps", [&](Object& object) {
        list(object, m.steps);
        list(object, m.coverage);
    });
    add_score("episodes", m.episodes);
    if (m.ordering) add_score("ordering", *m.ordering);
    if (!m.variants.empty())
        to.nested("variants", [&](Object& kinds) {
            for_each_variant(evaluation, m, "all", [&](const std::string& name, const Score& s) {
                kinds.nested(name, [&](Object& object) { list(object, s); });
            });
        });
    to.nested("detection",
              [&](Object& object) { fill(object, m.detection, evaluation.step_seconds); });
}

void fill(Object& to, const Judgement::Fold& fold) {
    to("episodes", fold.episodes);
    to.nested("thresholds", [&](Object& thresholds) {
        for (const auto& [name, threshold] : fold.thresholds)
            thresholds.raw(name,
                           fmt::format("{0}{1}{0}", std::isinf(threshold) ? "\"" : "", threshold));
    });
}

void fill(Object& to, const EpisodeRow& e) {
    const Rates of_predictions = rates(e.predictions);
    to("episode", e.path);
    if (e.fold) to("fold", *e.fold);
    to("frames", e.frames);
    to("wrong_verdicts", e.wrong);
    to("f1", of_predictions.f1);
    to("agreement", of_predictions.agreement);
    if (e.first_error)
        to.nested("first_error", [&](Object& error) {
            error("step", e.first_error->step);
            error(e.first_error->of_monitor ? "monitor" : "predicate", e.first_error->name);
        });
    else
        to.raw("first_error", "null");
    to.nested("predicates", [&](Object& predicates) {
        for (const auto& [name, frames] : e.predicates) predicates(name, rates(frames));
    });
}

void fill(Object& to, const Evaluation& evaluation) {
    to("episodes", evaluation.episodes);
    if (evaluation.groups) to("groups", *evaluation.groups);
    to("frames", evaluation.frames);
    to("repeated_episodes", evaluation.repeated);
    to("leaked_episodes", evaluation.leaked);
    to("overlapping_episodes", evaluation.overlapping);
    to("reservations", evaluation.reservations);
    to("resamples", kResamples);
    const auto filled = [](Object& object, const auto& item) { fill(object, item); };
    if (!evaluation.folds.empty()) to.nested("folds", evaluation.folds, filled);
    if (!evaluation.variants.empty())
        to.nested("variants", [&](Object& all) {
            for (const VariantsMade& kind : evaluation.variants)
                all.nested(std::string(episodes::name_of(kind.variant)), [&](Object& object) {
                    object("made", kind.made);
                    object("without", kind.left_out);
                });
        });
    to.nested("predicates", [&](Object& all) {
        for (const PredicateScore& p : evaluation.predicates)
            all.nested(p.name, [&](Object& object) { list(object, p); });
    });
    to.nested("monitors", [&](Object& all) {
        for (const MonitorScore& m : evaluation.monitors)
            all.nested(m.name, [&](Object& object) { fill(object, m, evaluation); });
    });
    if (!evaluation.by_episode.empty()) to.nested("by_episode", evaluation.by_episode, filled);
}

void add_rows(std::string& text, const std::string& prefix, const Evaluation& evaluation) {
    const auto rows = [&](const std::string& kind, const std::string& name,
                          const std::string& level) {
        return Rows(text, prefix, fmt::format("{},{},{}", kind, name, level));
    };
    for (const PredicateScore& p : evaluation.predicates)
        list(rows("predicate", p.name, "frames"), p);
    for (const MonitorScore& m : evaluation.monitors) {
        if (!m.lacking.empty()) continue;
        list(rows("monitor", m.name, "steps"), m.steps);
        list(rows("monitor", m.name, "steps"), m.coverage);
        Rows episodes = rows("monitor", m.name, "episodes");
        list(episodes, m.episodes);
        episodes("turns", m.detection.turns);
        episodes("turns_missed", m.detection.missed);
        episodes("turns_early", m.detection.early);
        episodes("delay_mean_steps", m.detection.mean);
        episodes("delay_median_steps", m.detection.median);
        if (m.ordering) list(rows("monitor", m.name, "ordering"), *m.ordering);
        for_each_variant(evaluation, m, "variants", [&](const std::string& name, const Score& s) {
            list(rows("monitor", m.name, name), s);
        });
    }
    for (std::size_t k = 0; k < evaluation.folds.size(); ++k) {
        const Judgement::Fold& fold = evaluation.folds[k];
        const std::string number = std::to_string(k + 1);
        rows("fold", number, "")("episodes", fold.episodes);
        for (const auto& [name, threshold] : fold.thresholds)
            rows("fold", number, name.c_str())("threshold", std::optional<double>(threshold));
    }
}

/// Returns the predicates of all specs without repetition, in order of appearance.
std::vector<std::string> predicates_of(const SideBySide& specs) {
    std::vector<std::string> names;
    for (const SideBySide::Spec& spec : specs.specs)
        for (const PredicateScore& p : spec.evaluation.predicates)
            if (std::find(names.begin(), names.end(), p.name) == names.end())
                names.push_back(p.name);
    return names;
}

/// The row ends with F1 and agreement of each of the predicates.
std::string row_of(const EpisodeRow& e, const std::vector<std::string>& predicates) {
    const Rates of_predictions = rates(e.predictions);
    std::string text = fmt::format("{},{},{},{},{},{},{},{},{}", source::csv_cell(e.path),
                                   e.fold ? std::to_string(*e.fold) : "", e.frames, e.wrong.size(),
                                   fmt::join(e.wrong, " "), cell(of_predictions.f1),
                                   cell(of_predictions.agreement),
                                   e.first_error ? std::to_string(e.first_error->step) : "",
                                   e.first_error ? e.first_error->name : "");
    for (const std::string& name : predicates) {
        const auto of = std::find_if(e.predicates.begin(), e.predicates.end(),
                                     [&](const auto& one) { return one.first == name; });
        const Rates here = of == e.predicates.end() ? Rates{} : rates(of->second);
        text += fmt::format(",{},{}", cell(here.f1), cell(here.agreement));
    }
    return text + "\n";
}

}  // namespace

std::string json(const SideBySide& specs) {
    const auto& all = specs.specs;
    Object top(0);
    if (all.size() == 1) {
        fill(top, all[0].evaluation);
        return top.text() + "\n";
    }
    std::vector<std::pair<std::string, Difference>> differences;
    top.nested("specs", [&](Object& evaluations) {
        for (const SideBySide::Spec& spec : all) {
            evaluations.nested(spec.path, [&](Object& one) { fill(one, spec.evaluation); });
            for (const Difference& d : spec.differences) differences.emplace_back(spec.path, d);
        }
    });
    top.nested("differences", differences, [&](Object& object, const auto& difference) {
        const auto& [path, d] = difference;
        object("spec", path);
        object("less", all[0].path);
        object(d.of_monitor ? "monitor" : "predicate", d.name);
        object("level", d.level);
        list(object, d);
    });
    return top.text() + "\n";
}

std::string csv(const SideBySide& specs) {
    const auto& all = specs.specs;
    const bool several = all.size() > 1;
    std::string text = several ? "spec,less," : "";
    text += "kind,name,level,figure,value,low,high\n";
    for (const SideBySide::Spec& spec : all) {
        const std::string path = source::csv_cell(spec.path);
        add_rows(text, several ? path + ",," : "", spec.evaluation);
        for (const Difference& d : spec.differences)
            list(Rows(text, fmt::format("{},{},", path, source::csv_cell(all[0].path)),
                      fmt::format("{},{},{}", d.of_monitor ? "monitor" : "predicate", d.name,
                                  d.level)),
                 d);
    }
    return text;
}

std::string csv_by_episode(const SideBySide& specs) {
    const bool several = specs.specs.size() > 1;
    const std::vector<std::string> predicates = predicates_of(specs);
    std::string text = several ? "spec," : "";
    text += "episode,fold,frames,wrong_verdicts,wrong,f1,agreement,first_error_step,first_error";
    for (const std::string& name : predicates) text += fmt::format(",{0}_f1,{0}_agreement", name);
    text += "\n";
    for (const SideBySide::Spec& spec : specs.specs)
        for (const EpisodeRow& e : spec.evaluation.by_episode)
            text += (several ? source::csv_cell(spec.path) + "," : "") + row_of(e, predicates);
    return text;
}

}  // namespace etlc::evaluate
