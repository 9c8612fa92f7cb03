#include "fit/readings.hpp"

#include <algorithm>
#include <new>

#include "episodes/admission/admission.hpp"
#include "episodes/folds.hpp"
#include "episodes/parallel.hpp"

namespace etlc::fit {

bool Room::take(std::uint64_t count, std::size_t bytes) {
    std::size_t left = left_;
    while (count <= left / bytes)
        if (left_.compare_exchange_weak(left, left - count * bytes)) return true;
    return false;
}

Keeper::Keeper(const episodes::Wanted& wanted, Room& room)
    : wanted_(wanted), room_(room), kept_(std::make_shared<Kept>()) {
    for (const Index input : wanted.inputs)
        bytes_ += sizeof(float) * wanted.model->inputs[input].dimension + 1;
    bytes_ += wanted.predicates.size();
}

void Keeper::add(const episodes::Recording& recording) {
    if (kept_ == nullptr) return;
    try {
        if (kept_->frames == places_ && !make_places(recording.length())) return forget();
        for (const Index input : wanted_.inputs) {
            const plan::Sample& sample = recording.samples()[input];
            kept_->present.push_back(sample.present);
            kept_->values.insert(kept_->values.end(), sample.values.begin(), sample.values.end());
        }
        for (const Index predicate : wanted_.predicates)
            kept_->labels.push_back(recording.label(predicate));
    } catch (const std::bad_alloc&) {  // the episode can be read again
        return forget();
    }
    ++kept_->frames;
}

std::shared_ptr<const Kept> Keeper::take() {
    return std::move(kept_);
}

bool Keeper::make_places(std::uint64_t length) {
    constexpr std::uint64_t kFrames = 64;  // initial room where the length is unknown
    const std::uint64_t more = places_ > 0 ? places_ : length > 0 ? length : kFrames;
    if (!room_.take(more, bytes_)) return false;
    places_ += more;
    std::size_t numbers = 0;
    for (const Index input : wanted_.inputs) numbers += wanted_.model->inputs[input].dimension;
    kept_->values.reserve(places_ * numbers);
    kept_->present.reserve(places_ * wanted_.inputs.size());
    kept_->labels.reserve(places_ * wanted_.predicates.size());
    return true;
}

void Keeper::forget() {
    kept_.reset();
    room_.give_back(places_ * bytes_);
}

KeptFrames::KeptFrames(const episodes::Wanted& wanted, std::shared_ptr<const Kept> kept)
    : wanted_(wanted),
      kept_(std::move(kept)),
      places_(wanted.model->predicates.size()),
      samples_(wanted.model->inputs.size()) {
    for (std::size_t i = 0; i < wanted.predicates.size(); ++i) places_[wanted.predicates[i]] = i;
}

diag::Result<bool> KeptFrames::next() {
    if (frames_ == kept_->frames) return false;
    for (std::size_t i = 0; i < wanted_.inputs.size(); ++i) {
        const Index input = wanted_.inputs[i];
        plan::Sample& sample = samples_[input];
        sample.present = kept_->present[frames_ * wanted_.inputs.size() + i];
        const float* const from = kept_->values.data() + at_;
        const std::size_t n = sample.present ? wanted_.model->inputs[input].dimension : 0;
        sample.values.assign(from, from + n);
        at_ += n;
    }
    ++frames_;
    return true;
}

episodes::Label KeptFrames::label(Index predicate) const {
    return kept_->labels[(frames_ - 1) * wanted_.predicates.size() + places_[predicate]];
}

namespace {

struct Read : episodes::Recorded {
    std::shared_ptr<const Kept> kept;
    std::vector<Index> from_arrays;
};

class Reader {
public:
    Reader(const episodes::Wanted& wanted, const episodes::ReadOptions& reading, Room& room)
        : wanted_(wanted), reading_(reading), room_(room) {}

    diag::Result<Read> score(const std::string& path) const {
        auto recording = episodes::Recording::open(wanted_, path, reading_);
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
    const episodes::ReadOptions& reading_;
    Room& room_;
};

}  // namespace

std::optional<Readings> Readings::read(episodes::Wanted wanted, const Request& request,
                                       diag::Sink& sink) {
    Readings result;
    result.wanted_ = std::make_unique<const episodes::Wanted>(std::move(wanted));
    result.reading_ = request.reading;
    Room room(request.most_kept);
    auto all = episodes::over_episodes<Read>(request.episodes, request, sink, [&] {
        return std::make_unique<Reader>(*result.wanted_, request.reading, room);
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
    auto recording = episodes::Recording::open(*wanted_, episodes_[episode].path, reading_);
    if (!recording) return recording.failure();
    return std::unique_ptr<episodes::Frames>(
        std::make_unique<episodes::Recording>(std::move(*recording)));
}

}  // namespace etlc::fit
