#include "driver/commands/suggest_in_time.hpp"

#include <algorithm>
#include <map>

#include "calibrate/scores.hpp"
#include "compile.hpp"
#include "driver/commands/commands.hpp"
#include "driver/commands/crossvalidate.hpp"
#include "episodes/folds.hpp"
#include "parse/parse.hpp"

namespace etlc::driver {

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
        asked_.variants = {episodes::Variant::cut, episodes::Variant::swapped,
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

/// Sums the verdicts of a monitor over the episodes, and over their variants.
void add_agreements(const evaluate::Judgement& judgement, std::size_t monitor, fit::InTime& one) {
    evaluate::Counts on_episodes;
    evaluate::Counts on_variants;
    judgement.for_each(judgement.monitors[monitor].episodes,
                       [&](std::size_t, const evaluate::MonitorEpisode& episode) {
                           on_episodes.add(episode.episode);
                           for (const evaluate::Counts& kind : episode.variants)
                               on_variants.add(kind);
                       });
    one.on_episodes = evaluate::rates(on_episodes).agreement;
    one.on_variants = evaluate::rates(on_variants).agreement;
}

/// Returns the score of a candidate in each resample; nothing where it cannot be judged.
std::optional<evaluate::Statistic> score_of(const evaluate::Judgement& judgement, bool of_monitor,
                                            const std::string& trial) {
    if (of_monitor) {
        const std::size_t m = place_of(judgement.monitors, trial);
        if (!judgement.monitors[m].lacking.empty()) return std::nullopt;
        return evaluate::agreement_with_variants(judgement, m);
    }
    const std::size_t p = place_of(judgement.predicates, trial);
    if (p == judgement.predicates.size()) return std::nullopt;
    return evaluate::f1_by_frames(judgement, p);
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
        const auto score = score_of(judgement, ranking.of_monitor, one.trial);
        if (!score) continue;
        scores[one.trial] = *score;
        one.score = bootstrap.figure(*score);
        if (ranking.of_monitor)
            add_agreements(judgement, place_of(judgement.monitors, one.trial), one);
        else if (one.lines.empty())
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
