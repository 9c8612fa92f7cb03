#include "fit/collect.hpp"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "check/guarantees/guarantees.hpp"
#include "episodes/admission/admission.hpp"
#include "episodes/folds.hpp"
#include "episodes/parallel.hpp"
#include "episodes/truth.hpp"

namespace etlc::fit {

namespace {

using check::kNone;
using episodes::Label;

/// Counts and takes the frames of an episode for a need.
class Collector {
public:
    Collector(const Need& need, std::size_t most_frames)
        : need_(need), taken_(most_frames, need.away) {}

    /// Adds a frame; `point` is empty where missing. Returns the class of the frame.
    std::int8_t add(std::uint64_t step, Label holds, const std::vector<float>& point) {
        const bool yes = holds == Label::yes;
        if (need_.kind == Need::Kind::frames) yes ? taken_.add(step, point) : taken_.add_other();
        if (holds == Label::unknown) {
            ++counts_.unknown;
            return Blocks::kNone;
        }
        if (point.empty()) {
            ++counts_.missing;
            return Blocks::kNone;
        }
        ++(yes ? counts_.holds : counts_.others);
        if (yes) return kHolds;
        return need_.kind == Need::Kind::classes ? 0 : Blocks::kNone;
    }

    Collected take() {
        Collected result;
        for (TakenFrame& frame : taken_.take()) result.frames.push_back({0, std::move(frame)});
        counts_.episodes = counts_.holds > 0 ? 1 : 0;
        result.counts = counts_;
        return result;
    }

private:
    const Need& need_;
    EvenFrames taken_;
    Counts counts_;
};

/// A point, and the needs for it.
struct PointNeeds {
    Index point = 0;
    std::vector<std::size_t> all;
    std::vector<std::size_t> with_moments;  ///< those of `all` with moments
};

std::vector<PointNeeds> by_point(const std::vector<Need>& needs) {
    std::vector<PointNeeds> result;
    for (std::size_t i = 0; i < needs.size(); ++i) {
        auto at = std::find_if(result.begin(), result.end(),
                               [&](const PointNeeds& one) { return one.point == needs[i].point; });
        if (at == result.end()) at = result.insert(at, {needs[i].point, {}, {}});
        at->all.push_back(i);
        if (needs[i].kind != Need::Kind::frames) at->with_moments.push_back(i);
    }
    return result;
}

/// Returns the predicates whose labels these needs read: those with a truth or with an array of
/// labels, and those that lack both, so that reading reports them.
std::set<Index> labelled_predicates(const check::Model& model, const std::vector<Need>& needs,
                                    const std::vector<Index>& have_labels) {
    std::set<Index> found;
    for (const Need& need : needs) {
        if (need.label != kNone) found.insert(need.label);
        if (need.where == kNone) continue;
        for (const Index predicate : check::predicates_of(model, need.where))
            if (!check::is_own_truth(model, predicate) ||
                std::binary_search(have_labels.begin(), have_labels.end(), predicate))
                found.insert(predicate);
    }
    return found;
}

std::vector<Index> formulas_of(const std::vector<Need>& needs) {
    std::vector<Index> formulas;
    for (const Need& need : needs)
        if (need.where != kNone) formulas.push_back(need.where);
    return formulas;
}

std::vector<Index> points_of(const std::vector<Need>& needs) {
    std::vector<Index> points;
    for (const Need& need : needs) points.push_back(need.point);
    return points;
}

/// Returns what to read of an episode, for these needs and to measure.
episodes::Wanted wanted_for(const check::Model& model, const std::vector<Need>& needs,
                            const std::vector<Measured>& measured,
                            const std::vector<Index>& have_labels) {
    episodes::Wanted result;
    result.model = &model;
    result.identity = episodes::identity_inputs(model);
    std::set<Index> inputs(result.identity.begin(), result.identity.end());
    const auto add = [&](const std::vector<Index>& more) {
        inputs.insert(more.begin(), more.end());
    };
    std::set<Index> labelled = labelled_predicates(model, needs, have_labels);
    for (const Measured& one : measured) {
        add(model.predicates[one.predicate].inputs);
        labelled.insert(one.label);
    }
    result.predicates.assign(labelled.begin(), labelled.end());
    for (const Need& need : needs) add(model.points[need.point].inputs);
    const episodes::GroundTruth truth = episodes::ground_truth(model, result.predicates);
    const episodes::TruthEvaluator where(truth.model, formulas_of(needs));
    for (const Index input : where.inputs())
        if (input < model.inputs.size()) inputs.insert(input);  // the others are labels
    result.inputs.assign(inputs.begin(), inputs.end());
    return result;
}

/// How the frames to take are shared among the episodes.
struct Shares {
    std::size_t most = 0;   ///< frames of an episode that gives any
    std::size_t every = 1;  ///< one of so many episodes gives frames
};

/// Episodes of one fold that are collected together, because a scatter costs D squared numbers to
/// make and merge, however few frames are in it.
struct Batch {
    std::vector<std::size_t> episodes;
    std::uint64_t frames = 0;
};

/// Returns the batches in the order of their first episodes.
std::vector<Batch> batches_of(const Collection& collection) {
    constexpr std::uint64_t kFrames = 1024;
    std::vector<Batch> result;
    std::vector<std::optional<std::size_t>> open(collection.folds.size());  // per fold
    const std::vector<episodes::Recorded>& episodes = collection.recordings.episodes();
    for (std::size_t e = 0; e < episodes.size(); ++e) {
        std::optional<std::size_t>& batch = open[collection.fold_of(e)];
        if (!batch || result[*batch].frames + episodes[e].frames > kFrames) {
            batch = result.size();
            result.emplace_back();
        }
        result[*batch].episodes.push_back(e);
        result[*batch].frames += episodes[e].frames;
    }
    return result;
}

/// The result of a batch.
struct Gathered {
    std::vector<Collected> needs;  ///< sources name their episodes
    std::optional<episodes::Fault> fault;
};

class Reader {
public:
    Reader(const check::Model& model, const std::vector<Need>& needs, const Recordings& recordings,
           const std::map<std::string, Batch>& batches, Shares shares)
        : model_(model),
          needs_(needs),
          recordings_(recordings),
          batches_(batches),
          points_(by_point(needs)),
          truth_(episodes::ground_truth(model, recordings.wanted().predicates)),
          where_(truth_.model, formulas_of(needs)),
          shares_(shares),
          recent_(model, points_of(needs)) {
        for (const PointNeeds& one : points_) blocks_.push_back(blocks_of(one));
    }

