#include "calibrate/admission.hpp"

#include <fmt/format.h>

#include <map>
#include <set>

#include "calibrate/parallel.hpp"
#include "data/file.hpp"

namespace etlc::calibrate {

namespace {

using diag::Code;
using Episodes = std::vector<const Recorded*>;

void refuse_repeated(const Episodes& episodes, diag::Sink& sink) {
    std::map<std::string, std::string> first;
    std::size_t reported = 0;
    for (const Recorded* episode : episodes) {
        const auto [at, is_new] = first.try_emplace(episode->hash, episode->path);
        if (is_new || ++reported > kMostReported) continue;
        const std::string message = fmt::format("is the same episode as {}", at->second);
        sink.report(data::in_file({Code::duplicate_episode, message}, episode->path))
            .note(
                "demonstrations have to be independent recordings: one that counts twice voids the "
                "guarantee");
    }
}

void refuse_seen(const Episodes& episodes, const std::vector<std::string>& seen, diag::Sink& sink) {
    const std::set<std::string> known(seen.begin(), seen.end());
    std::size_t reported = 0;
    for (const Recorded* episode : episodes) {
        if (!known.contains(episode->hash) || ++reported > kMostReported) continue;
        const std::string message =
            "is an episode that thresholds of predicates were calibrated on";
        sink.report(data::in_file({Code::not_disjoint, message}, episode->path))
            .note(
                "calibrate monitors on other episodes: fitted on the same ones, the thresholds are "
                "better there "
                "than they will be");
    }
}

void refuse_leaks(const check::Model& model, const Episodes& episodes, diag::Sink& sink) {
    std::size_t reported = 0;
    for (const Recorded* episode : episodes) {
        if (!episode->leak || ++reported > kMostReported) continue;
        auto& error = sink.report(
            data::in_file({Code::target_in_data, text(model, *episode->leak)}, episode->path));
        error.note(
            "targets have to come from other recordings: at a distance of 0 this one voids the "
            "guarantee");
        if (model.distances[episode->leak->distance].point_is_vector)
            error.note(
                "where these scalars may well come to lie there, write the rows into the spec: "
                "only those of a file "
                "are taken for recorded ones");
    }
}

}  // namespace

std::string text(const check::Model& model, const Leak& leak) {
    return fmt::format("step {} is row {} of target '{}', from which '{}' measures", leak.frame,
                       leak.row, model.targets[model.distances[leak.distance].target].name,
                       model.predicates[leak.predicate].shown());
}

void refuse_void(const check::Model& model, const Episodes& episodes,
                 const std::vector<std::string>& seen, diag::Sink& sink) {
    refuse_seen(episodes, seen, sink);
    refuse_repeated(episodes, sink);
    refuse_leaks(model, episodes, sink);
}

}  // namespace etlc::calibrate
