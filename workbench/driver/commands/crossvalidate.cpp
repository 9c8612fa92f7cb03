#include "driver/commands/crossvalidate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <memory>
#include <set>
#include <thread>

#include "artifacts/fitted.hpp"
#include "calibrate/calibrate.hpp"
#include "calibrate/shift.hpp"
#include "episodes/admission/admission.hpp"
#include "episodes/folds.hpp"
#include "episodes/parallel.hpp"
#include "fit/fit.hpp"
#include "library/version.hpp"
#include "parse/parse.hpp"

namespace etlc::driver {

namespace {

using Paths = std::vector<std::string>;

/// The result of training on all folds but one, or on those before it.
struct Trained {
    Compiled spec;
    fitted::File fitted;
    thresholds::File thresholds;
};

/// Deals the episodes into `count` parts as into folds.
std::vector<Paths> parts(const Paths& episodes, const episodes::ReadOptions& reading,
                         std::size_t count) {
    std::vector<Paths> result(count);
    const auto part_of = episodes::dealt(episodes::groups_of(episodes, reading), count);
    for (std::size_t i = 0; i < episodes.size(); ++i) result[part_of[i]].push_back(episodes[i]);
    return result;
}

/// Reports errors, and warnings that no earlier fold had. The warning about episodes without a
/// named encoder is left to their evaluation.
class Telling {
public:
    explicit Telling(diag::Sink& sink) : sink_(sink) {}

    void tell(const diag::Sink& found, const std::string& note) {
        diag::Sink first;
        for (const diag::Diagnostic& one : found.sorted()) {
            const std::uint32_t place = one.span ? one.span->begin : 0;
            const bool is_new =
                one.code != diag::Code::unmarked_episode && told_.emplace(one.code, place).second;
            if (is_new || one.severity() == diag::Severity::error) first.report(one);
        }
        sink_.add(first, note);
    }

private:
    diag::Sink& sink_;
    std::set<std::pair<diag::Code, std::uint32_t>> told_;
};

/// Trains a spec on the episodes of the other folds. The results of a stage are used to check the
/// spec for the next stage.
class Chain {
public:
    Chain(const source::File& file, const Request& request, calibrate::Request calibration,
          diag::Sink& sink)
        : file_(file), request_(request), calibration_(std::move(calibration)), sink_(sink) {}

    std::optional<Trained> train(const Paths& episodes) {
        const auto untrained = check({true, true, true});
        if (!untrained) return std::nullopt;
        const std::vector<Stage> stages = stages_of(*untrained);
        const episodes::Groups groups(episodes::groups_of(episodes, calibration_.reading));
        if (groups.count() < stages.size()) {
            sink_.report(
                diag::Code::too_few_for_folds, untrained->monitors.front().span,
                fmt::format("fitting and calibration take {} besides those of a fold; there {} {}",
                            diag::counted(stages.size(), groups.are_named() ? "group" : "episode"),
                            groups.count() == 1 ? "is" : "are", groups.count()));
            return std::nullopt;
        }
        const std::vector<Paths> of_stages = parts(episodes, calibration_.reading, stages.size());
        for (std::size_t s = 0; s < stages.size(); ++s)
            if (!(this->*stages[s])(of_stages[s])) return std::nullopt;
        auto model = check({});
        if (!model) return std::nullopt;
        auto compiled = compile(std::move(*model), request_, sink_);
        if (!compiled) return std::nullopt;
        return Trained{std::move(*compiled), std::move(calibration_.fitted),
                       std::move(thresholds_)};
    }

private:
    using Stage = bool (Chain::*)(const Paths& episodes);

    struct Lacks {
        bool fitted = false;
        bool predicates = false;  ///< their thresholds
        bool monitors = false;    ///< their shifts
    };

    /// Returns the stages that the spec needs. Where it needs none, that of the predicates reports
    /// it.
    static std::vector<Stage> stages_of(const check::Model& model) {
        std::vector<Stage> stages;
        const bool has_monitors = !calibrate::calibrated_monitors(model).empty();
        if (!model.fitted.empty()) stages.push_back(&Chain::fit);
        if (!calibrate::calibrated_predicates(model).empty() || (stages.empty() && !has_monitors))
            stages.push_back(&Chain::calibrate_predicates);
        if (has_monitors) stages.push_back(&Chain::calibrate_monitors);
        return stages;
    }

