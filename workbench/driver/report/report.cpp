#include "driver/report/report.hpp"

#include <algorithm>
#include <utility>

#include "data/recordings/episodes.hpp"
#include "driver/compile/names.hpp"
#include "driver/evaluate/evaluate.hpp"
#include "driver/process/output_file.hpp"
#include "driver/process/progress.hpp"
#include "episodes/data_warnings.hpp"

namespace etlc::driver {

namespace {

using check::Index;

/// What the episodes are held to, or why to nothing.
struct Truths {
    std::optional<evaluate::Subject> subject;
    std::string why_not;
};

/// As the first episode tells: where it lacks what only truths read, there are none.
diag::Result<Truths> truths_of(const Compiled& compiled, const std::string& episode,
                               const data::NamesInFile& names) {
    const check::Model& model = *compiled.model;
    auto labelled = episodes::labelled_in(model, episode, names);
    if (!labelled) return labelled.failure();
    const auto complete =
        episodes::Recording::open({&model, compiled.plan.inputs, *labelled}, episode, names);
    if (!complete) {
        const auto samples =
            episodes::Recording::open({&model, compiled.plan.inputs}, episode, names);
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
            const ReportRequest& asked, diag::Sink& sink) {
    const check::Model& model = *compiled.model;
    report::Request wanted = asked.report;
    if (!check_names({&model}, wanted.names, sink)) return false;
    wanted.episodes = data::find_episodes(asked.data, asked.groups, sink);
    if (sink.has_errors()) return false;
    std::vector<std::string> inputs = model.dependencies;
    inputs.push_back(spec.path());
    for (const std::string& episode : wanted.episodes) inputs.push_back(data::trace_file(episode));
    if (!check_outputs({asked.output}, inputs, sink)) return false;
    OutputFiles output(sink);
    if (!output.begin(asked.output)) return false;  // before the work, not after it
    wanted.progress = episodes_progress();
    wanted.limits = request.limits;

    Truths truths{{}, "none were asked for"};
    if (!asked.without_truths) {
        auto found = truths_of(compiled, wanted.episodes[0], wanted.names);
        if (!found) {
            sink.report(data::in_trace(found.failure(), wanted.episodes[0]));
            return false;
        }
        truths = std::move(*found);
    }
    report::Material material{spec, compiled};
    material.thresholds = thresholds_of(model, spec.path(), request);
    material.why_no_truth = truths.why_not;
    std::optional<evaluate::Judgement> judgement;
    if (truths.subject) {
        evaluate::Request held_to{wanted.episodes, wanted.names,  asked.allow_overlap,
                                  wanted.jobs,     wanted.limits, wanted.progress};
        judgement = judge_as_it_is(compiled, spec.path(), request, held_to, sink);
        if (!judgement) return false;
        material.truth = &*truths.subject;
        material.judgement = &*judgement;
    }
    if (!judgement)
        episodes::warn_of_unmarked(model, compiled.plan.inputs, wanted.episodes, wanted.names,
                                   sink);
    const auto page = report::page(material, wanted, sink);
    return page && !sink.refused() && output.write(*page) && output.commit();
}

std::optional<std::string> page_of_trace(const source::File& spec, const Compiled& compiled,
                                         const std::string& trace, const data::NamesInFile& names,
                                         diag::Sink& sink) {
    report::Material material{spec, compiled};
    material.why_no_truth = "etlc run shows what the monitors say; etlc report compares it";
    report::Request wanted;
    wanted.episodes = {trace};
    wanted.names = names;
    wanted.jobs = 1;
    return report::page(material, wanted, sink);
}

}  // namespace etlc::driver
