#include "report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <tuple>

#include "data/files/file.hpp"
#include "episodes/parallel.hpp"
#include "report/document.hpp"
#include "report/pictures.hpp"

namespace etlc::report {

namespace {

/// Bytes of a row without its series; rows take at most a quarter of the page.
constexpr std::uint64_t kBytesPerRow = 240;
constexpr std::uint64_t kLeastForSeries = 2048;
constexpr std::uint64_t kLeastForPictures = 20'000;

/// Orders episodes without truths: alarms first, then by the least robustness.
std::tuple<bool, float> badness(const Row& row) {
    bool alarm = false;
    float least = std::numeric_limits<float>::infinity();
    for (const Outcome& outcome : row.outcomes) {
        alarm |= outcome.alarm.has_value();
        least = std::min(least, outcome.robustness);
    }
    return {!alarm, least};
}

Row row_of(const Tracks& tracks) {
    Row row;
    row.path = tracks.path;
    row.frames = tracks.frames;
    row.outcomes = tracks.outcomes;
    for (const execute::SampleCounts& counts : tracks.sample_counts)
        row.missing += counts.missing + counts.out_of_range + counts.stale;
    return row;
}

/// The rows of the page, worst first, with the series and pictures that fit.
class Shelf {
public:
    /// `ranked` rows have a rank from the evaluation.
    Shelf(bool ranked, bool pictured, std::size_t episodes, std::uint64_t bytes)
        : ranked_(ranked),
          most_rows_(std::min<std::uint64_t>(episodes, bytes / 4 / kBytesPerRow)),
          room_((bytes - most_rows_ * kBytesPerRow) / (pictured ? 2 : 1)) {}

    /// Return the bytes available for the series, and for the pictures, of an episode.
    std::uint64_t share() const {
        return std::max(room_ / std::max<std::uint64_t>(1, most_rows_), kLeastForSeries);
    }
    std::uint64_t share_of_pictures() const {
        return std::clamp(room_ / std::max<std::uint64_t>(1, most_rows_), kLeastForPictures,
                          std::max(room_, kLeastForPictures));
    }

    void add(Row row) {
        series_ += row.blob.text.size();
        pictures_ += row.pictures.bytes();
        const auto at =
            std::upper_bound(rows_.begin(), rows_.end(), row,
                             [&](const Row& a, const Row& b) { return is_worse(a, b); });
        rows_.insert(at, std::move(row));
        if (rows_.size() > most_rows_) {
            take_from(rows_.back(), true, true);
            rows_.pop_back();
        }
        // The best episodes lose theirs first.
        for (std::size_t i = rows_.size(); (series_ > room_ || pictures_ > room_) && i-- > 0;)
            take_from(rows_[i], series_ > room_, pictures_ > room_);
    }

    std::vector<Row> take() { return std::move(rows_); }

private:
    bool is_worse(const Row& a, const Row& b) const {
        return ranked_ ? a.rank < b.rank : badness(a) < badness(b);
    }
    void take_from(Row& row, bool series, bool pictures) {
        if (series) series_ -= row.blob.text.size();
        if (pictures) pictures_ -= row.pictures.bytes();
        if (series) row.blob = {};
        if (pictures) row.pictures = {};
    }

    bool ranked_;
    std::uint64_t most_rows_;
    std::uint64_t room_;  ///< bytes for series, and as many again for pictures
    std::uint64_t series_ = 0;
    std::uint64_t pictures_ = 0;
    std::vector<Row> rows_;
};

std::vector<Index> shown_predicates(const Material& material) {
    std::vector<Index> shown = material.spec.plan.predicates;
    if (material.truth != nullptr)
        shown.insert(shown.end(), material.truth->labelled.begin(), material.truth->labelled.end());
    std::sort(shown.begin(), shown.end());
    shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
    return shown;
}

/// Reads and packs episodes, on one thread.
class Packer {
public:
    Packer(const Scene& scene, const Request& request, const Shelf& shelf)
        : reader_(scene), scene_(scene), request_(request), shelf_(shelf) {}

    struct Packed {
        Row row;
        std::vector<execute::SampleCounts> sample_counts;
    };
    diag::Result<Packed> score(const std::string& path) {
        const auto tracks = reader_.score(path);
        if (!tracks) return tracks.failure();
        Packed packed{row_of(*tracks), tracks->sample_counts};
        packed.row.blob = blob_of(*tracks, shelf_.share());
        if (request_.frames.text.empty()) return packed;
        const double seconds = scene_.plan.model->step_seconds;
        auto pictures =
            pictures_of(request_.frames, path, {tracks->frames, seconds > 0 ? 1 / seconds : 0},
                        telling_steps(*tracks), shelf_.share_of_pictures());
        if (!pictures) return pictures.failure();
        packed.row.pictures = std::move(*pictures);
        return packed;
    }

private:
    TrackReader reader_;
    const Scene& scene_;
    const Request& request_;
    const Shelf& shelf_;
};

/// Collects the packed episodes, in order.
class Gathering {
public:
    Gathering(const plan::Plan& plan, const std::vector<evaluate::EpisodeRow>& judged, Shelf& shelf)
        : ranked_(!judged.empty()), shelf_(shelf) {
        totals.sample_counts.resize(plan.inputs.size());
        for (std::size_t i = 0; i < judged.size(); ++i) rank_.emplace(judged[i].path, i);
    }

