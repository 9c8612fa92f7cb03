#include "episodes/folds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

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

std::vector<std::uint32_t> dealt(const std::vector<std::string>& groups, std::size_t folds) {
    std::vector<std::vector<std::size_t>> together;
    std::map<std::string, std::size_t> known;
    for (std::size_t e = 0; e < groups.size(); ++e) {
        const bool is_new = groups[e].empty() || known.emplace(groups[e], together.size()).second;
        if (is_new) together.emplace_back();
        (is_new ? together.back() : together[known.at(groups[e])]).push_back(e);
    }
    std::stable_sort(together.begin(), together.end(),
                     [](const auto& a, const auto& b) { return a.size() > b.size(); });
    std::vector<std::uint32_t> result(groups.size());
    std::vector<std::size_t> sizes(folds);
    for (const std::vector<std::size_t>& group : together) {
        const auto least = std::min_element(sizes.begin(), sizes.end());
        *least += group.size();
        for (const std::size_t e : group)
            result[e] = static_cast<std::uint32_t>(least - sizes.begin());
    }
    return result;
}

std::size_t count_apart(const std::vector<std::string>& groups) {
    const std::set<std::string> named(groups.begin(), groups.end());
    const auto alone = static_cast<std::size_t>(std::count(groups.begin(), groups.end(), ""));
    return named.size() - named.count("") + alone;
}

std::vector<std::uint32_t> folds_of(const Identities& episodes, std::uint32_t folds,
                                    const ReadOptions& reading) {
    std::vector<std::string> paths;
    episodes.for_each([&](std::size_t, const Recorded& episode) { paths.push_back(episode.path); });
    const std::vector<std::string> groups = groups_of(paths, reading);
    const std::vector<std::size_t> order = by_content(episodes);
    std::vector<std::string> in_order;
    for (const std::size_t e : order) in_order.push_back(groups[e]);
    const std::vector<std::uint32_t> of_rank = dealt(in_order, folds);
    std::vector<std::uint32_t> result(order.size());
    for (std::size_t rank = 0; rank < order.size(); ++rank) result[order[rank]] = of_rank[rank];
    return result;
}

bool can_be_dealt(const std::vector<std::string>& episodes, const ReadOptions& reading,
                  std::uint32_t folds, const check::Model& model, diag::Sink& sink) {
    const std::size_t apart = count_apart(groups_of(episodes, reading));
    if (folds <= apart) return true;
    const bool has_groups = apart < episodes.size();
    sink.report(diag::Code::too_few_for_folds, model.monitors.front().span,
                fmt::format("{} folds take at least as many {}; there {} {}", folds,
                            has_groups ? "groups" : "episodes", apart == 1 ? "is" : "are", apart));
    return false;
}

ContentScorer::ContentScorer(const check::Model& model, const ReadOptions& reading,
                             std::vector<Index> labelled)
    : wanted_{&model, identity_inputs(model), {}, identity_inputs(model), nullptr},
      reading_(reading) {
    if (!reading.kept) return;
    for_later_ = wanted_;
    for_later_->predicates = std::move(labelled);
    for_later_->optional.resize(model.inputs.size());
    std::iota(for_later_->optional.begin(), for_later_->optional.end(), Index{0});
}

diag::Result<Recorded> ContentScorer::score(const std::string& path) const {
    if (for_later_)
        if (auto recorded = read(*for_later_, path)) return recorded;
    return read(wanted_, path);
}

diag::Result<Recorded> ContentScorer::read(const Wanted& wanted, const std::string& path) const {
    auto recording = Recording::open(wanted, path, reading_);
    if (!recording) return recording.failure();
    for (;;) {
        const auto more = recording->next();
        if (!more) return more.failure();
        if (!*more) return recording->recorded();
    }
}

}  // namespace etlc::episodes
