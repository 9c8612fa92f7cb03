#include "fit/suggest/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>

#include "check/guarantees/provenance.hpp"
#include "data/text/text.hpp"
#include "episodes/admission/admission.hpp"
#include "fit/separation.hpp"
#include "plan/budget/budget.hpp"

namespace etlc::fit {

namespace {

using check::Predicate;
using diag::Code;

// The distances to try for a predicate, with the declarations that they need, as lines of a spec.
// Names are new, and equal declarations are made once.

bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Returns all words of a spec, which include its names.
std::set<std::string> words_of(std::string_view spec) {
    std::set<std::string> result;
    auto begin = std::find_if(spec.begin(), spec.end(), is_word);
    while (begin != spec.end()) {
        const auto end = std::find_if_not(begin, spec.end(), is_word);
        result.emplace(begin, end);
        begin = std::find_if(end, spec.end(), is_word);
    }
    return result;
}

/// Declarations under names that start with a prefix.
class Declarations {
public:
    /// Avoids the names in `taken`, and adds its own to them; `taken` outlives this.
    Declarations(std::string prefix, std::set<std::string>& taken)
        : prefix_(std::move(prefix)), taken_(taken) {}

    /// Returns a new name.
    std::string unused(const std::string& wanted) {
        std::string result = wanted;
        for (int number = 2; !taken_.insert(result).second; ++number)
            result = fmt::format("{}_{}", wanted, number);
        return result;
    }

    /// Returns the name of `kind NAME = text;`, and declares it, with the role as its end, if it is
    /// new.
    std::string name(const std::string& kind, const std::string& role, const std::string& text) {
        for (const Declared& one : declared_)
            if (one.kind == kind && one.text == text) return one.name;
        declared_.push_back({kind, text, unused(prefix_ + "_" + role)});
        lines_.push_back(fmt::format("{} {} = {};", kind, declared_.back().name, text));
        return declared_.back().name;
    }

    const std::vector<std::string>& lines() const { return lines_; }

private:
    struct Declared {
        std::string kind, text, name;
    };

