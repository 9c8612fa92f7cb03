#include "evaluate/by_episode.hpp"

#include <algorithm>

#include "evaluate/evaluate.hpp"

namespace etlc::evaluate {

namespace {

/// Of the claims whose truth is known.
double share_wrong(const Counts& claims) {
    const auto agreement = rates(claims).agreement;
    return agreement ? 1 - *agreement : 0;
}

bool is_wrong(const Counts& verdict) {
    return verdict.total() > 0 && rates(verdict).agreement == 0.0;
}

/// The earlier error counts; of equal ones that of the first name.
void note(std::optional<EpisodeRow::Error>& first, const std::optional<std::uint64_t>& step,
          const std::string& name, bool of_monitor) {
    if (step && (!first || *step < first->step)) first = {*step, name, of_monitor};
}

EpisodeRow row_of(const Judgement& judgement, std::size_t e) {
    const std::uint32_t place = judgement.place[e];
    const episodes::Recorded episode = judgement.episodes[place];
    EpisodeRow row;
    row.path = episode.path;
    if (!judgement.folds.empty()) row.fold = judgement.fold_of[e] + 1;
    row.frames = episode.frames;
    for (std::size_t i = 0; i < judgement.predicates.size(); ++i) {
        const PredicateEpisode predicate = judgement.predicates[i].episodes[place];
        const std::string& name = judgement.predicates[i].name;
        row.predicates.emplace_back(name, predicate.frames);
        row.claims.add(predicate.frames);
        note(row.first_error, predicate.first_error, name, false);
    }
    const bool predicates_err = row.first_error.has_value();
    for (std::size_t m = 0; m < judgement.monitors.size(); ++m) {
        const MonitorEpisode monitor = judgement.monitors[m].episodes[place];
        const std::string& name = judgement.monitors[m].name;
        if (is_wrong(monitor.episode)) row.wrong.push_back(name);
        if (judgement.predicates.empty()) row.claims.add(monitor.steps);
        if (!predicates_err) note(row.first_error, monitor.first_error, name, true);
    }
    return row;
}

}  // namespace

std::vector<EpisodeRow> by_episode(const Judgement& judgement) {
    std::vector<EpisodeRow> rows;
    for (std::size_t e = 0; e < judgement.place.size(); ++e) rows.push_back(row_of(judgement, e));
    std::stable_sort(rows.begin(), rows.end(), [](const EpisodeRow& a, const EpisodeRow& b) {
        return std::pair(a.wrong.size(), share_wrong(a.claims)) >
               std::pair(b.wrong.size(), share_wrong(b.claims));
    });
    return rows;
}

}  // namespace etlc::evaluate