    bool fit(const Paths& episodes) {
        const auto model = check({true, true, true});
        if (!model) return false;
        fit::Request request{episodes, calibration_.reading, calibration_.allow_overlap,
                             calibration_.jobs};
        request.separation = false;  // the fold itself tells how well the fit does elsewhere
        request.version = calibration_.version;
        request.progress = calibration_.progress;
        auto found = fit::fit(*model, request, sink_);
        if (!found) return false;
        calibration_.fitted = std::move(found->file);
        calibration_.fitted.path = kOthers;
        return true;
    }

    bool calibrate_predicates(const Paths& episodes) {
        const auto model = check({false, true, true});
        calibration_.episodes = episodes;
        return model && take(calibrate::calibrate(*model, calibration_, sink_));
    }

    bool calibrate_monitors(const Paths& episodes) {
        const auto model = check({false, false, true});
        calibration_.episodes = episodes;
        return model && take(calibrate::calibrate_monitors(*model, std::move(thresholds_),
                                                           calibration_, sink_));
    }

    bool take(std::optional<calibrate::Calibration> found) {
        if (!found) return false;
        thresholds_ = std::move(found->file);
        thresholds_.path = kOthers;
        return true;
    }

    std::optional<check::Model> check(const Lacks& lacks) {
        check::Options options = request_.check;
        options.judged_lets = true;
        options.allow_unfitted = lacks.fitted;
        options.allow_uncalibrated = lacks.predicates;
        options.allow_uncalibrated_monitors = lacks.monitors;
        options.fitted = &calibration_.fitted;
        options.thresholds = &thresholds_;
        diag::Sink told_before;  // findings about the spec itself, which are reported already
        auto model = check::check(parse::parse(file_, told_before), file_, options, told_before);
        if (!model) sink_.add(told_before, "");
        return model;
    }

    static constexpr const char* kOthers = "the other folds";  ///< stands for a file in messages