    std::string prefix_;
    std::set<std::string>& taken_;
    std::vector<Declared> declared_;
    std::vector<std::string> lines_;
};

/// The parts of a candidate, in words of the language.
struct Candidate {
    std::string_view map;       ///< method of the projection; empty: none
    std::uint32_t r = 0;        ///< its rows
    bool discriminant = false;  ///< a discriminant of the projection, or of the point
    std::string_view targets;   ///< method of the targets
    std::uint32_t k = 0;        ///< their rows; 0: one
    std::string_view distance;  ///< "mahalanobis": by the fitted metric
    bool contrast =
        false;  ///< minus the same distance to the frames at which the predicate does not hold
};

constexpr std::uint32_t kFew = 16;
constexpr std::uint32_t kMany = 64;
/// The largest point for a full metric: a step would compare the square of its elements, and a
/// discriminant separates as well for far less.
constexpr std::uint32_t kLargestMetric = 512;

// map, r, discriminant, targets, k, distance, contrast
constexpr Candidate kCandidates[] = {
    {"", 0, false, "mean", 0, "l2", false},
    {"", 0, false, "mean", 0, "l2sq", true},
    {"", 0, false, "medoids", 8, "l2", false},
    {"", 0, false, "medoids", 8, "l2", true},
    {"", 0, false, "kmeans", 32, "l2", true},
    {"", 0, false, "mean", 0, "cosine", true},
    {"", 0, false, "medoids", 8, "cosine", false},
    {"", 0, false, "medoids", 8, "cosine", true},
    {"", 0, false, "mean", 0, "mahalanobis", false},
    {"", 0, false, "mean", 0, "mahalanobis", true},
    {"", 0, true, "mean", 0, "l2", false},
    {"", 0, true, "mean", 0, "l2sq", true},
    {"pca", kFew, false, "medoids", 8, "l2", true},
    {"pca", kFew, false, "kmeans", 32, "l2", true},
    {"pca", kMany, false, "kmeans", 32, "l2", true},
    {"whitened_pca", kFew, false, "mean", 0, "l2", false},
    {"whitened_pca", kFew, false, "medoids", 8, "l2", true},
    {"whitened_pca", kFew, false, "kmeans", 32, "l2", true},
    {"whitened_pca", kMany, false, "mean", 0, "l2", false},
    {"whitened_pca", kMany, false, "medoids", 8, "l2", true},
    {"whitened_pca", kMany, false, "kmeans", 32, "l2", true},
    {"pca", kFew, true, "mean", 0, "l2sq", true},
    {"pca", kMany, true, "mean", 0, "l2sq", true},
};

/// Returns the candidates that fit a point of this dimension.
std::vector<Candidate> candidates(std::uint32_t dimension) {
    std::vector<Candidate> result;
    for (const Candidate& candidate : kCandidates)
        if (candidate.r < dimension &&
            (candidate.distance != "mahalanobis" || dimension <= kLargestMetric))
            result.push_back(candidate);
    return result;
}

std::string distance_to(const Candidate& candidate, const std::string& point,
                        const std::string& metric, const std::string& targets) {
    return fmt::format("{}{}({}, {})", candidate.k > 0 ? "min " : "", metric, point, targets);
}

std::string targets_at(const Candidate& candidate, const std::string& point,
                       const std::string& where) {
    return fmt::format("fitted({}, {}of = {}, where = {})", candidate.targets,
                       candidate.k > 0 ? fmt::format("k = {}, ", candidate.k) : "", point, where);
}

/// Describes a candidate: "min l2(pca 16(z), 8 medoids), contrast".
std::string described(const Candidate& candidate, const std::string& point) {
    std::string from = point;
    if (!candidate.map.empty()) from = fmt::format("{} {}({})", candidate.map, candidate.r, from);
    if (candidate.discriminant) from = fmt::format("discriminant({})", from);
    return distance_to(candidate, from, std::string(candidate.distance),
                       candidate.k > 0 ? fmt::format("{} {}", candidate.k, candidate.targets)
                                       : std::string(candidate.targets)) +
           (candidate.contrast ? ", contrast" : "");
}

/// Returns the distance of the candidate, from `point`, to frames at which `predicate` holds.
std::string expression(const Candidate& candidate, const std::string& point,
                       const std::string& predicate, Declarations& declarations) {
    std::string from = point;
    if (!candidate.map.empty())
        from =
            fmt::format("{}({})",
                        declarations.name("projection", "space",
                                          fmt::format("fitted({}, r = {}, of = {}, where = true)",
                                                      candidate.map, candidate.r, from)),
                        from);
    if (candidate.discriminant)
        from = fmt::format(
            "{}({})",
            declarations.name(
                "projection", "side",
                fmt::format("fitted(discriminant, r = 1, of = {}, where = {})", from, predicate)),
            from);
    std::string metric(candidate.distance);
    if (metric == "mahalanobis")
        metric += fmt::format("(fitted(discriminant, of = {}, where = {}))", from, predicate);
    const std::string to =
        distance_to(candidate, from, metric,
                    declarations.name("target", "inside", targets_at(candidate, from, predicate)));
    if (!candidate.contrast) return to;
    return to + " - " +
           distance_to(candidate, from, metric,
                       declarations.name("target", "outside",
                                         targets_at(candidate, from, "!" + predicate)));
}

std::optional<Index> predicate_named(const check::Model& model, const std::string& name) {
    for (Index i = 0; i < model.predicates.size(); ++i)
        if (model.predicates[i].name == name) return i;
    return std::nullopt;
}

bool refuse(const check::Model& model, const std::string& name, const std::string& why,
            diag::Sink& sink) {
    const auto predicate = predicate_named(model, name);
    sink.report(Code::nothing_to_suggest,
                predicate ? model.predicates[*predicate].span : model.monitors.front().span,
                fmt::format("no suggestion for '{}': {}", name, why));
    return false;
}

/// Returns the predicates to suggest for, in the order of the model; none where there is something
/// to suggest for monitors alone.
std::optional<std::vector<Index>> asked_for(const check::Model& model,
                                            const std::vector<std::string>& names,
                                            const std::vector<Index>& labelled, bool of_monitors,
                                            diag::Sink& sink) {
    std::vector<Index> result;
    bool all = true;
    for (const std::string& name : names) {
        const auto predicate = predicate_named(model, name);
        if (!predicate) {
            std::vector<std::string> known;
            for (const Predicate& one : model.predicates)
                if (!one.name.empty()) known.push_back(one.name);
            const auto meant = diag::nearest_name(name, known);
            all = refuse(model, name,
                         "there is no such predicate" +
                             (meant ? fmt::format("; did you mean '{}'?", *meant) : ""),
                         sink);
        } else if (std::find(labelled.begin(), labelled.end(), *predicate) == labelled.end()) {
            all = refuse(model, name, "it has neither a truth nor labels in the episodes", sink);
        } else if (!plain_need(model, *predicate)) {
            all = refuse(model, name, "it measures from no point, or from several", sink);
        } else {
            result.push_back(*predicate);
        }
    }
    if (!all) return std::nullopt;
    for (const Index predicate : labelled)
        if (names.empty() && plain_need(model, predicate)) result.push_back(predicate);
    if (result.empty() && names.empty() && of_monitors) return result;
    if (result.empty()) {
        sink.report(Code::nothing_to_suggest, model.monitors.front().span,
                    "no predicate of this spec has labels and measures from one point");
        return std::nullopt;
    }
    return result;
}

/// Declares the predicate, with its threshold where that is calibrated; a literal is on another
/// scale.
std::string predicate_line(const Predicate& predicate, const std::string& expression) {
    const bool calibrated = predicate.threshold.origin != check::ThresholdOrigin::literal;
    return fmt::format("predicate {} = {} <= {}{};", predicate.name, expression,
                       calibrated ? predicate.threshold.text : "calibrated(f1)",
                       predicate.missing ? fmt::format(" missing {}", *predicate.missing) : "");
}

std::string with_lines(std::string_view spec, const std::vector<std::string>& lines) {
    return fmt::format("{}\n{}\n", spec, fmt::join(lines, "\n"));
}

/// One spec with all candidates beside its own declarations.
class Trials {
public:
    Trials(const check::Model& model, const CheckText& check_text)
        : model_(model),
          check_text_(check_text),
          words_(words_of(model.file.text())),
          taken_(words_) {}

