#include "fit/readings.hpp"

#include <algorithm>

#include "episodes/admission/admission.hpp"
#include "episodes/folds.hpp"
#include "episodes/parallel.hpp"

namespace etlc::fit {

namespace {

struct Read : episodes::Recorded {
    std::shared_ptr<const Kept> kept;
    std::vector<Index> from_arrays;
};

class Reader {
public:
    Reader(const episodes::Wanted& wanted, const data::NamesInFile& names, Room& room)
        : wanted_(wanted), names_(names), room_(room) {}

    diag::Result<Read> score(const std::string& path) const {
        auto recording = episodes::Recording::open(wanted_, path, names_);
        if (!recording) return recording.failure();
        Keeper keeper(wanted_, room_);
        for (;;) {
            const auto more = recording->next();
            if (!more) return more.failure();
            if (!*more) break;
            keeper.add(*recording);
        }
        Read result{recording->recorded(), keeper.take(), {}};
        for (const Index predicate : wanted_.predicates)
            if (recording->from_array(predicate)) result.from_arrays.push_back(predicate);
        return result;
    }

private:
    const episodes::Wanted& wanted_;
    const data::NamesInFile& names_;
    Room& room_;
};

}  // namespace

std::optional<Readings> Readings::read(episodes::Wanted wanted, const Request& request,
                                       diag::Sink& sink) {
    Readings result;
    result.wanted_ = std::make_unique<const episodes::Wanted>(std::move(wanted));
    result.names_ = request.names;
    Room room(request.most_kept);
    auto all = episodes::over_episodes<Read>(request.episodes, request, sink, [&] {
        return std::make_unique<Reader>(*result.wanted_, request.names, room);
    });
    if (!all) return std::nullopt;
    result.labelling_.episodes = all->size();
    for (const std::size_t e : episodes::by_content(episodes::recorded(*all))) {
        Read& one = (*all)[e];
        for (const Index predicate : one.from_arrays) ++result.labelling_.from_arrays[predicate];
        result.index_.emplace(one.path, result.episodes_.size());
        result.kept_.push_back(std::move(one.kept));
        result.episodes_.push_back(std::move(static_cast<episodes::Recorded&>(one)));
    }
    return result;
}

std::vector<std::string> Readings::paths() const {
    std::vector<std::string> result;
    for (const episodes::Recorded& episode : episodes_) result.push_back(episode.path);
    return result;
}

diag::Result<std::unique_ptr<episodes::Frames>> Readings::open(std::size_t episode) const {
    if (kept_[episode] != nullptr)
        return std::unique_ptr<episodes::Frames>(
            std::make_unique<KeptFrames>(*wanted_, kept_[episode]));
    auto recording = episodes::Recording::open(*wanted_, episodes_[episode].path, names_);
    if (!recording) return recording.failure();
    return std::unique_ptr<episodes::Frames>(
        std::make_unique<episodes::Recording>(std::move(*recording)));
}

}  // namespace etlc::fit
