#include "fit/collect.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "check/guarantees/guarantees.hpp"
#include "check/guarantees/provenance.hpp"
#include "episodes/ground_truth.hpp"
#include "episodes/parallel.hpp"
#include "fit/blocks.hpp"

namespace etlc::fit {

namespace {

using check::kNone;
using episodes::Label;

/// What a need counts and takes of the frames of an episode.
class Collector {
public:
    Collector(const Need& need, std::size_t most_frames)
        : need_(need), taken_(most_frames, need.away) {}

    /// `point`: empty where it is missing. Gives: the class that the frame is in.
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

/// A point, and the needs that ask about it.
struct PointNeeds {
    Index point = 0;
    std::vector<std::size_t> all;
    std::vector<std::size_t> with_moments;  ///< of these
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

/// The predicates in these needs whose labels are wanted: those with a truth, and those that would
/// need an array.
std::vector<Index> labelled_predicates(const check::Model& model, const std::vector<Need>& needs,
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
    return {found.begin(), found.end()};
}

std::vector<Index> formulas_of(const std::vector<Need>& needs) {
    std::vector<Index> formulas;
    for (const Need& need : needs)
        if (need.where != kNone) formulas.push_back(need.where);
    return formulas;
}

struct Episode : episodes::Recorded {
    std::vector<Collected> collected;  ///< per need
    std::vector<Index> from_arrays;
};

/// How frames are shared out among the episodes.
struct Shares {
    std::size_t most = 0;   ///< frames of an episode that gives some
    std::size_t every = 1;  ///< of so many episodes one gives some
};

class Reader {
public:
    Reader(const check::Model& model, const std::vector<Need>& needs, std::vector<Index> labelled,
           std::size_t most_frames, const data::NamesInFile& names)
        : model_(model),
          needs_(needs),
          points_(by_point(needs)),
          truth_(episodes::ground_truth(model, labelled)),
          where_(truth_.model, formulas_of(needs)),
          most_frames_(most_frames),
          names_(names) {
        wanted_.model = &model;
        wanted_.predicates = std::move(labelled);
        wanted_.identity = episodes::identity_inputs(model);
        std::set<Index> inputs(wanted_.identity.begin(), wanted_.identity.end());
        for (const Need& need : needs)
            inputs.insert(model.points[need.point].inputs.begin(),
                          model.points[need.point].inputs.end());
        for (const Index input : where_.inputs())
            if (input < model.inputs.size()) inputs.insert(input);  // the others are labels
        wanted_.inputs.assign(inputs.begin(), inputs.end());
    }

    diag::Result<Episode> score(const std::string& path) {
        auto recording = episodes::Recording::open(wanted_, path, names_);
        if (!recording) return recording.failure();
        where_.reset();
        std::vector<Collector> collectors;
        for (const Need& need : needs_) collectors.emplace_back(need, most_frames_);
        std::vector<Blocks> blocks;
        for (const PointNeeds& one : points_) blocks.push_back(blocks_of(one));
        for (;;) {
            const auto more = recording->next();
            if (!more) return more.failure();
            if (!*more) break;
            take_labels(*recording);
            for (std::size_t p = 0; p < points_.size(); ++p)
                take_point(*recording, points_[p], collectors, blocks[p]);
        }
        Episode result;
        static_cast<episodes::Recorded&>(result) = recording->recorded();
        for (Collector& collector : collectors) result.collected.push_back(collector.take());
        for (std::size_t p = 0; p < points_.size(); ++p) {
            std::vector<Moments> moments = blocks[p].take();
            for (std::size_t i = 0; i < moments.size(); ++i)
                result.collected[points_[p].with_moments[i]].moments = std::move(moments[i]);
        }
        for (const Index predicate : wanted_.predicates)
            if (recording->from_array(predicate)) result.from_arrays.push_back(predicate);
        return result;
    }

private:
    Blocks blocks_of(const PointNeeds& one) const {
        std::vector<bool> with_scatter;
        for (const std::size_t i : one.with_moments)
            with_scatter.push_back(needs_[i].kind != Need::Kind::mean);
        return {model_.points[one.point].dimension, std::move(with_scatter)};
    }

    /// Of one frame.
    void take_point(const episodes::Recording& recording, const PointNeeds& one,
                    std::vector<Collector>& collectors, Blocks& blocks) {
        if (!read_point(model_, one.point, recording.samples(), point_)) point_.clear();
        classes_.clear();
        for (const std::size_t i : one.all) {
            const std::int8_t in_class =
                collectors[i].add(recording.frames() - 1, label(recording, needs_[i]), point_);
            if (needs_[i].kind != Need::Kind::frames) classes_.push_back(in_class);
        }
        if (!point_.empty() && !classes_.empty()) blocks.add(point_, classes_);
    }