    /// Adds the predicate itself, and every candidate that the language allows.
    Suggestions add(Index predicate) {
        const Predicate& own = model_.predicates[predicate];
        Suggestions result{own.name, {}, 0};
        result.ranked.push_back({own.text.substr(0, own.text.rfind(' ', own.text.size() - 2)),
                                 {},
                                 plan::elements_of(model_, predicate)});
        measured_.push_back({own.name, own.name});
        const check::Point& point = model_.points[plain_need(model_, predicate)->point];
        Declarations shared(own.name, taken_);
        for (const Candidate& candidate : candidates(point.dimension)) {
            auto suggestion = suggestion_of(candidate, point.text, own);
            if (!suggestion) continue;
            const std::string trial = shared.unused(own.name + "_trial");
            const std::string distance = expression(candidate, point.text, own.name, shared);
            trials_.push_back(fmt::format("predicate {} = {} <= 0;", trial, distance));
            measured_.push_back({trial, own.name});
            result.ranked.push_back(std::move(*suggestion));
        }
        lines_.insert(lines_.end(), shared.lines().begin(), shared.lines().end());
        return result;
    }

    /// Returns the spec. Each candidate alone is valid; all together may exceed the limits.
    std::optional<check::Model> spec() const {
        std::vector<std::string> lines = lines_;
        lines.insert(lines.end(), trials_.begin(), trials_.end());
        return check_text_(with_lines(model_.file.text(), lines));
    }

    /// Returns the predicates to measure, in the order in which they were added.
    std::vector<Measured> measured(const check::Model& spec) const {
        std::vector<Measured> result;
        for (const auto& [trial, label] : measured_)
            result.push_back({*predicate_named(spec, trial), *predicate_named(spec, label)});
        return result;
    }

private:
    /// Returns nothing where the candidate is invalid, such as cosine of scalars that may be
    /// missing.
    std::optional<Suggestion> suggestion_of(const Candidate& candidate, const std::string& point,
                                            const Predicate& predicate) const {
        std::set<std::string> taken = words_;
        Declarations declarations(predicate.name, taken);
        Suggestion result;
        result.distance = described(candidate, point);
        const std::string distance = expression(candidate, point, predicate.name, declarations);
        result.lines = declarations.lines();
        const std::string trial = declarations.unused(predicate.name + "_trial");
        std::vector<std::string> lines = result.lines;
        lines.push_back(fmt::format("predicate {} = {} <= 0;", trial, distance));
        const auto spec = check_text_(with_lines(model_.file.text(), lines));
        if (!spec) return std::nullopt;
        result.elements = plan::elements_of(*spec, *predicate_named(*spec, trial));
        result.lines.push_back(predicate_line(predicate, distance));
        return result;
    }

