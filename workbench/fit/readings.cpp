#include "fit/readings.hpp"

#include <utility>

#include "episodes/admission/admission.hpp"
#include "episodes/folds.hpp"
#include "episodes/parallel.hpp"

namespace etlc::fit {

namespace {

struct Read : episodes::Recorded {
    std::vector<Index> from_arrays;
    std::optional<diag::Failure> unlabelled{};  ///< why it has no label of a predicate
};

class Reader {
public:
    Reader(const episodes::Wanted& wanted, const episodes::ReadOptions& reading)
        : wanted_(wanted), reading_(reading) {}

    diag::Result<Read> score(const std::string& path) const {
        auto recording = episodes::Recording::open(wanted_, path, reading_);
        if (!recording && recording.failure().code == diag::Code::no_label) {
            Read result;
            result.path = path;
            result.unlabelled = recording.failure();
            return result;
        }
        if (!recording) return recording.failure();
        for (;;) {
            const auto more = recording->next();
            if (!more) return more.failure();
            if (!*more) break;
        }
        Read result{recording->recorded(), {}};
        for (const Index predicate : wanted_.predicates)
            if (recording->from_array(predicate)) result.from_arrays.push_back(predicate);
        return result;
    }

private:
    const episodes::Wanted& wanted_;
    const episodes::ReadOptions& reading_;
};

}  // namespace

std::optional<Readings> Readings::read(episodes::Wanted wanted, const Request& request,
                                       diag::Sink& sink) {
    Readings result;
    result.wanted_ = std::make_unique<const episodes::Wanted>(std::move(wanted));
    result.reading_ = request.reading;
    if (!result.reading_.kept)
        result.reading_.kept = std::make_shared<episodes::KeptTraces>(request.most_kept);
    auto all = episodes::over_episodes<Read>(request.episodes, request, sink, [&] {
        return std::make_unique<Reader>(*result.wanted_, result.reading_);
    });
    if (!all) return std::nullopt;
    std::vector<episodes::Fault> unlabelled;
    for (const Read& one : *all)
        if (one.unlabelled) unlabelled.push_back({one.path, *one.unlabelled});
    if (unlabelled.size() == all->size()) {
        episodes::report(unlabelled, all->size(), sink);
        return std::nullopt;
    }
    for (const episodes::Fault& one : unlabelled) result.unlabelled_.push_back(one.path);
    std::erase_if(*all, [](const Read& one) { return one.unlabelled.has_value(); });
    result.labelling_.episodes = all->size();
    for (const std::size_t e : episodes::by_content(episodes::recorded(*all))) {
        Read& one = (*all)[e];
        for (const Index predicate : one.from_arrays) ++result.labelling_.from_arrays[predicate];
        result.index_.emplace(one.path, result.episodes_.size());
        result.episodes_.push_back(std::move(static_cast<episodes::Recorded&>(one)));
    }
    return result;
}

std::vector<std::string> Readings::paths() const {
    std::vector<std::string> result;
    for (const episodes::Recorded& episode : episodes_) result.push_back(episode.path);
    return result;
}

diag::Result<episodes::Recording> Readings::open(std::size_t episode) const {
    return episodes::Recording::open(*wanted_, episodes_[episode].path, reading_);
}

}  // namespace etlc::fit