    /// Reads the batch whose first episode this is.
    diag::Result<Gathered> score(const std::string& first) {
        Gathered result{std::vector<Collected>(needs_.size()), {}};
        for (const std::size_t episode : batches_.at(first).episodes) {
            const auto done = add(episode, result.needs);
            if (done) continue;
            result.fault = {recordings_.episodes()[episode].path, done.failure()};
            break;
        }
        for (std::size_t p = 0; p < points_.size(); ++p) {
            std::vector<Moments> moments = blocks_[p].take();
            for (std::size_t i = 0; i < moments.size(); ++i)
                result.needs[points_[p].with_moments[i]].moments = std::move(moments[i]);
        }
        return result;
    }

private:
    diag::Result<bool> add(std::size_t episode, std::vector<Collected>& collected) {
        auto opened = recordings_.open(episode);
        if (!opened) return opened.failure();
        episodes::Recording& frames = *opened;
        is_demonstration_ = frames.outcome().is_demonstration();
        where_.reset();
        recent_.reset();
        std::vector<Collector> collectors;
        for (const Need& need : needs_) collectors.emplace_back(need, shares_.most);
        for (;;) {
            const auto more = frames.next();
            if (!more) return more.failure();
            if (!*more) break;
            take_labels(frames);
            recent_.push(frames.samples());
            for (std::size_t p = 0; p < points_.size(); ++p)
                take_point(frames, points_[p], collectors, blocks_[p]);
        }
        for (std::size_t n = 0; n < needs_.size(); ++n) {
            Collected one = collectors[n].take();
            collected[n].counts.add(one.counts);
            if (episode % shares_.every != 0) continue;
            for (Source& source : one.frames)
                collected[n].frames.push_back({episode, std::move(source.frame)});
        }
        return true;
    }

