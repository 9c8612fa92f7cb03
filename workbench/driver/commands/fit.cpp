#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "calibrate/scores.hpp"
#include "calibrate/shift.hpp"
#include "compile.hpp"
#include "driver/commands/commands.hpp"
#include "driver/commands/crossvalidate.hpp"
#include "driver/process/process.hpp"
#include "episodes/folds.hpp"
#include "fit/fit.hpp"
#include "fit/suggest/suggest.hpp"
#include "library/version.hpp"
#include "parse/parse.hpp"
#include "recordings/episodes.hpp"
#include "recordings/open.hpp"
#include "source/text.hpp"

namespace etlc::driver {

namespace {

/// Returns the phases of each monitor that has some; a deadline of a phase is for good.
std::vector<fit::Phases> phases_of(const check::Model& model) {
    std::vector<fit::Phases> phases;
    for (const check::Monitor& monitor : model.monitors)
        phases.push_back(monitor.sliding || monitor.restarts != check::Restarts::never
                             ? fit::Phases{}
                             : evaluate::stages_of(model, monitor.formula));
    return phases;
}

constexpr std::uint32_t kFolds = 5;

std::string first_error(const diag::Sink& sink) {
    for (const diag::Diagnostic& one : sink.sorted())
        if (one.severity() == diag::Severity::error) return one.message;
    return "it was interrupted";
}

/// Trains and judges a text of the spec in folds, or judges it as it is where nothing in it is
/// trained.
class TrialRun {
public:
    TrialRun(const source::File& file, const Request& request, const fit::Request& asked)
        : file_(file), request_(request) {
        constexpr std::uint64_t kTrials = 16;  // beside each other; nobody compiles them together
        request_.check.judged_lets = true;
        request_.limits.code_bytes *= kTrials;
        request_.limits.operations *= kTrials;
        asked_.episodes = asked.episodes;
        asked_.reading = asked.reading;
        asked_.allow_overlap = asked.allow_overlap;
        asked_.jobs = asked.jobs;
        asked_.limits = request_.limits;
        asked_.progress = asked.progress;
        asked_.variants = {episodes::Variant::cut, episodes::Variant::phases_reversed,
                           episodes::Variant::reversed, episodes::Variant::frozen};
    }

