#include "fit/collect.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "check/guarantees/guarantees.hpp"
#include "check/guarantees/provenance.hpp"
#include "episodes/ground_truth.hpp"
#include "episodes/parallel.hpp"

namespace etlc::fit {

namespace {

using check::kNone;
using episodes::Label;

/// Frames of one class, added to the moments a block at a time.
class Block {
public:
    Block(Eigen::Index dimension, std::size_t of_class)
        : frames_(dimension, kFrames), of_class_(of_class) {}

    void add(const std::vector<float>& values, Moments& moments) {
        frames_.col(filled_++) =
            Eigen::Map<const Eigen::VectorXf>(values.data(), frames_.rows()).cast<double>();
        if (filled_ == kFrames) flush(moments);
    }
    void flush(Moments& moments) {
        moments.add(of_class_, frames_.leftCols(filled_));
        filled_ = 0;
    }

private:
    static constexpr Eigen::Index kFrames = 256;

    Matrix frames_;
    std::size_t of_class_;
    Eigen::Index filled_ = 0;
};

/// Collects a need in one episode.
class Collector {
public:
    Collector(const Need& need, Eigen::Index dimension, std::size_t most_frames)
        : need_(need), taken_(most_frames, need.away) {
        if (need.kind == Need::Kind::frames) return;
        collected_.moments = Moments(dimension, need.kind != Need::Kind::mean);
        blocks_.emplace_back(dimension, 0);
        blocks_.emplace_back(dimension, 1);
    }

    /// `point`: null where it is missing.
    void add(std::uint64_t step, Label holds, const std::vector<float>* point) {
        static const std::vector<float> kMissing;
        Counts& counts = collected_.counts;
        const bool yes = holds == Label::yes;
        if (holds == Label::unknown)
            ++counts.unknown;
        else if (point == nullptr)
            ++counts.missing;
        else
            ++(yes ? counts.holds : counts.others);
        if (need_.kind == Need::Kind::frames) {
            if (!yes) return taken_.add_other();
            return taken_.add(step, point != nullptr ? *point : kMissing);
        }
        if (point == nullptr || holds == Label::unknown) return;
        if (!yes && need_.kind != Need::Kind::classes) return;
        blocks_[yes ? 1 : 0].add(*point, collected_.moments);
    }

    Collected take(std::size_t episode) {
        for (Block& block : blocks_) block.flush(collected_.moments);
        for (TakenFrame& frame : taken_.take())
            collected_.frames.push_back({episode, std::move(frame)});
        collected_.counts.episodes = collected_.counts.holds > 0 ? 1 : 0;
        return std::move(collected_);
    }

private:
    const Need& need_;
    EvenFrames taken_;
    std::vector<Block> blocks_;  ///< per class
    Collected collected_;
};

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
        for (const Need& need : needs_)
            collectors.emplace_back(need, model_.points[need.point].dimension, most_frames_);
        for (;;) {
            const auto more = recording->next();
            if (!more) return more.failure();
            if (!*more) break;
            take_labels(*recording);
            for (std::size_t i = 0; i < needs_.size(); ++i) {
                const bool there =
                    read_point(model_, needs_[i].point, recording->samples(), point_);
                collectors[i].add(recording->frames() - 1, label(*recording, needs_[i]),
                                  there ? &point_ : nullptr);
            }
        }
        Episode result;
        static_cast<episodes::Recorded&>(result) = recording->recorded();
        for (Collector& collector : collectors) result.collected.push_back(collector.take(0));
        for (const Index predicate : wanted_.predicates)
            if (recording->from_array(predicate)) result.from_arrays.push_back(predicate);
        return result;
    }

private:
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
    episodes::GroundTruth truth_;
    episodes::TruthEvaluator where_;
    episodes::Wanted wanted_;
    std::size_t most_frames_;
    const data::NamesInFile& names_;
    episodes::Frame frame_;
    std::vector<float> point_;
};

/// Those behind a need of the second are put behind those of the first.
void merge(Collected& all, Collected&& more, std::size_t episode, bool with_frames) {
    if (all.moments.dimension() == 0)
        all.moments = std::move(more.moments);
    else
        all.moments.merge(more.moments);
    all.counts.add(more.counts);
    for (Source& source : more.frames)
        if (with_frames) all.frames.push_back({episode, std::move(source.frame)});
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
            std::vector<Collected>& fold = all.folds[all.fold_of(i)];
            for (std::size_t n = 0; n < needs.size(); ++n)
                merge(fold[n], std::move(episode.collected[n]), i, i % shares.every == 0);
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