    Blocks blocks_of(const PointNeeds& one) const {
        std::vector<bool> with_scatter;
        for (const std::size_t i : one.with_moments)
            with_scatter.push_back(needs_[i].kind != Need::Kind::mean);
        return {model_.points[one.point].dimension, std::move(with_scatter)};
    }

    /// Adds the point of one frame.
    void take_point(const episodes::Frames& frames, const PointNeeds& one,
                    std::vector<Collector>& collectors, Blocks& blocks) {
        if (!recent_.read(one.point, point_)) point_.clear();
        classes_.clear();
        for (const std::size_t i : one.all) {
            const std::int8_t in_class =
                collectors[i].add(frames.frames() - 1, label(frames, needs_[i]), point_);
            if (needs_[i].kind != Need::Kind::frames) classes_.push_back(in_class);
        }
        if (!point_.empty() && !classes_.empty()) blocks.add(point_, classes_);
    }

    void take_labels(const episodes::Frames& frames) {
        frame_.resize(truth_.model.inputs.size());
        for (const Index input : where_.inputs()) {
            std::vector<double>& values = frame_[input];
            values.clear();
            if (input >= model_.inputs.size()) continue;
            const execute::Sample& sample = frames.samples()[input];
            if (sample.present) values.assign(sample.values.begin(), sample.values.end());
        }
        for (const Index predicate : recordings_.wanted().predicates) {
            const execute::Sample sample = episodes::sample_of(frames.label(predicate));
            frame_[truth_.inputs[predicate]].assign(sample.values.begin(), sample.values.end());
        }
        where_.step(frame_);
    }

    Label label(const episodes::Frames& frames, const Need& need) const {
        if (need.label != kNone) return frames.label(need.label);
        if (need.where != kNone) return where_[need.where];
        return is_demonstration_ ? Label::yes : Label::no;
    }

