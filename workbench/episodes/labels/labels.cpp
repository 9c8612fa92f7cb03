#include "episodes/labels/labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "data/text/text.hpp"

namespace etlc::episodes {

namespace {

constexpr std::string_view kTruth = "truth.";

/// Adds channels of labels to a trace that lacks them.
class LabelledTrace final : public data::Trace {
public:
    LabelledTrace(std::unique_ptr<data::Trace> trace, const EpisodeLabels& labels)
        : trace_(std::move(trace)), labels_(labels) {}

    /// Takes a channel from the labels.
    void label(std::size_t channel, const std::vector<LabelledSteps>& intervals) {
        cursors_.push_back({channel, intervals.data(), intervals.data() + intervals.size()});
    }

    bool has(std::size_t channel) const override {
        return trace_->has(channel) ||
               std::any_of(cursors_.begin(), cursors_.end(),
                           [&](const Cursor& cursor) { return cursor.channel == channel; });
    }

    std::uint64_t length() const override { return trace_->length(); }

    diag::Result<bool> next(data::Sample& sample) override {
        auto more = trace_->next(sample);
        if (!more) return more;
        if (!*more) return check_end();
        for (Cursor& cursor : cursors_) {
            while (cursor.at != cursor.end && cursor.at->end <= step_) ++cursor.at;
            const bool is_within = cursor.at != cursor.end && cursor.at->start <= step_;
            const Label label = is_within ? cursor.at->label : Label::no;
            sample.present[cursor.channel] = label != Label::unknown;
            sample.values[cursor.channel].assign(1, label == Label::unknown
                                                        ? std::numeric_limits<double>::quiet_NaN()
                                                    : label == Label::yes ? 1
                                                                          : 0);
        }
        ++step_;
        return true;
    }

private:
    struct Cursor {
        std::size_t channel = 0;
        const LabelledSteps* at = nullptr;
        const LabelledSteps* end = nullptr;
    };

    /// Fails where a label is behind the last step.
    diag::Result<bool> check_end() const {
        for (const auto& [predicate, intervals] : labels_) {
            if (intervals.empty()) continue;
            const LabelledSteps& last = intervals.back();
            const bool is_open = last.end == LabelledSteps::kToTheEnd;
            if (step_ == 0 || (is_open ? last.start < step_ : last.end <= step_)) continue;
            return diag::Failure{diag::Code::nothing_to_label,
                                 fmt::format("{} labels {} at step {}, and the last step is {}",
                                             last.place, data::in_quotes(predicate),
                                             is_open ? last.start : last.end - 1, step_ - 1)};
        }
        return false;
    }

    std::unique_ptr<data::Trace> trace_;
    const EpisodeLabels& labels_;
    std::vector<Cursor> cursors_;
    std::uint64_t step_ = 0;
};

}  // namespace

bool LabelSet::has(const std::string& predicate) const {
    return std::any_of(of_.begin(), of_.end(),
                       [&](const auto& one) { return one.second.contains(predicate); });
}

const EpisodeLabels* LabelSet::of(const std::string& episode) const {
    const auto found = of_.find(episode);
    return found == of_.end() ? nullptr : &found->second;
}

std::string LabelSet::group_of(const std::string& episode) const {
    const auto found = groups_.find(episode);
    return found == groups_.end() ? "" : found->second;
}

namespace {

diag::Result<std::unique_ptr<data::Trace>> open_unlabelled(
    const std::string& path, const std::vector<data::Channel>& channels, const ReadOptions& options,
    std::shared_ptr<KnownIdentities>* identities) {
    const auto renamed = recordings::renamed(channels, options.names);
    if (!options.kept) return recordings::open_trace(path, renamed);
    auto opened = options.kept->open(path, renamed);
    if (!opened) return opened.failure();
    if (identities != nullptr) *identities = opened->identities;
    return std::move(opened->trace);
}

}  // namespace

diag::Result<std::unique_ptr<data::Trace>> open_labelled(
    const std::string& path, const std::vector<data::Channel>& channels, const ReadOptions& options,
    std::shared_ptr<KnownIdentities>* identities) {
    auto trace = open_unlabelled(path, channels, options, identities);
    const EpisodeLabels* const labels = options.labels ? options.labels->of(path) : nullptr;
    if (!trace || labels == nullptr) return trace;
    auto labelled = std::make_unique<LabelledTrace>(std::move(*trace), *labels);
    for (std::size_t c = 0; c < channels.size(); ++c) {
        const std::string& name = channels[c].name;
        if (!name.starts_with(kTruth)) continue;
        const auto found = labels->find(name.substr(kTruth.size()));
        if (found == labels->end()) continue;
        if (labelled->has(c))
            return diag::Failure{
                diag::Code::contradictory_labels,
                fmt::format("has an array {}, and {} labels {} too: remove one of them",
                            data::in_quotes(recordings::name_in_file(name, options.names)),
                            found->second.front().place, data::in_quotes(found->first))};
        labelled->label(c, found->second);
    }
    return std::unique_ptr<data::Trace>(std::move(labelled));
}

std::vector<std::string> groups_of(const std::vector<std::string>& episodes,
                                   const ReadOptions& options) {
    std::vector<std::string> groups(episodes.size());
    for (std::size_t e = 0; e < episodes.size() && options.labels; ++e)
        groups[e] = options.labels->group_of(episodes[e]);
    return groups;
}

}  // namespace etlc::episodes