    const check::Model& model_;
    const CheckText& check_text_;
    const std::set<std::string> words_;  ///< words of the spec
    std::set<std::string> taken_;        ///< with the names declared since
    std::vector<std::string> lines_;
    std::vector<std::string> trials_;
    std::vector<std::pair<std::string, std::string>> measured_;  ///< predicate, and whose labels
};

/// Returns why some fold cannot be fitted for the predicate; empty where all can.
std::string why_not(const std::vector<Filled>& folds, Index predicate) {
    for (const Filled& fold : folds)
        if (const auto refused = refused_for(fold, predicate))
            return fmt::format("'{}': {}", fold.model.fitted[*refused].declaration,
                               fold.refusals.at(*refused).message);
    return "";
}

episodes::Interval ends_of(const episodes::Figure& auroc) {
    return auroc.interval.value_or(episodes::Interval{*auroc.value, *auroc.value});
}

void rank(Suggestions& all) {
    std::stable_sort(all.ranked.begin(), all.ranked.end(),
                     [](const Suggestion& a, const Suggestion& b) {
                         if (a.auroc.value != b.auroc.value) return a.auroc.value > b.auroc.value;
                         return a.elements < b.elements;
                     });
    std::uint64_t cheapest = std::numeric_limits<std::uint64_t>::max();
    for (Suggestion& one : all.ranked) {
        one.ties =
            one.auroc.value && ends_of(one.auroc).high >= ends_of(all.ranked.front().auroc).low;
        if (one.ties) cheapest = std::min(cheapest, one.elements);
    }
    for (std::size_t i = all.ranked.size(); i-- > 0;)
        if (all.ranked[i].ties && all.ranked[i].elements <= cheapest + cheapest / 10)
            all.recommended = i;
}

/// Returns nothing after an error.
std::optional<Separations> measure(const check::Model& spec, const std::vector<Measured>& measured,
                                   const Request& request, Suggested& suggested, diag::Sink& sink) {
    fix_order_of_sums();
    const Needs needs = needs_of(spec);
    const auto collection = collect(spec, needs.all, measured, request, sink);
    if (!collection) return std::nullopt;
    const auto recorded = episodes::recorded(collection->recordings.episodes());
    episodes::warn_of_unmarked(recorded, sink);
    episodes::admit(spec, recorded, {}, {}, request.allow_overlap, sink);
    if (sink.has_errors()) return std::nullopt;
    suggested.episodes = collection->recordings.episodes().size();
    for (const episodes::Recorded& episode : collection->recordings.episodes())
        suggested.frames += episode.frames;
    suggested.folds = collection->folds.size();
    if (suggested.folds < 2) {
        sink.report(Code::too_few_frames, spec.monitors.front().span,
                    "suggestions are compared on episodes that nothing was fitted on: that takes "
                    "at least 2; there is 1");
        return std::nullopt;
    }
    Solver solver(*collection, needs);
    const std::vector<Filled> folds = fill_all(spec, solver, false, true, request.jobs).without;
    std::vector<Measured> sound;
    std::vector<std::string> reasons;
    for (const Measured& one : measured) {
        reasons.push_back(why_not(folds, one.predicate));
        if (reasons.back().empty()) sound.push_back(one);
    }
    auto found = separate(folds, solver, sound, request, sink);
    if (!found) return std::nullopt;
    auto next = found->all.begin();
    for (std::size_t i = 0, of = 0, at = 0; i < measured.size(); ++i, ++at) {
        if (at == suggested.of[of].ranked.size()) {
            ++of;
            at = 0;
        }
        Suggestion& suggestion = suggested.of[of].ranked[at];
        suggestion.why_not = reasons[i];
        if (!reasons[i].empty()) continue;
        suggestion.auroc = next++->after;
        if (!suggestion.auroc.value) suggestion.why_not = "no fold has frames of both classes";
    }
    return found;
}

}  // namespace

std::optional<Suggested> suggest(const check::Model& model, const CheckText& check_text,
                                 const std::vector<std::string>& names, bool of_monitors,
                                 const Request& request, diag::Sink& sink) {
    const auto labelled = episodes::labelled_in(model, request.episodes.front(), request.reading);
    if (!labelled) {
        sink.report(recordings::in_trace(labelled.failure(), request.episodes.front()));
        return std::nullopt;
    }
    const auto predicates = asked_for(model, names, *labelled, of_monitors, sink);
    if (!predicates) return std::nullopt;
    Suggested result;
    result.predicates = *predicates;
    result.labelled = *labelled;
    if (predicates->empty()) {
        result.labelled.clear();
        for (Index p = 0; p < model.predicates.size(); ++p)
            if (!model.predicates[p].name.empty()) result.predicates.push_back(p);
        return result;
    }
    Trials trials(model, check_text);
    for (const Index predicate : *predicates) result.of.push_back(trials.add(predicate));
    const auto spec = trials.spec();
    if (!spec) {
        sink.report(Code::nothing_to_suggest, model.monitors.front().span,
                    "the candidates of all predicates together exceed the limits of a spec")
            .note("name one predicate: --suggest PREDICATE");
        return std::nullopt;
    }
    if (!measure(*spec, trials.measured(*spec), request, result, sink)) return std::nullopt;
    for (Suggestions& one : result.of) rank(one);
    return result;
}

namespace {

using check::Model;

/// Returns the durations to try, in steps, ascending.
std::vector<std::uint32_t> durations(const Model& model) {
    if (model.step_seconds <= 0) return {2, 5, 10, 20, 40};
    std::set<std::uint32_t> steps;
    for (const double seconds : {0.1, 0.2, 0.5, 1.0, 2.0})
        steps.insert(
            std::max(2U, static_cast<std::uint32_t>(std::lround(seconds / model.step_seconds))));
    return {steps.begin(), steps.end()};
}

/// The middle two of the durations, for formulas over two predicates, which are many.
std::vector<std::uint32_t> middle(const std::vector<std::uint32_t>& all) {
    if (all.size() <= 2) return all;
    return {all[all.size() / 2 - 1], all[all.size() / 2]};
}

struct Formula {
    std::string role;  ///< end of the let's name
    std::string text;
    std::uint32_t steps = 0;       ///< for which something has to hold; 0: for no time
    Index follows = check::kNone;  ///< the predicate that comes before
};

std::vector<Formula> over_one(const Model& model, const std::string& p) {
    std::vector<Formula> all;
    for (const std::uint32_t d : durations(model))
        all.push_back({"steady", fmt::format("held[{} steps] {}", d, p), d});
    for (const std::uint32_t d : durations(model))
        all.push_back({"recent", fmt::format("O[0, {} steps] {}", d, p)});
    return all;
}

std::vector<Formula> over_two(const Model& model, const std::string& p, Index other) {
    const std::string& q = model.predicates[other].name;
    std::vector<Formula> all;
    for (const std::uint32_t d : middle(durations(model)))
        for (const std::string& now : {p, "!" + q})
            all.push_back(
                {"after_" + q, fmt::format("{} && O held[{} steps] {}", now, d, q), d, other});
    all.push_back({"since_" + q, fmt::format("{} S {}", p, q), 0, other});
    return all;
}

/// Replaces whole words.
std::string replaced(const std::string& text, const std::map<std::string, std::string>& words) {
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = at;
        while (end < text.size() && is_word(text[end])) ++end;
        if (end == at) {
            result += text[at++];
            continue;
        }
        const std::string word = text.substr(at, end - at);
        const auto found = words.find(word);
        result += found == words.end() ? word : found->second;
        at = end;
    }
    return result;
}

std::string_view kind_of(const check::Monitor& monitor) {
    if (monitor.sliding) return "sliding monitor";
    constexpr std::array<std::string_view, 3> kKinds{"monitor", "restartable monitor",
                                                     "repeating monitor"};
    return kKinds[static_cast<std::size_t>(monitor.restarts)];
}

/// Replaces the monitors by blanks, so that places in the rest stay the same.
std::string without_monitors(const Model& model) {
    std::string text(model.file.text());
    for (const check::Monitor& monitor : model.monitors) {
        const std::size_t end = std::min(text.find(';', monitor.span.end - 1), text.size() - 1);
        for (std::size_t i = monitor.span.begin; i <= end; ++i)
            if (text[i] != '\n') text[i] = ' ';
    }
    return text;
}

class Building {
public:
    Building(const Model& model, const std::vector<Index>& asked,
             const std::vector<Index>& labelled)
        : model_(model),
          asked_(asked),
          labelled_(labelled),
          words_(words_of(model.file.text())),
          taken_(words_),
          names_("", taken_) {}

