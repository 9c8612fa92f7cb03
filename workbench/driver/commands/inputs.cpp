// The names of inputs and the files of a call.
#include <fmt/format.h>

#include <algorithm>

#include "data/files/file.hpp"
#include "data/text/text.hpp"
#include "driver/commands/commands.hpp"
#include "recordings/open.hpp"

namespace etlc::driver {

bool check_names(const std::vector<const check::Model*>& models,
                 const recordings::NamesInFile& names, diag::Sink& sink) {
    std::vector<std::string> known;
    for (const check::Model* model : models) {
        for (const check::Input& input : model->inputs) known.push_back(input.name);
        for (const check::Predicate& predicate : model->predicates)
            if (!predicate.name.empty()) known.push_back("truth." + predicate.name);
    }
    bool sound = true;
    for (const auto& [name, in_file] : names) {
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        std::string message =
            fmt::format("{} input {}", models.size() == 1 ? "the spec has no" : "no spec has an",
                        data::in_quotes(name)) +
            data::suggestion(name, known);
        sink.report(data::in_file({diag::Code::no_such_channel, message},
                                  fmt::format("--map {}={}", name, in_file)));
        sound = false;
    }
    return sound;
}

bool read_labels(const std::vector<const check::Model*>& models, const Request& request,
                 const std::vector<std::string>& episodes, episodes::ReadOptions& reading,
                 diag::Sink& sink) {
    episodes::LabelSources sources = request.labels;
    sources.has_episodes = request.merged == nullptr;
    reading.labels = episodes::LabelSet::read(sources, models, episodes, sink);
    return !sink.has_errors();
}

std::vector<std::string> label_tables(const episodes::ReadOptions& reading) {
    return reading.labels ? reading.labels->tables() : std::vector<std::string>{};
}

std::vector<std::string> files_read(const check::Model& model, const source::File& spec,
                                    const std::vector<std::string>& recordings,
                                    const episodes::ReadOptions& reading) {
    std::vector<std::string> files = label_tables(reading);
    files.insert(files.end(), model.dependencies.begin(), model.dependencies.end());
    files.push_back(spec.path());
    for (const std::string& recording : recordings) files.push_back(data::trace_file(recording));
    return files;
}

}  // namespace etlc::driver