    void take_labels(const episodes::Recording& recording) {
        frame_.resize(truth_.model.inputs.size());
        for (const Index input : where_.inputs()) {
            std::vector<double>& values = frame_[input];
            values.clear();
            if (input >= model_.inputs.size()) continue;
            const plan::Sample& sample = recording.samples()[input];
            if (sample.present) values.assign(sample.values.begin(), sample.values.end());
        }
        for (const Index predicate : wanted_.predicates) {
            const plan::Sample sample = episodes::sample_of(recording.label(predicate));
            frame_[truth_.inputs[predicate]].assign(sample.values.begin(), sample.values.end());
        }
        where_.step(frame_);
    }

    Label label(const episodes::Recording& recording, const Need& need) const {
        if (need.label != kNone) return recording.label(need.label);
        return need.where == kNone ? Label::yes : where_[need.where];
    }

    const check::Model& model_;
    const std::vector<Need>& needs_;
    std::vector<PointNeeds> points_;
    episodes::GroundTruth truth_;
    episodes::TruthEvaluator where_;
    episodes::Wanted wanted_;
    std::size_t most_frames_;
    const data::NamesInFile& names_;
    episodes::Frame frame_;
    std::vector<float> point_;
    std::vector<std::int8_t> classes_;
};

/// Of one more episode, per need.
void merge(std::vector<Collected>& fold, std::vector<Collected>&& episode, std::size_t number,
           bool with_frames) {
    std::vector<Moments*> all;
    std::vector<const Moments*> more;
    for (std::size_t n = 0; n < fold.size(); ++n) {
        fold[n].counts.add(episode[n].counts);
        for (Source& source : episode[n].frames)
            if (with_frames) fold[n].frames.push_back({number, std::move(source.frame)});
        if (episode[n].moments.dimension() == 0) continue;
        if (fold[n].moments.dimension() == 0)
            fold[n].moments = Moments(episode[n].moments.dimension());
        all.push_back(&fold[n].moments);
        more.push_back(&episode[n].moments);
    }
    Moments::merge(all, more);
}

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

bool read_point(const check::Model& model, Index point, const std::vector<plan::Sample>& samples,
                std::vector<float>& values) {
    values.clear();
    for (const Index input : model.points[point].inputs) {
        const plan::Sample& sample = samples[input];
        if (!sample.present) return false;
        for (const float x : sample.values) {
            if (!std::isfinite(x) || !model.inputs[input].range.contains(x)) return false;
            values.push_back(x);
        }
    }
    return true;
}

std::optional<Collection> collect(const check::Model& model, const std::vector<Need>& needs,
                                  const std::vector<std::string>& paths, const Request& request,
                                  diag::Sink& sink) {
    const auto have_labels = episodes::labelled_in(model, paths.front(), request.names);
    if (!have_labels) {
        sink.report(data::in_trace(have_labels.failure(), paths.front()));
        return std::nullopt;
    }
    const std::vector<Index> labelled = labelled_predicates(model, needs, *have_labels);
    const Shares shares{std::max<std::size_t>(1, kMostFrames / paths.size()),
                        (paths.size() + kMostFrames - 1) / kMostFrames};
    Collection all;
    all.folds.assign(std::min(kFolds, paths.size()), std::vector<Collected>(needs.size()));
    std::set<Index> from_spec;
    std::set<Index> from_arrays;
    const bool done = episodes::in_order<Episode>(
        paths, request, sink,
        [&] {
            return std::make_unique<Reader>(model, needs, labelled, shares.most, request.names);
        },
        [&](std::size_t i, Episode&& episode) {
            merge(all.folds[all.fold_of(i)], std::move(episode.collected), i,
                  i % shares.every == 0);
            from_arrays.insert(episode.from_arrays.begin(), episode.from_arrays.end());
            for (const Index predicate : labelled)
                if (std::find(episode.from_arrays.begin(), episode.from_arrays.end(), predicate) ==
                    episode.from_arrays.end())
                    from_spec.insert(predicate);
            all.episodes.push_back(std::move(static_cast<episodes::Recorded&>(episode)));
        });
    if (!done) return std::nullopt;
    for (const Index predicate : from_arrays)
        if (!from_spec.contains(predicate)) all.from_arrays.push_back(predicate);
    return all;
}

}  // namespace etlc::fit
