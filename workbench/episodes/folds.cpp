#include "episodes/folds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace etlc::episodes {

std::vector<std::size_t> by_content(const Identities& episodes) {
    std::vector<std::uint64_t> hashes;
    episodes.for_each(
        [&](std::size_t, const Recorded& episode) { hashes.push_back(hash_of(episode)); });
    std::vector<std::size_t> order(episodes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return hashes[a] < hashes[b]; });
    return order;
}

std::vector<std::uint32_t> folds_of(const Identities& episodes, std::uint32_t folds) {
    const std::vector<std::size_t> order = by_content(episodes);
    std::vector<std::uint32_t> result(episodes.size());
    for (std::size_t rank = 0; rank < order.size(); ++rank)
        result[order[rank]] = static_cast<std::uint32_t>(rank % folds);
    return result;
}

bool can_be_dealt(std::size_t episodes, std::uint32_t folds, const check::Model& model,
                  diag::Sink& sink) {
    if (folds <= episodes) return true;
    sink.report(diag::Code::too_few_for_folds, model.monitors.front().span,
                fmt::format("{} folds take at least as many episodes; there {} {}", folds,
                            episodes == 1 ? "is" : "are", episodes));
    return false;
}

ContentScorer::ContentScorer(const check::Model& model, const data::NamesInFile& names)
    : wanted_{&model, identity_inputs(model), {}, identity_inputs(model), nullptr}, names_(names) {}

diag::Result<Recorded> ContentScorer::score(const std::string& path) const {
    auto recording = Recording::open(wanted_, path, names_);
    if (!recording) return recording.failure();
    for (;;) {
        const auto more = recording->next();
        if (!more) return more.failure();
        if (!*more) return recording->recorded();
    }
}

}  // namespace etlc::episodes
