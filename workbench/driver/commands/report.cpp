#include <algorithm>
#include <utility>

#include "driver/commands/commands.hpp"
#include "driver/process/process.hpp"
#include "episodes/admission/admission.hpp"
#include "recordings/episodes.hpp"

namespace etlc::driver {

namespace {

using check::Index;

/// The truths that the episodes are compared with, or why there are none.
struct Truths {
    std::optional<evaluate::Subject> subject;
    std::string why_not;
};

/// Finds the truths by the first episode: there are none where it lacks what truths read.
diag::Result<Truths> truths_of(const Compiled& compiled, const std::string& episode,
                               const episodes::ReadOptions& reading) {
    const check::Model& model = *compiled.model;
    auto labelled = episodes::labelled_in(model, episode, reading);
    if (!labelled) return labelled.failure();
    const auto complete =
        episodes::Recording::open({&model, compiled.plan.inputs, *labelled}, episode, reading);
    if (!complete) {
        const auto samples =
            episodes::Recording::open({&model, compiled.plan.inputs}, episode, reading);
        if (!samples) return samples.failure();
        return Truths{{}, complete.failure().message};
    }
    evaluate::Subject subject = evaluate::subject(model, *labelled);
    if (!evaluate::has_truths(subject))
        return Truths{{}, "neither the spec nor the episodes say when a predicate truly holds"};
    return Truths{std::move(subject), ""};
}

}  // namespace

bool report(const source::File& spec, const Compiled& compiled, const Request& request,
            diag::Sink& sink) {
    const check::Model& model = *compiled.model;
    auto wanted = asked_of<report::Request>(request);
    wanted.frames = request.report.frames;
    wanted.megabytes = request.report.megabytes;
    wanted.limits = request.limits;
    if (!check_names({&model}, wanted.reading.names, sink)) return false;
    wanted.episodes = recordings::find_episodes(request.data, request.chosen, sink);
    if (sink.has_errors()) return false;
    if (!request.report.without_truths &&
        !read_labels({&model}, request, wanted.episodes, wanted.reading, sink))
        return false;
    if (!check_outputs({request.output}, files_read(model, spec, wanted.episodes, wanted.reading),
                       sink))
        return false;
    OutputFiles output(sink);
    if (!output.begin(request.output)) return false;  // before the work, so that errors come early

    Truths truths{{}, "none were asked for"};
    if (!request.report.without_truths) {
        auto found = truths_of(compiled, wanted.episodes[0], wanted.reading);
        if (!found) {
            sink.report(recordings::in_trace(found.failure(), wanted.episodes[0]));
            return false;
        }
        truths = std::move(*found);
    }
    constexpr std::size_t kCacheBytes = std::size_t{64} << 20U;  // for figures, then for tracks
    wanted.reading.cache = std::make_shared<episodes::TraceCache>(kCacheBytes);
    report::Material material{spec, compiled};
    material.thresholds = thresholds_of(model, spec.path(), request);
    material.why_no_truth = truths.why_not;
    std::optional<evaluate::Judgement> judgement;
    const bool has_outcomes = wanted.reading.labels && wanted.reading.labels->has_outcomes();
    if (truths.subject || has_outcomes) {
        auto held_to = asked_of<evaluate::Request>(request);
        held_to.episodes = wanted.episodes;
        held_to.reading = wanted.reading;
        held_to.allow_overlap = request.allow_overlap;
        held_to.limits = request.limits;
        judgement = judge_as_it_is(compiled, spec.path(), request, held_to, sink);
        if (!judgement) return false;
        if (truths.subject) material.truth = &*truths.subject;
        material.judgement = &*judgement;
    }
    if (!judgement)
        episodes::warn_of_unmarked(model, compiled.plan.inputs, wanted.episodes,
                                   wanted.reading.names, sink);
    const auto page = report::page(material, wanted, sink);
    return page && !sink.refused() &&
           page->write([&](std::string_view piece) { return output.write(piece); }) &&
           output.commit();
}

std::optional<std::string> page_of_trace(const source::File& spec, const Compiled& compiled,
                                         const std::string& trace,
                                         const recordings::NamesInFile& names, diag::Sink& sink) {
    report::Material material{spec, compiled};
    material.why_no_truth = "etlc run shows what the monitors say; etlc report compares it";
    report::Request wanted;
    wanted.episodes = {trace};
    wanted.reading.names = names;
    wanted.jobs = 1;
    const auto page = report::page(material, wanted, sink);
    if (!page) return std::nullopt;
    std::string text;
    page->write([&](std::string_view piece) {
        text += piece;
        return true;
    });
    return text;
}

}  // namespace etlc::driver
