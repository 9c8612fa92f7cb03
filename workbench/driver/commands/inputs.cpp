// The names of inputs and the files of a call.
#include <fmt/format.h>

#include <algorithm>

#include "data/files/file.hpp"
#include "data/recordings/open.hpp"
#include "data/text/quote.hpp"
#include "driver/commands/commands.hpp"

namespace etlc::driver {

bool check_names(const std::vector<const check::Model*>& models, const data::NamesInFile& names,
                 diag::Sink& sink) {
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

std::vector<std::string> files_read(const check::Model& model, const source::File& spec,
                                    const std::vector<std::string>& recordings) {
    std::vector<std::string> files = model.dependencies;
    files.push_back(spec.path());
    for (const std::string& recording : recordings) files.push_back(data::trace_file(recording));
    return files;
}

}  // namespace etlc::driver