    void add_predicate(Index predicate) {
        const std::string& p = model_.predicates[predicate].name;
        RankedInTime& ranking = result_.all.emplace_back();
        ranking.name = p;
        if (against_both(predicate)) ranking.by = RankedBy::decided;
        ranking.ranked.push_back({p, {}, p});
        for (const Formula& formula : over_one(model_, p)) add_let(ranking, predicate, formula);
        for (const Index other : labelled_.empty() ? asked_ : labelled_)
            if (other != predicate)
                for (const Formula& formula : over_two(model_, p, other))
                    add_let(ranking, predicate, formula);
    }

    void add_monitor(const check::Monitor& monitor) {
        const auto used = check::predicates_of(model_, monitor.formula);
        const bool is_tried = monitor.truth == check::kNone &&
                              check::lets_are_written_out(model_, monitor.formula) &&
                              std::any_of(asked_.begin(), asked_.end(), [&](Index predicate) {
                                  return std::binary_search(used.begin(), used.end(), predicate);
                              });
        if (!is_tried) return;
        RankedInTime ranking;
        ranking.name = monitor.name;
        ranking.of_monitor = true;
        if (std::any_of(used.begin(), used.end(),
                        [&](Index predicate) { return against_both(predicate); }))
            ranking.by = RankedBy::decided;
        add_trial(ranking, monitor, {});
        std::map<std::uint32_t, std::vector<const Let*>> steady;
        for (const Let& let : lets_) {
            if (!std::binary_search(used.begin(), used.end(), let.predicate)) continue;
            add_trial(ranking, monitor, {&let});
            if (let.is_steady()) steady[let.formula.steps].push_back(&let);
        }
        for (const auto& [steps, lets] : steady)
            if (lets.size() > 1) add_trial(ranking, monitor, lets);
        for (const Let& let : lets_) {
            if (!std::binary_search(used.begin(), used.end(), let.predicate)) continue;
            for (const Let* before : steady[let.formula.steps])
                if (before->predicate == let.formula.follows)
                    add_trial(ranking, monitor, {before, &let});
        }
        result_.all.push_back(std::move(ranking));
    }