    const source::File& file_;
    const Request& request_;
    calibrate::Request calibration_;  ///< with the fitted entries, once they exist
    diag::Sink& sink_;
    thresholds::File thresholds_;
};

/// Returns the episodes of a fold in order.
std::vector<std::size_t> episodes_of(const Folds& folds, std::uint32_t fold) {
    std::vector<std::size_t> episodes;
    for (std::size_t e = 0; e < folds.of.size(); ++e)
        if (folds.of[e] == fold) episodes.push_back(e);
    return episodes;
}

/// Deals the episodes into as many parts of their order, or fewer where a group takes several; a
/// group is in the part of its first episode.
std::vector<std::uint32_t> blocks_of(const episodes::Identities& recorded, std::uint32_t parts) {
    const episodes::Groups groups(recorded);
    constexpr std::uint32_t kNone = UINT32_MAX;
    std::vector<std::uint32_t> of_group(groups.count(), kNone);
    std::vector<std::uint32_t> result;
    std::uint64_t last = 0;
    std::uint32_t block = 0;
    for (std::size_t e = 0; e < recorded.size(); ++e) {
        std::uint32_t& of = of_group[groups.of(e)];
        const std::uint64_t part = e * std::uint64_t{parts} / recorded.size();
        if (of == kNone && part != last) {
            ++block;
            last = part;
        }
        if (of == kNone) of = block;
        result.push_back(of);
    }
    return result;
}

/// Deals the episodes of the request into folds. Reports an error and returns nothing where
/// episodes are copies of each other.
std::optional<Folds> deal(const check::Model& model, const calibrate::Request& request,
                          std::uint32_t folds, bool in_order, diag::Sink& sink) {
    if (!episodes::can_be_dealt(request.episodes, request.reading, folds, model, sink))
        return std::nullopt;
    const auto labelled = episodes::labelled_in(model, request.episodes.front(), request.reading);
    const auto read =
        episodes::over_episodes<episodes::Recorded>(request.episodes, request, sink, [&] {
            return std::make_unique<episodes::ContentScorer>(
                model, request.reading, labelled ? *labelled : std::vector<check::Index>{});
        });
    if (!read) return std::nullopt;
    const auto recorded = episodes::recorded(*read);
    Folds result{folds, {}, in_order, episodes::by_content(recorded), {}};
    result.of = in_order ? blocks_of(recorded, folds) : episodes::folds_of(recorded, folds);
    result.count = *std::max_element(result.of.begin(), result.of.end()) + 1;
    if (result.count <= result.first()) {
        sink.report(diag::Code::too_few_for_folds, model.monitors.front().span,
                    "no episode is left to judge: the group of the first, which only trains, takes "
                    "nearly all of them");
        return std::nullopt;
    }
    // Entries in the file of fitted entries do not matter here.
    result.allowance = episodes::admit(model, recorded, {}, {}, request.allow_overlap, sink);
    if (sink.has_errors()) return std::nullopt;
    return result;
}

/// Trains the spec for each fold that is judged, in their order. Reports errors with their fold.
std::optional<std::vector<Trained>> train(const source::File& file, const Request& request,
                                          const calibrate::Request& calibration, const Folds& folds,
                                          diag::Sink& sink) {
    struct OfFold {
        Paths others;
        diag::Sink found;
        std::optional<Trained> trained;
    };
    std::vector<OfFold> of_folds(folds.count);
    // Much of a fold's work is for one thread, so folds are trained side by side; the last ones,
    // fewer than there are threads, share all threads.
    const std::size_t threads = episodes::threads_for(calibration.jobs, SIZE_MAX);
    const std::size_t beside = std::min<std::size_t>(threads, folds.count);
    const std::size_t last = folds.count % beside;
    const auto train_without = [&](std::uint32_t fold, bool shows_progress) {
        OfFold& of = of_folds[fold];
        for (const std::size_t e : folds.order)
            if (folds.trains(e, fold)) of.others.push_back(calibration.episodes[e]);
        calibrate::Request asked = calibration;
        const bool is_last = fold >= folds.count - last;
        asked.jobs = static_cast<unsigned>(threads / (is_last ? last : beside));
        if (!shows_progress) asked.progress = nullptr;
        of.trained = Chain(file, request, asked, of.found).train(of.others);
    };
    const auto caller = std::this_thread::get_id();  // it alone shows its progress
    std::atomic<std::uint32_t> next = folds.first();
    const auto failure = episodes::in_threads(calibration.jobs, folds.count, [&] {
        for (std::uint32_t fold = next++; fold < folds.count; fold = next++)
            train_without(fold, std::this_thread::get_id() == caller);
    });
    if (failure) std::rethrow_exception(failure);
    std::vector<Trained> all;
    Telling telling(sink);
    for (std::uint32_t fold = folds.first(); fold < folds.count; ++fold) {
        OfFold& of = of_folds[fold];
        telling.tell(of.found, fmt::format("fold {} of {}: trained on {}", fold + 1, folds.count,
                                           diag::counted(of.others.size(), "other episode")));
        if (!of.trained) return std::nullopt;
        all.push_back(std::move(*of.trained));
    }
    return all;
}

}  // namespace

std::optional<evaluate::Judgement> judge_in_folds(const source::File& file,
                                                  const check::Model& model, const Request& request,
                                                  const evaluate::Request& asked,
                                                  std::optional<Folds>& folds, diag::Sink& sink) {
    calibrate::Request calibration;
    calibration.episodes = asked.episodes;
    calibration.reading = asked.reading;
    calibration.allow_overlap = asked.allow_overlap;
    calibration.jobs = asked.jobs;
    calibration.version = library::kVersion;
    calibration.progress = asked.progress;
    if (!folds) folds = deal(model, calibration, request.folds, request.in_order, sink);
    if (!folds) return std::nullopt;
    const auto trained = train(file, request, calibration, *folds, sink);
    if (!trained) return std::nullopt;
    evaluate::Request judged = asked;
    judged.episodes.clear();
    std::vector<evaluate::Trial> trials;
    std::vector<std::size_t> place(folds->of.size());  // among those that are judged
    for (std::size_t e = 0; e < folds->of.size(); ++e) {
        place[e] = judged.episodes.size();
        if (folds->of[e] >= folds->first()) judged.episodes.push_back(asked.episodes[e]);
    }
    judged.only_trained = asked.episodes.size() - judged.episodes.size();
    for (std::uint32_t fold = folds->first(); fold < folds->count; ++fold) {
        const Trained& others = (*trained)[fold - folds->first()];
        std::vector<std::size_t> own = episodes_of(*folds, fold);
        for (std::size_t& e : own) e = place[e];
        trials.push_back({others.spec, others.thresholds, std::move(own), others.fitted});
    }
    auto result = evaluate::judge(trials, judged, sink);
    if (result && folds->allowance.overlapping > 0)
        result->reservations.push_back(thresholds::text(folds->allowance));
    return result;
}

}  // namespace etlc::driver
