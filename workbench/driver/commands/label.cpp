#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "check/check.hpp"
#include "driver/commands/commands.hpp"
#include "driver/process/process.hpp"
#include "fit/fit.hpp"
#include "label/propose.hpp"
#include "label/serve.hpp"
#include "library/version.hpp"
#include "parse/parse.hpp"
#include "recordings/episodes.hpp"

namespace etlc::driver {

namespace {

/// Checks a spec that has no thresholds yet, with these fitted entries or without any.
std::optional<check::Model> check_unlabelled(const source::File& file, const Request& request,
                                             const fitted::File* fitted, diag::Sink& sink) {
    check::Options options = without_results(request.check);
    options.allow_unfitted = fitted == nullptr;
    options.fitted = fitted;
    return check::check(parse::parse(file, sink), file, options, sink);
}

/// Fits what the spec declares fitted to the labelled episodes, and proposes labels for the others.
std::optional<label::Proposals> learned(const source::File& file, const check::Model& model,
                                        const label::Desk& desk, const Request& request,
                                        diag::Sink& sink) {
    if (model.fitted.empty()) return label::propose(model, desk, request.names, sink);
    auto asked = asked_of<fit::Request>(request);
    asked.progress = nullptr;
    asked.allow_overlap = "these labels are proposals";
    asked.version = library::kVersion;
    asked.episodes = label::labelled_episodes(desk);
    if (!read_labels({&model}, request, asked.episodes, asked.reading, sink)) return std::nullopt;
    auto found = fit::fit(model, asked, sink);
    if (!found) return std::nullopt;
    found->file.path = "the labelled episodes";
    diag::Sink told_before;
    const auto complete = check_unlabelled(file, request, &found->file, told_before);
    if (!complete) sink.add(told_before, "");
    if (!complete) return std::nullopt;
    return label::propose(*complete, desk, request.names, sink);
}

bool print_proposals(const source::File& file, const check::Model& model, const label::Desk& desk,
                     const Request& request, diag::Sink& sink) {
    label::Proposals proposals;
    if (label::labelled_episodes(desk).size() >= label::kEnoughLabelled) {
        auto found = learned(file, model, desk, request, sink);
        if (found) proposals = std::move(*found);
        for (const diag::Diagnostic& one : sink.sorted())
            if (!found && proposals.why_none.empty() && one.severity() == diag::Severity::error)
                proposals.why_none = one.message;
    }
    return print(label::text_of(proposals, desk), sink) && !sink.has_errors();
}

/// Returns the call that prints proposals for the same labels.
std::vector<std::string> call_for_proposals(const Request& request) {
    std::vector<std::string> words = request.words;
    words.emplace_back("--proposals");
    return words;
}

}  // namespace

bool label(const source::File& file, const Request& request, diag::Sink& sink) {
    const auto model = check_unlabelled(file, request, nullptr, sink);
    if (!model || sink.refused() || !check_names({&*model}, request.names, sink)) return false;
    label::DeskRequest wanted{recordings::find_episodes(request.data, request.chosen, sink),
                              request.names,
                              request.labels.tables.empty() ? "" : request.labels.tables.front()};
    if (sink.has_errors()) return false;
    const std::vector<std::string> inputs = files_read(*model, file, wanted.episodes);
    auto desk = label::Desk::open(*model, std::move(wanted), sink);
    if (!desk || !check_outputs(desk->tables(), inputs, sink)) return false;
    if (request.label.proposals) return print_proposals(file, *model, *desk, request, sink);
    if (!report::check_pattern(request.report.frames, desk->episodes().size(), sink)) return false;

    label::Frames frames({request.report.frames, model->step_seconds});
    label::PageRequest page{model->name, file.path(), model->step_seconds, {}};
    for (const label::Episode& episode : desk->episodes())
        page.has_frames.push_back(frames.has(episode));
    label::Background background(call_for_proposals(request));
    const auto ready = [&](const std::string& address) {
        std::string text = address + "\n";
        for (const std::string& table : desk->tables())
            text += fmt::format("Labels go to {}.\n", table);
        return print(text + "Open the address in a browser; Ctrl-C ends this program.\n", sink);
    };
    const diag::Failure ended = label::serve(
        *desk, frames, background, {label::page_of(*desk, page), request.label.port, ready});
    if (!sink.has_errors()) sink.report(data::in_file(ended, "the page"));
    return false;
}

}  // namespace etlc::driver
