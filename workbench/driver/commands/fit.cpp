#include <algorithm>
#include <map>

#include "calibrate/scores.hpp"
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
    auto result = fit::suggest(
        model, [&](const std::string& text) { return check_text(file, options, text); },
        request.fit.predicates, asked, sink);
    if (!result || sink.refused()) return false;
    result->in_time = suggest_in_time(file, model, *result, request, asked);
    OutputFiles files(sink);
    return files.add(std::string(kStandardOutput),
                     request.fit.json ? fit::json(*result)
                                      : source::visible_lines(fit::report(*result))) &&
           files.commit();
}

}  // namespace

bool fit(const source::File& file, const Request& request, diag::Sink& sink) {
    ast::Spec spec = parse::parse(file, sink);
    check::Options options = request.check;
    options.allow_uncalibrated = true;
    options.allow_uncalibrated_monitors = true;
    options.allow_unfitted = true;
    const auto model = check::check(std::move(spec), file, options, sink);
    if (!model || sink.refused()) return false;

    auto asked = asked_of<fit::Request>(request);
    asked.allow_overlap = request.allow_overlap;
    if (!check_names({&*model}, asked.reading.names, sink)) return false;
    asked.version = library::kVersion;
    const std::string output =
        request.output.empty() ? fitted::default_path(file.path()) : request.output;
    asked.episodes = recordings::find_episodes(request.data, request.groups, sink);
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

namespace {

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
        request_.check.judged_lets = true;
        asked_.episodes = asked.episodes;
        asked_.reading = asked.reading;
        asked_.allow_overlap = asked.allow_overlap;
        asked_.jobs = asked.jobs;
        asked_.limits = request.limits;
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
        if (model->fitted.empty() && calibrate::calibrated_predicates(*model).empty()) {
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
    if (ranking.by_decided) return &evaluate::Rates::decided;
    return ranking.of_monitor ? &evaluate::Rates::agreement : &evaluate::Rates::f1;
}
evaluate::Counts evaluate::MonitorEpisode::*counts_of(const fit::RankedInTime& ranking) {
    return ranking.by_decided ? &evaluate::MonitorEpisode::steps
                              : &evaluate::MonitorEpisode::episode;
}

/// Sums the verdicts of a monitor over the episodes, and over their variants.
void add_parts(const evaluate::Judgement& judgement, std::size_t monitor,
               const fit::RankedInTime& ranking, fit::InTime& one) {
    evaluate::Counts on_episodes;
    evaluate::Counts on_variants;
    judgement.for_each(judgement.monitors[monitor].episodes,
                       [&](std::size_t, const evaluate::MonitorEpisode& episode) {
                           on_episodes.add(episode.*counts_of(ranking));
                           for (const evaluate::Counts& kind : episode.variants)
                               on_variants.add(kind);
                       });
    one.on_episodes = evaluate::rates(on_episodes).*rate_of(ranking);
    one.on_variants = evaluate::rates(on_variants).*rate_of(ranking);
}

/// Returns the score of a candidate in each resample; nothing where it cannot be judged.
std::optional<evaluate::Statistic> score_of(const evaluate::Judgement& judgement,
                                            const fit::RankedInTime& ranking,
                                            const std::string& trial) {
    if (ranking.of_monitor) {
        const std::size_t m = place_of(judgement.monitors, trial);
        if (!judgement.monitors[m].lacking.empty()) return std::nullopt;
        return evaluate::with_variants(judgement, m, counts_of(ranking), rate_of(ranking));
    }
    const std::size_t p = place_of(judgement.predicates, trial);
    if (p == judgement.predicates.size()) return std::nullopt;
    return evaluate::by_frames(judgement, p, rate_of(ranking));
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
    for (fit::InTime& one : ranking.ranked) {
        const auto score = score_of(judgement, ranking, one.trial);
        if (!score) continue;
        scores[one.trial] = *score;
        one.score = bootstrap.figure(*score);
        if (ranking.of_monitor)
            add_parts(judgement, place_of(judgement.monitors, one.trial), ranking, one);
        else if (one.lines.empty() && !ranking.by_decided)
            ranking.clock =
                evaluate::f1_of_duration(judgement, place_of(judgement.predicates, one.trial));
    }
    fit::rank(ranking);
    const auto best = scores.find(ranking.ranked.front().trial);
    for (fit::InTime& one : ranking.ranked) {
        const auto score = scores.find(one.trial);
        one.ties = best != scores.end() && score != scores.end() &&
                   may_be_as_good(evaluate::less(bootstrap, best->second, score->second));
    }
}

}  // namespace

fit::SuggestedInTime suggest_in_time(const source::File& file, const check::Model& model,
                                     const fit::Suggested& suggested, const Request& request,
                                     const fit::Request& asked) {
    fit::TimeTrials trials = fit::time_trials(model, suggested.predicates, suggested.labelled);
    fit::SuggestedInTime result;
    const source::File text(file.path(), std::move(trials.text));
    diag::Sink sink;
    const auto judgement = TrialRun(text, request, asked).judge(sink);
    if (!judgement) {
        result.why_not = first_error(sink);
        return result;
    }
    result.folds = judgement->folds.size();
    result.all = std::move(trials.all);
    for (fit::RankedInTime& ranking : result.all) fill_in(*judgement, ranking);
    return result;
}

}  // namespace etlc::driver