    TimeTrials take() && {
        result_.text = fmt::format("{}\n{}\n", without_monitors(model_), fmt::join(lines_, "\n"));
        return std::move(result_);
    }

private:
    /// A candidate let: `name` in the trial, `pasted` in the lines to paste.
    struct Let {
        Index predicate;
        Formula formula;
        std::string name, pasted;

        bool is_steady() const { return formula.steps > 0 && formula.follows == check::kNone; }
    };

    bool against_both(Index predicate) const {
        return model_.predicates[predicate].threshold.against == check::Against::both;
    }

    void add_let(RankedInTime& ranking, Index predicate, const Formula& formula) {
        const std::string& p = ranking.name;
        std::set<std::string> taken = words_;
        Let let{predicate, formula, names_.unused(p + "_trial"),
                Declarations("", taken).unused(fmt::format("{}_{}", p, formula.role))};
        declare(lines_, let.name, let);
        ranking.ranked.push_back({formula.text, {}, let.name});
        declare(ranking.ranked.back().lines, let.pasted, let);
        lets_.push_back(std::move(let));
    }

    void declare(std::vector<std::string>& lines, const std::string& name, const Let& let) const {
        lines.push_back(fmt::format("let {} = {};", name, let.formula.text));
        if (!labelled_.empty())
            lines.push_back(
                fmt::format("truth {} = {};", name, model_.predicates[let.predicate].name));
    }

