#include "episodes/folds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace etlc::episodes {

std::uint32_t Groups::add(const std::string& name) {
    const auto number = name.empty() ? count_ : known_.try_emplace(name, count_).first->second;
    if (number == count_) ++count_;
    of_.push_back(number);
    return number;
}

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
    const Groups numbered(groups);
    std::vector<std::vector<std::size_t>> together(numbered.count());
    for (std::size_t e = 0; e < groups.size(); ++e) together[numbered.of(e)].push_back(e);
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

std::vector<std::uint32_t> folds_of(const Identities& episodes, std::uint32_t folds) {
    std::vector<std::string> groups;
    episodes.for_each(
        [&](std::size_t, const Recorded& episode) { groups.push_back(episode.group); });
    const std::vector<std::size_t> order = by_content(episodes);
    std::vector<std::string> in_order;
    for (const std::size_t e : order) in_order.push_back(groups[e]);
    const std::vector<std::uint32_t> of_rank = dealt(in_order, folds);
    std::vector<std::uint32_t> result(order.size());
    for (std::size_t rank = 0; rank < order.size(); ++rank) result[order[rank]] = of_rank[rank];
    return result;
}

std::vector<std::uint32_t> folds_of(const Identities& episodes, const Groups& groups,
                                    std::uint32_t folds) {
    const std::vector<std::uint32_t> of_episodes = folds_of(episodes, folds);
    std::vector<std::uint32_t> result(groups.count());
    for (std::size_t e = 0; e < of_episodes.size(); ++e) result[groups.of(e)] = of_episodes[e];
    return result;
}

bool can_be_dealt(const std::vector<std::string>& episodes, const ReadOptions& reading,
                  std::uint32_t folds, const check::Model& model, diag::Sink& sink) {
    const Groups groups(groups_of(episodes, reading));
    if (folds <= groups.count()) return true;
    sink.report(diag::Code::too_few_for_folds, model.monitors.front().span,
                fmt::format("{} folds take at least as many {}; there {} {}", folds,
                            groups.are_named() ? "groups" : "episodes",
                            groups.count() == 1 ? "is" : "are", groups.count()));
    return false;
}

ContentScorer::ContentScorer(const check::Model& model, const ReadOptions& reading,
                             std::vector<Index> labelled)
    : wanted_{&model, identity_inputs(model), {}, identity_inputs(model), nullptr},
      reading_(reading) {
    if (!reading.cache) return;
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