    std::optional<evaluate::Judgement> judge(diag::Sink& sink) {
        check::Options options = request_.check;
        options.allow_uncalibrated = options.allow_unfitted = true;
        diag::Sink of_spec;
        const auto model = check::check(parse::parse(file_, of_spec), file_, options, of_spec);
        if (!model) {
            sink.add(of_spec, "");
            return std::nullopt;
        }
        if (model->fitted.empty() && calibrate::calibrated_predicates(*model).empty() &&
            calibrate::calibrated_monitors(*model).empty()) {
            const auto compiled = compile(file_, request_.check, request_, of_spec);
            if (compiled) return judge_as_it_is(*compiled, file_.path(), request_, asked_, sink);
            sink.add(of_spec, "");
            return std::nullopt;
        }
        const episodes::Groups groups(episodes::groups_of(asked_.episodes, asked_.reading));
        request_.folds = static_cast<std::uint32_t>(
            std::clamp<std::size_t>(groups.count(), 2, kFolds));  // fewer are reported
        std::optional<Folds> folds;
        return judge_in_folds(file_, *model, request_, asked_, folds, sink);
    }

private:
    const source::File& file_;
    Request request_;
    evaluate::Request asked_;
};

/// Returns the place of the name, or the size.
template <class Named>
std::size_t place_of(const std::vector<Named>& all, const std::string& name) {
    const auto at =
        std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
    return static_cast<std::size_t>(at - all.begin());
}

/// Returns the rate by which candidates are ranked.
evaluate::Rate rate_of(const fit::RankedInTime& ranking) {
    if (ranking.by != fit::RankedBy::truth) return &evaluate::Rates::decided;
    return ranking.of_monitor ? &evaluate::Rates::agreement : &evaluate::Rates::f1;
}

std::optional<double> rate_of_sum(const std::vector<evaluate::Counts>& all, evaluate::Rate rate) {
    evaluate::Counts sum;
    for (const evaluate::Counts& one : all) sum.add(one);
    return evaluate::rates(sum).*rate;
}

/// Returns the counts of a candidate; nothing where it cannot be judged.
std::optional<evaluate::EpisodeCounts> counts_of(const evaluate::Judgement& judgement,
                                                 const fit::RankedInTime& ranking,
                                                 const std::string& trial) {
    if (!ranking.of_monitor) {
        const std::size_t p = place_of(judgement.predicates, trial);
        if (p == judgement.predicates.size()) return std::nullopt;
        return evaluate::counts_by_frames(judgement, p);
    }
    const std::size_t m = place_of(judgement.monitors, trial);
    if (ranking.by == fit::RankedBy::outcome) return evaluate::counts_by_outcome(judgement, m);
    if (!judgement.monitors[m].lacking.empty()) return std::nullopt;
    return evaluate::counts_by_truth(judgement, m,
                                     ranking.by == fit::RankedBy::decided
                                         ? &evaluate::MonitorEpisode::steps
                                         : &evaluate::MonitorEpisode::episode);
}

/// Returns the parts of a monitor's score, as titles_of names them.
std::vector<std::optional<double>> parts_of(const evaluate::EpisodeCounts& counts,
                                            const fit::RankedInTime& ranking) {
    if (ranking.by == fit::RankedBy::outcome)
        return {rate_of_sum(counts.own, &evaluate::Rates::false_positive_rate),
                rate_of_sum(counts.own, &evaluate::Rates::recall)};
    return {rate_of_sum(counts.own, rate_of(ranking)),
            rate_of_sum(counts.on_variants, rate_of(ranking))};
}

/// Returns the score where each fold is judged by the candidate that is the best on the others.
std::optional<double> nested_score(const evaluate::Judgement& judgement,
                                   const std::vector<evaluate::EpisodeCounts>& candidates,
                                   evaluate::Rate rate) {
    const auto score = [&](const evaluate::EpisodeCounts& counts, auto&& is_taken) {
        evaluate::Counts own;
        evaluate::Counts variants;
        for (std::size_t e = 0; e < counts.own.size(); ++e) {
            if (!is_taken(e)) continue;
            own.add(counts.own[e]);
            if (!counts.on_variants.empty()) variants.add(counts.on_variants[e]);
        }
        return evaluate::mean(evaluate::rates(own).*rate, evaluate::rates(variants).*rate);
    };
    const auto fold_of = [&](std::size_t e) {
        return judgement.folds.empty() ? judgement.groups.of(e) % kFolds : judgement.fold_of[e];
    };
    evaluate::EpisodeCounts chosen = candidates.front();
    const std::size_t folds = judgement.folds.empty() ? kFolds : judgement.folds.size();
    for (std::size_t fold = 0; fold < folds; ++fold) {
        std::optional<double> greatest;
        const evaluate::EpisodeCounts* best = &candidates.front();
        for (const evaluate::EpisodeCounts& one : candidates) {
            const auto found = score(one, [&](std::size_t e) { return fold_of(e) != fold; });
            if (!found || (greatest && *found <= *greatest)) continue;
            greatest = found;
            best = &one;
        }
        for (std::size_t e = 0; e < chosen.own.size(); ++e) {
            if (fold_of(e) != fold) continue;
            chosen.own[e] = best->own[e];
            if (!chosen.on_variants.empty()) chosen.on_variants[e] = best->on_variants[e];
        }
    }
    return score(chosen, [](std::size_t) { return true; });
}

/// Whether the interval of the difference reaches 0.
bool may_be_as_good(const evaluate::Figure& difference) {
    return difference.value &&
           (difference.interval ? difference.interval->low : *difference.value) <= 0;
}

/// Looks up the figures of the candidates by the names of their trials, and ranks them.
void fill_in(const evaluate::Judgement& judgement, fit::RankedInTime& ranking) {
    const evaluate::Bootstrap bootstrap(judgement.groups);
    std::map<std::string, evaluate::Statistic> scores;  // by trial
    std::vector<evaluate::EpisodeCounts> candidates;
    for (fit::InTime& one : ranking.ranked) {
        const auto counts = counts_of(judgement, ranking, one.trial);
        if (!counts) continue;
        const auto score = evaluate::statistic(*counts, rate_of(ranking));
        scores[one.trial] = score;
        one.score = bootstrap.figure(score);
        if (ranking.of_monitor)
            one.parts = parts_of(*counts, ranking);
        else if (one.lines.empty() && ranking.by == fit::RankedBy::truth)
            ranking.clock =
                evaluate::f1_of_duration(judgement, place_of(judgement.predicates, one.trial));
        candidates.push_back(*counts);
    }
    if (candidates.size() > 1 && !ranking.of_deadlines)
        ranking.nested = nested_score(judgement, candidates, rate_of(ranking));
    fit::rank(ranking);
    const auto best = scores.find(ranking.ranked.front().trial);
    for (fit::InTime& one : ranking.ranked) {
        const auto score = scores.find(one.trial);
        one.ties = best != scores.end() && score != scores.end() &&
                   may_be_as_good(evaluate::less(bootstrap, best->second, score->second));
    }
}

/// Replaces `calibrated(...)` in a deadline by what the folds gave: "F[0, 34 to 38 steps] lifted".
void show_durations(const evaluate::Judgement& judgement, fit::InTime& trial) {
    float least = std::numeric_limits<float>::infinity();
    float greatest = 0;
    for (const evaluate::Judgement::Fold& fold : judgement.folds)
        for (const auto& [name, steps] : fold.thresholds)
            if (name == trial.trial + ", steps") {
                least = std::min(least, steps);
                greatest = std::max(greatest, steps);
            }
    const std::size_t begin = trial.formula.find("calibrated(");
    trial.formula.replace(begin, trial.formula.find(')', begin) + 1 - begin,
                          least == greatest ? fmt::format("{} steps", least)
                                            : fmt::format("{} to {} steps", least, greatest));
}

/// Adds a deadline for each phase of the monitors that have phases.
void suggest_deadlines(const source::File& file, const check::Model& model, const Request& request,
                       const fit::Request& asked, fit::SuggestedInTime& result) {
    fit::TimeTrials trials = fit::deadline_trials(model, phases_of(model));
    if (trials.all.empty()) return;
    const source::File text(file.path(), std::move(trials.text));
    diag::Sink sink;
    const auto judgement = TrialRun(text, request, asked).judge(sink);
    if (!judgement) {
        result.why_no_deadlines = first_error(sink);
        return;
    }
    for (fit::RankedInTime& ranking : trials.all) {
        fill_in(*judgement, ranking);
        for (fit::InTime& one : ranking.ranked) show_durations(*judgement, one);
        result.all.push_back(std::move(ranking));
    }
}

/// Judges formulas over time: all candidates in one text of the spec, trained and judged as `etlc
/// crossvalidate` would. Returns the ranked candidates, or why there are none: an error in training
/// or judging them is no error of the call.
fit::SuggestedInTime suggest_in_time(const source::File& file, const check::Model& model,
                                     const fit::Suggested& suggested, const Request& request,
                                     const fit::Request& asked) {
    fit::SuggestedInTime result;
    const bool by_outcome = asked.reading.labels && asked.reading.labels->has_outcomes();
    if (!suggested.labelled.empty() || by_outcome) {
        fit::TimeTrials trials = fit::time_trials(model, suggested.predicates, suggested.labelled);
        const source::File text(file.path(), std::move(trials.text));
        diag::Sink sink;
        const auto judgement = TrialRun(text, request, asked).judge(sink);
        if (!judgement) {
            result.why_not = first_error(sink);
            return result;
        }
        result.folds = judgement->folds.size();
        result.all = std::move(trials.all);
        for (fit::RankedInTime& ranking : result.all) {
            if (ranking.of_monitor && by_outcome) ranking.by = fit::RankedBy::outcome;
            fill_in(*judgement, ranking);
        }
        std::erase_if(result.all, [](const fit::RankedInTime& ranking) {  // without a truth
            return std::none_of(ranking.ranked.begin(), ranking.ranked.end(),
                                [](const fit::InTime& one) { return one.score.value.has_value(); });
        });
    }
    suggest_deadlines(file, model, request, asked, result);
    return result;
}

/// Checks another text of the spec; nothing where it has errors.
std::optional<check::Model> check_text(const source::File& file, const check::Options& options,
                                       const std::string& text) {
    diag::Sink sink;
    const source::File other(file.path(), text);
    ast::Spec spec = parse::parse(other, sink);
    auto model = check::check(std::move(spec), other, options, sink);
    return sink.has_errors() ? std::nullopt : std::move(model);
}

bool suggest(const source::File& file, const check::Model& model, const check::Options& options,
             const Request& request, const fit::Request& asked, diag::Sink& sink) {
    const std::vector<fit::Phases> phases = phases_of(model);
    const bool of_monitors =
        (asked.reading.labels && asked.reading.labels->has_outcomes()) ||
        std::any_of(phases.begin(), phases.end(), [](const auto& one) { return !one.empty(); });
    auto result = fit::suggest(
        model, [&](const std::string& text) { return check_text(file, options, text); },
        request.fit.predicates, of_monitors, asked, sink);
    if (!result || sink.refused()) return false;
    result->in_time = suggest_in_time(file, model, *result, request, asked);
    if (result->of.empty() && result->in_time.all.empty()) {
        const std::string& why = result->in_time.why_not;
        sink.report(diag::Code::nothing_to_suggest, model.monitors.front().span,
                    "no predicate of this spec has labels and measures from one point, and nothing "
                    "was tried for its monitors: " +
                        (why.empty() ? result->in_time.why_no_deadlines : why));
        return false;
    }
    OutputFiles files(sink);
    return files.add(std::string(kStandardOutput),
                     request.fit.json ? fit::json(*result)
                                      : source::visible_lines(fit::report(*result))) &&
           files.commit();
}

}  // namespace

bool fit(const source::File& file, const Request& request, diag::Sink& sink) {
    const check::Options options = without_results(request.check);
    const auto model = check::check(parse::parse(file, sink), file, options, sink);
    if (!model || sink.refused()) return false;

    auto asked = asked_of<fit::Request>(request);
    asked.allow_overlap = request.allow_overlap;
    if (!check_names({&*model}, asked.reading.names, sink)) return false;
    asked.version = library::kVersion;
    const std::string output =
        request.output.empty() ? fitted::default_path(file.path()) : request.output;
    asked.episodes = recordings::find_episodes(request.data, request.chosen, sink);
    if (sink.has_errors()) return false;
    if (!read_labels({&*model}, request, asked.episodes, asked.reading, sink)) return false;
    if (request.fit.suggest) return suggest(file, *model, options, request, asked, sink);
    if (!check_outputs({output}, files_read(*model, file, asked.episodes, asked.reading), sink))
        return false;
    const auto result = fit::fit(*model, asked, sink);
    if (!result || sink.refused()) return false;

    // The report is written before the file takes its name: where that fails, nothing has changed.
    OutputFiles files(sink);
    return files.add(output, fitted::write(result->file)) &&
           files.add(output == kStandardOutput ? "/dev/stderr" : std::string(kStandardOutput),
                     source::visible_lines(result->report)) &&
           files.commit();
}

fitted::File fitted_file(const check::Model& model, const std::string& spec,
                         const Request& request) {
    if (model.fitted.empty()) return {};
    const std::string& given = request.check.fitted_path;
    const auto file = fitted::read(given.empty() ? fitted::default_path(spec) : given);
    return file ? *file : fitted::File{};  // check/ has read it and reported errors
}

}  // namespace etlc::driver
