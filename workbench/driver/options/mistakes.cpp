#include "driver/options/mistakes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>
#include <utility>

#include "check/names/reserved.hpp"
#include "data/text/text.hpp"
#include "diag/diag.hpp"
#include "driver/options/call.hpp"
#include "driver/process/process.hpp"
#include "episodes/shared/sharing.hpp"
#include "library/settings.hpp"
#include "recordings/open.hpp"

namespace etlc::driver {

std::string read_settings(Call& call, const std::vector<std::string>& words) {
    std::string mistake;
    if (auto parsed = library::parse_settings(words, "--set", mistake))
        call.check.settings = std::move(*parsed);
    return mistake;
}

std::string read_names(Call& call, const std::vector<std::string>& words) {
    for (const std::string& word : words) {
        const std::size_t sign = word.find('=');
        if (sign == std::string::npos || sign == 0 || sign + 1 == word.size())
            return fmt::format("--map takes NAME=NAME_IN_FILE, not {}", data::in_quotes(word));
        const std::string name = word.substr(0, sign);
        if (!call.names.emplace(name, word.substr(sign + 1)).second)
            return fmt::format("--map names {} twice", data::in_quotes(name));
    }
    return "";
}

std::string read_cameras(Call& call, const std::vector<std::string>& words) {
    for (const std::string& word : words) {
        const std::size_t sign = word.find('=');
        const std::string input = sign == std::string::npos ? "" : word.substr(0, sign);
        const std::string camera = sign == std::string::npos ? word : word.substr(sign + 1);
        if (camera.empty() || sign == 0)
            return fmt::format("--camera takes NAME or INPUT=NAME, not '{}'", word);
        if (!call.embed.cameras.emplace(input, camera).second)
            return input.empty() ? "--camera names two cameras"
                                 : fmt::format("--camera names '{}' twice", input);
    }
    return "";
}

namespace {

bool parse_shard(std::string_view text, ShardRequest& request) {
    const std::size_t slash = text.find('/');
    if (slash == std::string_view::npos) return false;
    request.from_input = text.starts_with("-/");
    const auto shard = data::parse_whole<std::uint32_t>(text.substr(0, slash));
    request.shards = data::parse_whole<std::uint32_t>(text.substr(slash + 1)).value_or(0);
    request.shard = request.from_input ? 0 : shard.value_or(0);
    return request.shards >= 1 && request.shards <= episodes::kMostShards &&
           (request.from_input || (request.shard >= 1 && request.shard <= request.shards));
}

}  // namespace

std::string read_shard(Call& call, const std::vector<std::string>& words) {
    if (parse_shard(words.front(), call.shard)) return "";
    return fmt::format("--shard: '{}' is no shard; expected I/N with I from 1 to N: 3/64",
                       words.front());
}

std::string read_split(Call& call, const std::vector<std::string>& words) {
    recordings::Part& part = call.chosen.part;
    std::string_view rest = words.front();
    part.in_order = rest.ends_with(":order");
    if (part.in_order) rest.remove_suffix(std::string_view(":order").size());
    const char* const end = rest.data() + rest.size();
    const auto [colon, bad_from] = std::from_chars(rest.data(), end, part.from);
    const bool has_colon = bad_from == std::errc() && colon != end && *colon == ':';
    const auto [last, bad_to] = std::from_chars(has_colon ? colon + 1 : end, end, part.to);
    if (has_colon && bad_to == std::errc() && last == end && 0 <= part.from &&
        part.from < part.to && part.to <= 1)
        return "";
    return fmt::format(
        "--split: {} is no part; expected FROM:TO or FROM:TO:order, with 0 <= FROM < TO <= 1",
        data::in_quotes(words.front()));
}

std::string read_recorder(Call& call, const std::vector<std::string>& words) {
    std::string why;
    call.recorder = library::parse_recorder(words.front(), why);
    return why.empty() ? "" : "--recorder: " + why;
}

std::string read_variants(Call& call, const std::vector<std::string>& words) {
    std::vector<std::string> names;
    for (const auto& [variant, name] : episodes::kVariants) names.emplace_back(name);
    std::string_view rest = words.front();
    for (bool more = true; more;) {
        const std::size_t comma = rest.find(',');
        const std::string word(rest.substr(0, comma));
        more = comma != std::string_view::npos;
        rest = more ? rest.substr(comma + 1) : "";
        std::string mistake = mistake_in_word(word, names);
        if (!mistake.empty()) return "--variants: " + mistake;
        const auto at = std::find(names.begin(), names.end(), word) - names.begin();
        auto& variants = call.evaluate.variants;
        const episodes::Variant variant = episodes::kVariants[at].first;
        if (std::find(variants.begin(), variants.end(), variant) != variants.end())
            return fmt::format("--variants names '{}' twice", word);
        variants.push_back(variant);
    }
    return "";
}

std::string read_seconds(Call& call, const std::vector<std::string>& words) {
    const std::string& word = words.front();
    const auto seconds = data::parse_number(word);
    if (!seconds || !std::isfinite(*seconds) || *seconds < 0)
        return fmt::format("--at: found {}, expected a number of seconds from 0",
                           data::in_quotes(word));
    call.explain.at = seconds;
    return "";
}

std::string read_suggest(Call& call, const std::vector<std::string>& words) {
    call.fit.suggest = true;
    for (const std::string& word : words)
        if (!word.empty()) call.fit.predicates.push_back(word);  // CLI11 passes "" for no value
    return "";
}

std::string mistake_in_word(const std::string& found, const std::vector<std::string>& expected) {
    if (std::find(expected.begin(), expected.end(), found) != expected.end()) return "";
    return fmt::format("found {}, expected {}{}", data::in_quotes(found),
                       diag::alternatives(expected), data::suggestion(found, expected));
}

std::string mistake_in_number(const std::string& found, std::uint64_t least, std::uint64_t most) {
    const auto number = data::parse_whole<std::uint64_t>(found);
    if (number && least <= *number && *number <= most) return "";
    const bool bounded = most < std::numeric_limits<std::uint64_t>::max();
    return fmt::format("found {}, expected a whole number from {}{}", data::in_quotes(found), least,
                       bounded ? fmt::format(" to {}", most) : "");
}

std::string mistake_in_reason(const std::string& found) {
    constexpr std::size_t kLongest = 200;
    const bool has_words = std::any_of(found.begin(), found.end(),
                                       [](unsigned char c) { return std::isalnum(c) != 0; });
    const bool one_line = found.find_first_of("\n\r") == std::string::npos;
    if (has_words && one_line && found.size() <= kLongest) return "";
    return fmt::format("found {}, expected a reason in words, on one line of at most {} bytes",
                       data::in_quotes(found), kLongest);
}

std::string mistake_in_namespace(const std::string& name) {
    bool is_outermost = true;
    for (std::size_t begin = 0; begin != std::string::npos; is_outermost = false) {
        const std::size_t end = name.find("::", begin);
        const std::string part = name.substr(begin, end - begin);
        begin = end == std::string::npos ? end : end + 2;
        const auto in_names = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
        const bool is_name = !part.empty() &&
                             std::isdigit(static_cast<unsigned char>(part[0])) == 0 &&
                             std::all_of(part.begin(), part.end(), in_names);
        if (!is_name) return fmt::format("'{}' is not the name of a namespace", name);
        if (const auto why = check::why_forbidden(part, is_outermost))
            return fmt::format("'{}' {}; use another name, for example '{}'", part, *why,
                               check::allowed_name(part, "monitors", is_outermost));
    }
    return "";
}

namespace {

std::string mistake_in_retargetable(const Call& call) {
    const Request& request = call;
    if (!request.check.retargetable && request.emit != "params") return "";
    const auto without = [&](const char* option, const char* why) {
        return fmt::format("{} excludes {}: {}",
                           request.emit == "params" ? "--emit params" : "--retargetable", option,
                           why);
    };
    if (request.values == check::Values::boolean)
        return without("--values boolean", "its class computes robustness");
    if (request.explains)
        return without("--explain",
                       "earlier samples would be explained with the present thresholds and rows");
    if (request.recorder)
        return without("--recorder",
                       "etlc incident would read incidents with the parameters of one spec");
    if (request.targets_as != plan::Storage::f32)
        return without("--targets-as",
                       "the error of narrow rows is known for the rows of one spec only");
    for (const char* option : {"--inline-targets", "--targets-file"})
        if (call.has(option)) return without(option, "all its target sets are in its parameters");
    return "";
}

std::string mistake_in_compiling(const Call& call) {
    const bool prints_stage = call.has("--emit");
    if (call.check_only && (prints_stage || !call.output.empty()))
        return "--check goes neither with --emit nor with -o";
    if (!call.check_only && !prints_stage && call.output.empty())
        return "expected -o FILE for the header, or --check";
    if (!call.depfile.empty() && (call.output.empty() || call.output == "-"))
        return "--depfile needs -o FILE";
    if (call.has("--targets-file") && (call.targets.empty() || call.targets == "-" ||
                                       call.targets == call.output || call.targets == call.depfile))
        return "--targets-file needs a separate file";
    if (call.explains && call.values == check::Values::boolean)
        return "--explain follows robustness to the sample that it comes from, and --values "
               "boolean has no robustness: leave out one of the two";
    if (std::string mistake = mistake_in_retargetable(call); !mistake.empty()) return mistake;
    if (call.has("--targets-file") && prints_stage && call.emit != "hpp")
        return "--targets-file goes with the header, not with other stages";
    return "";
}

std::string mistake_in_running(const Call& call) {
    if (call.trace.empty() && call.data.empty())
        return "expected --trace FILE, or --data FILE... for several episodes";
    if (call.trace.empty() && !(call.run.html.empty() && call.run.svg.empty()))
        return "--html and --svg show one trace: they need --trace FILE";
    if (call.trace == recordings::kStandardInput &&
        !(call.run.html.empty() && call.run.svg.empty()))
        return "--html and --svg read the trace once more, so it cannot be standard input";
    return mistake_in_retargetable(call);
}

std::string mistake_in_watching(const Call& call) {
    if (call.watch.video.empty() && call.trace.empty())
        return "expected --video SOURCE, or --trace - for a trace on standard input";
    if (!call.watch.video.empty() && !call.names.empty())
        return "--map names columns of a trace, and --video has none";
    for (const char* option : {"--encoder-cmd", "--onnxruntime", "--encoder-timeout"})
        if (call.watch.video.empty() && call.has(option))
            return fmt::format("{} goes with --video: a trace has embeddings", option);
    if (call.recorder && call.watch.record.empty())
        return "--recorder needs --record FOLDER, where the incidents go";
    return "";
}

std::string mistake_in_embedding(const Request& request) {
    if (request.data.empty() != request.output.empty())
        return request.data.empty() ? "-o takes the episodes of --data, which is missing"
                                    : "--data needs -o FOLDER, where the episodes go";
    const std::string& pipe = request.embed.pipe;
    if (!pipe.empty() && !(request.data.empty() && request.embed.references.empty()))
        return "--pipe encodes frames of standard input, and writes no files";
    if (request.shard.shards > 0 && request.data.empty())
        return "--shard takes a part of the recordings of --data, which is missing";
    return "";
}

std::string mistake_in_shard(const ShardRequest& request) {
    if (request.part == kStandardOutput) return "--part names a file, not standard output";
    if ((request.shards == 0) == request.part.empty()) return "";
    return request.part.empty() ? "--shard needs --part, the file to write"
                                : "--part goes with --shard";
}

std::string mistake_in_evaluating(const Call& call) {
    const auto& specs = call.specs;
    for (auto spec = specs.begin(); spec != specs.end(); ++spec)
        if (std::find(specs.begin(), spec, *spec) != spec)
            return fmt::format("the spec {} is given twice", *spec);
    if (call.shard.shards > 0 && (specs.size() > 1 || call.folds > 0))
        return "--shard goes with one spec, and not with folds";
    for (const char* option : {"--thresholds", "--fitted"}) {
        if (!call.has(option)) continue;
        if (call.folds > 0)
            return fmt::format("{} does not go with folds, which are trained on the episodes",
                               option);
        if (specs.size() > 1)
            return fmt::format("{} goes with one spec; several specs use the files beside them",
                               option);
    }
    return mistake_in_shard(call.shard);
}

}  // namespace

std::string mistake_in_words(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        const bool is_option = word.starts_with("--") && word.ends_with('=');
        if (!word.empty() && !is_option) continue;
        const std::string_view before = is_option ? word.substr(0, word.size() - 1) : argv[i - 1];
        return fmt::format("the word behind {} is empty: is a variable of the shell not set?",
                           data::in_quotes(std::string(i == 1 && !is_option ? "etlc" : before)));
    }
    return "";
}