    const check::Model& model_;
    const std::vector<Need>& needs_;
    const Recordings& recordings_;
    const std::map<std::string, Batch>& batches_;  ///< by the path of the first episode
    std::vector<PointNeeds> points_;
    std::vector<Blocks> blocks_;  ///< per point
    episodes::GroundTruth truth_;
    episodes::TruthEvaluator where_;
    bool is_demonstration_ = true;  ///< the episode at hand
    Shares shares_;
    episodes::RecentFrames recent_;
    episodes::Frame frame_;
    std::vector<float> point_;
    std::vector<std::int8_t> classes_;
};

/// Merges one more batch into a fold, per need.
void merge(std::vector<Collected>& fold, std::vector<Collected>&& batch) {
    std::vector<Moments*> all;
    std::vector<const Moments*> more;
    for (std::size_t n = 0; n < fold.size(); ++n) {
        fold[n].counts.add(batch[n].counts);
        std::move(batch[n].frames.begin(), batch[n].frames.end(),
                  std::back_inserter(fold[n].frames));
        if (batch[n].moments.dimension() == 0) continue;
        if (fold[n].moments.dimension() == 0)
            fold[n].moments = Moments(batch[n].moments.dimension());
        all.push_back(&fold[n].moments);
        more.push_back(&batch[n].moments);
    }
    Moments::merge(all, more);
}

struct Read : episodes::Recorded {
    std::vector<Index> from_arrays;
    std::optional<diag::Failure> unlabelled{};  ///< why it has no label of a predicate
};

class OrderedReader {
public:
    OrderedReader(const episodes::Wanted& wanted, const episodes::ReadOptions& reading)
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

void Counts::add(const Counts& other) {
    holds += other.holds;
    others += other.others;
    unknown += other.unknown;
    missing += other.missing;
    episodes += other.episodes;
}

Index innermost(const check::Model& model, Index point) {
    while (model.points[point].is_projected()) point = model.points[point].inner;
    return point;
}

std::optional<Collection> collect(const check::Model& model, const std::vector<Need>& needs,
                                  const std::vector<Measured>& measured, const Request& request,
                                  diag::Sink& sink) {
    const auto have_labels =
        episodes::labelled_in(model, request.episodes.front(), request.reading);
    if (!have_labels) {
        sink.report(recordings::in_trace(have_labels.failure(), request.episodes.front()));
        return std::nullopt;
    }
    auto recordings =
        Recordings::read(wanted_for(model, needs, measured, *have_labels), request, sink);
    if (!recordings) return std::nullopt;
    Collection all{std::move(*recordings), {}, {}};
    const std::size_t count = all.recordings.episodes().size();
    const auto groups = episodes::groups_of(all.recordings.paths(), request.reading);
    all.folds.assign(std::min<std::size_t>(kFolds, episodes::Groups(groups).count()),
                     std::vector<Collected>(needs.size()));
    all.dealt = episodes::dealt(groups, all.folds.size());
    const Shares shares{std::max<std::size_t>(1, kMostFrames / count),
                        (count + kMostFrames - 1) / kMostFrames};
    std::vector<std::string> firsts;
    std::map<std::string, Batch> batches;  // by their first paths
    for (Batch& batch : batches_of(all)) {
        firsts.push_back(all.recordings.episodes()[batch.episodes.front()].path);
        batches.emplace(firsts.back(), std::move(batch));
    }
    std::vector<episodes::Fault> faults;
    const bool done = episodes::in_order<Gathered>(
        firsts, request, sink,
        [&] { return std::make_unique<Reader>(model, needs, all.recordings, batches, shares); },
        [&](std::size_t i, Gathered&& batch) {
            const std::size_t first = batches.at(firsts[i]).episodes.front();
            if (batch.fault) return faults.push_back(std::move(*batch.fault));
            merge(all.folds[all.fold_of(first)], std::move(batch.needs));
        });
    episodes::report(faults, count, sink);
    if (!done || !faults.empty()) return std::nullopt;
    return all;
}

Blocks::Blocks(Eigen::Index dimension, std::vector<bool> with_scatter)
    : frames_(dimension, kFrames),
      with_scatter_(std::move(with_scatter)),
      classes_(with_scatter_.size()),
      moments_(with_scatter_.size(), Moments(dimension)) {}

void Blocks::add(const std::vector<float>& point, const std::vector<std::int8_t>& classes) {
    frames_.col(filled_++) = Eigen::Map<const Eigen::VectorXf>(point.data(), frames_.rows());
    for (std::size_t i = 0; i < classes.size(); ++i) classes_[i].push_back(classes[i]);
    if (filled_ == kFrames) flush();
}

std::vector<Moments> Blocks::take() {
    flush();
    std::vector<Moments> result(moments_.size(), Moments(frames_.rows()));
    std::swap(result, moments_);
    return result;
}

void Blocks::flush() {
    std::map<std::vector<bool>, std::shared_ptr<Scatter>> scatters;  // by the frames in them
    std::vector<Moments> block;
    for (std::size_t i = 0; i < classes_.size(); ++i) {
        std::shared_ptr<Scatter> shared;
        if (with_scatter_[i]) {
            std::vector<bool> selected;
            for (const std::int8_t c : classes_[i]) selected.push_back(c != kNone);
            std::shared_ptr<Scatter>& found = scatters[selected];
            if (found == nullptr) found = scatter(selected);
            shared = found;
        }
        block.emplace_back(Moments::Means{mean(i, 0), mean(i, 1)}, std::move(shared));
    }
    scatters.clear();  // drops the other references
    std::vector<Moments*> all;
    std::vector<const Moments*> more;
    for (std::size_t i = 0; i < block.size(); ++i) {
        all.push_back(&moments_[i]);
        more.push_back(&block[i]);
        classes_[i].clear();
    }
    Moments::merge(all, more);
    filled_ = 0;
}

std::shared_ptr<Scatter> Blocks::scatter(const std::vector<bool>& selected) {
    selected_.resize(frames_.rows(), kFrames);
    Eigen::Index to = 0;
    for (std::size_t f = 0; f < selected.size(); ++f)
        if (selected[f])
            selected_.col(to++) = frames_.col(static_cast<Eigen::Index>(f)).cast<double>();
    std::shared_ptr<Scatter> result = unused_scatter();
    result->set(selected_.leftCols(to));
    return result;
}

std::shared_ptr<Scatter> Blocks::unused_scatter() {
    for (const std::shared_ptr<Scatter>& one : scatters_) {
        if (one.use_count() > 1) continue;
        std::atomic_thread_fence(std::memory_order_acquire);  // another thread may have held it
        return one;
    }
    scatters_.push_back(std::make_shared<Scatter>());
    return scatters_.back();
}

Mean Blocks::mean(std::size_t need, std::size_t of_class) const {
    Mean result = Mean::none(frames_.rows());
    for (std::size_t f = 0; f < classes_[need].size(); ++f) {
        if (classes_[need][f] != static_cast<std::int8_t>(of_class)) continue;
        result.mean += frames_.col(static_cast<Eigen::Index>(f)).cast<double>();
        ++result.n;
    }
    if (result.n > 0) result.mean /= static_cast<double>(result.n);
    return result;
}

void EvenFrames::add(std::uint64_t step, const std::vector<float>& values) {
    const bool far_enough = since_change_ == away_;
    if (!far_enough) ++since_change_;
    pending_.push_back({step, far_enough ? values : std::vector<float>{}});
    if (pending_.size() <= away_) return;
    keep(std::move(pending_.front()));
    pending_.pop_front();
}

void EvenFrames::add_other() {
    pending_.clear();
    since_change_ = 0;
}

void EvenFrames::keep(TakenFrame frame) {
    if (frame.values.empty()) return;
    if (sound_++ % stride_ != 0) return;
    kept_.push_back(std::move(frame));
    if (kept_.size() < 2 * most_) return;
    for (std::size_t i = 0; 2 * i < kept_.size(); ++i)
        if (i > 0) kept_[i] = std::move(kept_[2 * i]);
    kept_.resize(most_);
    stride_ *= 2;
}

std::vector<TakenFrame> EvenFrames::take() {
    for (TakenFrame& frame : pending_) keep(std::move(frame));
    pending_.clear();
    if (kept_.size() <= most_) return std::move(kept_);
    std::vector<TakenFrame> result;
    for (std::size_t i = 0; i < most_; ++i)
        result.push_back(std::move(kept_[i * kept_.size() / most_]));
    return result;
}

std::optional<Recordings> Recordings::read(episodes::Wanted wanted, const Request& request,
                                           diag::Sink& sink) {
    Recordings result;
    result.wanted_ = std::make_unique<const episodes::Wanted>(std::move(wanted));
    result.reading_ = request.reading;
    if (!result.reading_.cache)
        result.reading_.cache = std::make_shared<episodes::TraceCache>(request.cache_bytes);
    auto all = episodes::over_episodes<Read>(request.episodes, request, sink, [&] {
        return std::make_unique<OrderedReader>(*result.wanted_, result.reading_);
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

std::vector<std::string> Recordings::paths() const {
    std::vector<std::string> result;
    for (const episodes::Recorded& episode : episodes_) result.push_back(episode.path);
    return result;
}

diag::Result<episodes::Recording> Recordings::open(std::size_t episode) const {
    return episodes::Recording::open(*wanted_, episodes_[episode].path, reading_);
}

}  // namespace etlc::fit
