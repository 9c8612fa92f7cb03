#include "episodes/data_warnings.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "check/encoders/encoders.hpp"
#include "data/files/file.hpp"

namespace etlc::episodes {
namespace {

/// Counts the unmarked episodes of a call.
class Unmarked {
public:
    void add(const std::string& path, bool is_unmarked) {
        ++episodes_;
        if (!is_unmarked) return;
        if (++count_ == 1) first_ = path;
    }

    void report(diag::Sink& sink) const {
        if (count_ == 0) return;
        diag::Diagnostic& warning = sink.report(recordings::in_trace(
            {diag::Code::unmarked_episode, "does not say which encoder made its embeddings"},
            first_));
        if (episodes_ > 1)
            warning.note(fmt::format("this applies to {} of {} episodes", count_, episodes_));
        check::explain_unmarked(warning);
    }

private:
    std::string first_;
    std::size_t count_ = 0;
    std::size_t episodes_ = 0;
};

}  // namespace

bool is_unmarked(const check::Model& model, const std::vector<Index>& inputs,
                 const recordings::NamesInFile& names, const embedded::Marks& marks) {
    return std::any_of(inputs.begin(), inputs.end(), [&](Index index) {
        const check::Input& input = model.inputs[index];
        return check::is_unmarked(input, recordings::name_in_file(input.name, names), marks);
    });
}

void warn_of_unmarked(const Identities& episodes, diag::Sink& sink) {
    Unmarked unmarked;
    episodes.for_each([&](std::size_t, const Recorded& episode) {
        unmarked.add(episode.path, episode.is_unmarked);
    });
    unmarked.report(sink);
}

void warn_of_unmarked(const check::Model& model, const std::vector<Index>& inputs,
                      const std::vector<std::string>& paths, const recordings::NamesInFile& names,
                      diag::Sink& sink) {
    if (model.encoders.empty()) return;
    Unmarked unmarked;
    for (const std::string& path : paths) {
        const auto marks = embedded::read_marks(path);
        unmarked.add(path, marks && is_unmarked(model, inputs, names, *marks));
    }
    unmarked.report(sink);
}

diag::Diagnostic& warn_of_data(diag::Code code, std::string message, source::Span about,
                               diag::Sink& sink) {
    diag::Diagnostic found = data::in_file({code, std::move(message)}, "--data");
    found.span = about;
    return sink.report(std::move(found));
}

bool warn_of_labels(const check::Predicate& predicate, Labels labels,
                    const std::optional<Auroc>& auroc, diag::Sink& sink) {
    const std::uint64_t all = labels.positives + labels.negatives;
    const source::Span span = predicate.threshold.span;
    if (all > 0 && (labels.positives == 0 || labels.negatives == 0)) {
        const bool holds = labels.negatives == 0;
        warn_of_data(diag::Code::one_sided_labels,
                     fmt::format("'{}' is {} at all {}", predicate.name, holds ? "true" : "false",
                                 diag::counted(all, "labelled frame")),
                     span, sink)
            .note(fmt::format("there are no labels of frames at which it is {}: look at its truth "
                              "or its labels truth.{}, or record such frames too",
                              holds ? "false" : "true", predicate.name));
        return true;
    }
    if (!auroc || !auroc->interval || auroc->interval->high >= 0.5) return false;
    warn_of_data(
        diag::Code::inverted_labels,
        fmt::format("the labels of '{}' are the wrong way round for what it measures: the "
                    "area under the ROC curve is {:.2f}, with a 95 % interval from {:.2f} "
                    "to {:.2f}",
                    predicate.name, auroc->value, auroc->interval->low, auroc->interval->high),
        span, sink)
        .note(
            fmt::format("below 0.5, {} numbers are labelled true: look at its truth or its labels "
                        "truth.{}, and at the comparison",
                        predicate.upper_bound() ? "the greater" : "the smaller", predicate.name));
    return true;
}

}  // namespace etlc::episodes