    void add_trial(RankedInTime& ranking, const check::Monitor& monitor,
                   const std::vector<const Let*>& lets) {
        const std::string formula = check::print(model_, monitor.formula);
        std::map<std::string, std::string> trial;
        std::map<std::string, std::string> pasted;
        InTime candidate;
        std::vector<std::string> what;
        for (const Let* let : lets) {
            const std::string& p = model_.predicates[let->predicate].name;
            trial[p] = let->name;
            pasted[p] = let->pasted;
            what.push_back(fmt::format("{}: {}", p, let->formula.text));
            declare(candidate.lines, let->pasted, *let);
        }
        candidate.formula = lets.empty() ? formula : fmt::format("{}", fmt::join(what, ", "));
        candidate.trial = names_.unused(monitor.name + "_trial");
        const auto line = [&](const std::string& name, const auto& words) {
            return fmt::format("{} {} = {};", kind_of(monitor), name, replaced(formula, words));
        };
        if (!lets.empty()) candidate.lines.push_back(line(monitor.name, pasted));
        lines_.push_back(line(candidate.trial, trial));
        ranking.ranked.push_back(std::move(candidate));
    }

    const Model& model_;
    const std::vector<Index>& asked_;
    const std::vector<Index>& labelled_;
    const std::set<std::string> words_;  ///< words of the spec
    std::set<std::string> taken_;        ///< with the names declared since
    Declarations names_;
    std::vector<Let> lets_;
    std::vector<std::string> lines_;
    TimeTrials result_;
};

}  // namespace

TimeTrials time_trials(const Model& model, const std::vector<Index>& asked,
                       const std::vector<Index>& labelled) {
    Building building(model, asked, labelled);
    for (const Index predicate : asked) building.add_predicate(predicate);
    for (const check::Monitor& monitor : model.monitors) building.add_monitor(monitor);
    return std::move(building).take();
}

TimeTrials deadline_trials(const Model& model, const std::vector<Phases>& phases) {
    constexpr std::string_view kDeadline = "F[0, calibrated(conformal, alpha = 0.1)] ";
    TimeTrials result;
    std::set<std::string> taken = words_of(model.file.text());
    Declarations names("", taken);
    std::vector<std::string> all;
    for (Index m = 0; m < model.monitors.size(); ++m) {
        if (phases[m].empty()) continue;
        RankedInTime& ranking = result.all.emplace_back();
        ranking.name = model.monitors[m].name;
        ranking.of_monitor = ranking.of_deadlines = true;
        ranking.by = RankedBy::outcome;
        std::string before;
        for (const std::vector<Index>& conjuncts : phases[m]) {
            InTime& trial = ranking.ranked.emplace_back();
            std::vector<std::string> parts;
            for (const Index part : conjuncts) parts.push_back(check::print(model, part));
            if (!before.empty()) parts.push_back(before);
            std::string phase = fmt::format("{}", fmt::join(parts, " && "));
            if (parts.size() > 1) phase = "(" + phase + ")";
            std::string name = ranking.name;
            if (phases[m].size() > 1) {
                name = names.unused(fmt::format("{}_{}", name, ranking.ranked.size()));
                trial.lines.push_back(fmt::format("let {} = O {};", name, phase));
                phase = name;
            }
            trial.formula = before.empty()
                                ? fmt::format("{}{}", kDeadline, phase)
                                : fmt::format("G ({} -> {}{})", before, kDeadline, phase);
            trial.trial = names.unused(name + "_in_time");
            trial.lines.push_back(fmt::format("monitor {} = {};", trial.trial, trial.formula));
            all.insert(all.end(), trial.lines.begin(), trial.lines.end());
            before = phase;
        }
    }
    result.text = fmt::format("{}\n{}\n", without_monitors(model), fmt::join(all, "\n"));
    return result;
}

std::array<std::string_view, 2> titles_of(const RankedInTime& ranking) {
    if (ranking.by == RankedBy::outcome) return {"false alarms", "detected"};
    return {ranking.by == RankedBy::decided ? "steps" : "episodes", "variants"};
}

void rank(RankedInTime& all) {
    if (all.of_deadlines) return;
    std::stable_sort(all.ranked.begin(), all.ranked.end(), [](const InTime& a, const InTime& b) {
        return a.score.value.value_or(-1) > b.score.value.value_or(-1);
    });
}

}  // namespace etlc::fit
