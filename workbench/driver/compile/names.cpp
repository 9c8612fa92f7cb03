#include "driver/compile/names.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data/files/file.hpp"
#include "data/text/quote.hpp"

namespace etlc::driver {

std::optional<data::NamesInFile> parse_names(const std::vector<std::string>& words,
                                             std::string& why) {
    data::NamesInFile names;
    for (const std::string& word : words) {
        const std::size_t sign = word.find('=');
        if (sign == std::string::npos || sign == 0 || sign + 1 == word.size())
            why = fmt::format("--map takes NAME=NAME_IN_FILE, not {}", data::in_quotes(word));
        else if (!names.emplace(word.substr(0, sign), word.substr(sign + 1)).second)
            why = fmt::format("--map names {} twice", data::in_quotes(word.substr(0, sign)));
        if (!why.empty()) return std::nullopt;
    }
    return names;
}

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
                        data::in_quotes(name));
        if (const auto meant = diag::nearest_name(name, known))
            message += fmt::format("; did you mean {}?", data::in_quotes(*meant));
        sink.report(data::in_file({diag::Code::no_such_channel, message},
                                  fmt::format("--map {}={}", name, in_file)));
        sound = false;
    }
    return sound;
}

}  // namespace etlc::driver