std::string mistake_in_command(int argc, char** argv) {
    const std::string word = argc > 1 ? argv[1] : "";
    const bool is_path = word.find_first_of("./\\") != std::string::npos;
    std::error_code ignored;
    if (word.empty() || word[0] == '-' || is_path || std::filesystem::exists(word, ignored))
        return "";
    const std::string no_command = fmt::format("there is no command {}", data::in_quotes(word));
    if (word == "help" || word == "version")
        return fmt::format("{}; did you mean '--{}'?", no_command, word);
    const std::vector<std::string> commands = command_names();
    if (const std::string meant = data::suggestion(word, commands); !meant.empty())
        return no_command + meant;
    if (argc == 2 || argv[2][0] == '-') return "";
    return fmt::format("{}; the commands are {}; etlc SPEC.etl compiles a spec", no_command,
                       fmt::join(commands, ", "));
}

std::string mistake_in(const Call& call) {
    switch (call.command) {
        case Command::compile: return mistake_in_compiling(call);
        case Command::run: return mistake_in_running(call);
        case Command::watch: return mistake_in_watching(call);
        case Command::embed: return mistake_in_embedding(call);
        case Command::calibrate: return mistake_in_shard(call.shard);
        case Command::evaluate:
        case Command::crossvalidate: return mistake_in_evaluating(call);
        default: return "";
    }
}

}  // namespace etlc::driver