    void add(Packer::Packed packed) {
        ++totals.episodes;
        totals.steps += packed.row.frames;
        for (std::size_t i = 0; i < totals.sample_counts.size(); ++i) {
            totals.sample_counts[i].missing += packed.sample_counts[i].missing;
            totals.sample_counts[i].out_of_range += packed.sample_counts[i].out_of_range;
            totals.sample_counts[i].stale += packed.sample_counts[i].stale;
            totals.sample_counts[i].held += packed.sample_counts[i].held;
        }
        if (ranked_) packed.row.rank = rank_.at(packed.row.path);
        if (!packed.row.pictures.why.empty() && unpictured++ == 0)
            first_unpictured = data::in_file({diag::Code::frames_left_out, packed.row.pictures.why},
                                             packed.row.path);
        shelf_.add(std::move(packed.row));
    }

    Totals totals;
    std::uint64_t unpictured = 0;  ///< episodes without pictures
    diag::Diagnostic first_unpictured{};

private:
    bool ranked_;
    Shelf& shelf_;
    std::map<std::string, std::size_t> rank_;
};

/// Reports episodes without pictures. Returns false if none has any.
bool report_unpictured(const Gathering& gathered, diag::Sink& sink) {
    if (gathered.unpictured == 0) return true;
    const bool none = gathered.unpictured == gathered.totals.episodes;
    diag::Diagnostic found = gathered.first_unpictured;
    if (none) found.code = diag::Code::no_frames;
    sink.report(std::move(found))
        .note(none ? "no episode has the pictures that --frames names"
                   : fmt::format("{} of {} without pictures", gathered.unpictured,
                                 diag::counted(gathered.totals.episodes, "episode")));
    return !none;
}

}  // namespace

bool Page::write(const std::function<bool(std::string_view)>& take) const {
    if (!take(head_)) return false;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Row& row = rows_[i];
        const std::string text = text_of(row, judged_.empty() ? nullptr : &judged_[row.rank]);
        if ((i > 0 && !take(",")) || !take(text)) return false;
    }
    return take(tail_);
}

std::optional<Page> page(const Material& material, const Request& request, diag::Sink& sink) {
    if (!check_pattern(request.frames, request.episodes.size(), sink)) return std::nullopt;
    const plan::Plan& plan = material.spec.plan;
    std::optional<Compiled> truth;
    if (material.truth != nullptr) {
        truth =
            compile(material.truth->truth.model, {request.limits, check::Values::boolean}, sink);
        if (!truth) return std::nullopt;
    }
    Scene scene{plan,
                shown_predicates(material),
                material.truth,
                truth ? &truth->plan : nullptr,
                request.reading,
                {},
                {}};
    auto drawn = planes(*plan.model, scene.predicates, request.episodes, request.reading);
    if (!drawn) {
        sink.report(recordings::in_trace(drawn.failure(), request.episodes[0]));
        return std::nullopt;
    }
    scene.planes = std::move(*drawn);
    scene.target_pictures = pictures_of_targets(*plan.model, scene.predicates,
                                                request.megabytes * 1'000'000 / 10, sink);

    std::vector<evaluate::EpisodeRow> judged;
    std::string figures = "null";
    if (material.judgement != nullptr) {
        judged = evaluate::by_episode(*material.judgement);
        evaluate::SideBySide one;
        one.specs.push_back(
            {material.file.path(), evaluate::summarise(*material.judgement, request.jobs), {}});
        figures = in_script(evaluate::json(one));
    }
    const Totals none{0, 0, std::vector<execute::SampleCounts>(plan.inputs.size())};
    const std::uint64_t bytes = request.megabytes * 1'000'000;
    const std::string shown = predicates(material, scene);
    Frame frame = frame_of(figures);
    frame.after.insert(0, kEnd);
    const std::uint64_t fixed =
        frame.before.size() + head(material, scene, shown, none).size() + frame.after.size();
    Shelf shelf(!judged.empty(), !request.frames.text.empty(), request.episodes.size(),
                bytes > 2 * fixed ? bytes - fixed : bytes / 2);
    Gathering gathered(plan, judged, shelf);
    const bool read = episodes::in_order<Packer::Packed>(
        request.episodes, request, sink,
        [&] { return std::make_unique<Packer>(scene, request, shelf); },
        [&](std::size_t, Packer::Packed packed) { gathered.add(std::move(packed)); });
    if (!read || !report_unpictured(gathered, sink)) return std::nullopt;
    return Page(frame.before + head(material, scene, shown, gathered.totals), shelf.take(),
                std::move(judged), std::move(frame.after));
}

}  // namespace etlc::report
