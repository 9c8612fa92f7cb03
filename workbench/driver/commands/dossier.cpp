// `etlc dossier`: collects in a folder what an engineer needs who signs for a generated class. All
// of it is said elsewhere: by the header, `etlc prove`, gcov, `--emit report` and the pages.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "data/files/file.hpp"
#include "data/files/hash.hpp"
#include "driver/commands/commands.hpp"
#include "driver/process/process.hpp"
#include "emit/emit.hpp"
#include "library/version.hpp"
#include "prove/coverage.hpp"

/// Sections of docs/generated_code.md and docs/firmware.md.
extern const char* const kDossierPages;

namespace etlc::driver {

namespace {

namespace fs = std::filesystem;

/// Returns why nothing is proved. Without that a dossier is still of use; with a wrong class it is
/// not.
std::optional<std::string> why_not_proved(const diag::Sink& findings) {
    std::string why;
    for (const diag::Diagnostic& found : findings.sorted()) {
        if (found.code != diag::Code::no_proof) return std::nullopt;
        if (why.find(found.message) == std::string::npos) why += found.message + "\n";
    }
    return why;
}

/// The lines of the class that ran in the proof, and the branches that were taken.
struct Executed {
    std::string summary;
    std::string annotated;  ///< the header, each line with its count; empty: nothing is known
};

Executed counted(const std::string& header, const std::vector<prove::Line>& lines) {
    Executed result;
    std::size_t ran = 0, ways = 0, taken = 0, number = 0;
    auto line = lines.begin();
    for (const std::string_view of_header : split_lines(header)) {
        const bool has_code = line != lines.end() && line->number == number + 1;
        std::string count, missed;
        if (has_code) {
            count = line->count > 0 ? fmt::format("{}", line->count) : "#####";
            ran += line->count > 0 ? 1 : 0;
            const auto never = static_cast<std::size_t>(
                std::count(line->ways.begin(), line->ways.end(), std::uint64_t{0}));
            ways += line->ways.size();
            taken += line->ways.size() - never;
            if (never > 0) missed = fmt::format("{}/{}", never, line->ways.size());
            ++line;
        }
        result.annotated +=
            fmt::format("{:>10} {:>5} {:>5}: {}", count, missed, ++number, of_header);
    }
    result.summary = fmt::format(
        "The proof ran {} of {} lines of the class, and took {} of {} branches.\n"
        "`coverage.txt` has the class with the count of each line (`#####`: none), and of its "
        "branches those never taken.\nDistances and thresholds are not part of the proof: they "
        "are values without a number there.",
        ran, lines.size(), taken, ways);
    return result;
}

Executed executed_of(const std::optional<Certified>& certified, const std::string& header) {
    if (!certified) return {"Nothing: there is no proof.", ""};
    const auto lines = prove::coverage_of(certified->coverage, "class.hpp");
    if (lines) return counted(header, *lines);
    return {"It is not known: $GCOV, or gcov, cannot say, for example after clang++.", ""};
}

/// Returns the comment at the head of a header.
std::string head_of(const std::string& header) {
    std::string text;
    for (const std::string_view line : split_lines(header)) {
        if (!line.starts_with("//")) break;
        text += line.substr(std::min<std::size_t>(3, line.size() - 1));
    }
    return text;
}

struct File {
    std::string name;
    std::string what;
    std::string hash;
};

std::string index_of(const std::string& spec, const std::string& head, const std::string& executed,
                     const std::vector<File>& files) {
    std::string text = fmt::format(
        "# {0}: what there is to know about the class\n\nMade by etlc {1}. "
        "XXH64 tells files apart; it is no defence against forgery.\n\n| file | XXH64 | |\n"
        "| --- | --- | --- |\n",
        spec, library::kVersion);
    for (const File& file : files)
        text += fmt::format("| {} | {} | {} |\n", file.name, file.hash, file.what);
    text += fmt::format(
        "\n## What the class was made from, and what its thresholds are worth\n```\n{}```\n"
        "A guarantee is a probability over the episodes of the calibration and new ones together. "
        "It\nholds if these are exchangeable: the same robot, camera, light, task and encoder. "
        "It says nothing\nabout one particular episode, and nothing after any of these has "
        "changed.\n\n"
        "## What was executed\n{}\n",
        head, executed);
    return text + kDossierPages;
}

}  // namespace

bool dossier(const source::File& spec, const Compiled& compiled, const Request& request,
             diag::Sink& sink) {
    const fs::path folder = request.output;
    const std::string stem = fs::path(spec.path()).stem().string();
    diag::Sink findings;
    auto certified = certify(spec, compiled.plan, request, true, findings);
    const auto why = certified ? std::string() : why_not_proved(findings);
    if (!why) {
        sink.add(findings, "");
        return false;
    }
    if (!make_folder(request.output, sink)) return false;
    Request header = request;
    header.output = (folder / (stem + ".hpp")).string();
    if (!emit(spec, header, sink)) return false;

    const emit::Options options{request.name_space, library::kVersion, "", stem + ".targets.bin"};
    const std::string text = emit::header(compiled.plan, options);
    std::vector<File> files{{stem + ".hpp", "the class", data::hash_text(data::xxh64(text))}};
    const auto note_numbers = [&](const char* ending) {
        const std::string path = (folder / (stem + ending)).string();
        const auto hash = data::hash_of_file(path, diag::Code::unwritable_output);
        files.push_back({stem + ending, "numbers of the class", hash ? *hash : "unreadable"});
    };
    if (!compiled.plan.stored.empty()) note_numbers(".targets.bin");
    if (request.check.retargetable) note_numbers(".params.bin");
    OutputFiles outputs(sink);
    const auto add = [&](const std::string& name, const std::string& what,
                         const std::string& content) {
        files.push_back({name, what, data::hash_text(data::xxh64(content))});
        return outputs.add((folder / name).string(), content);
    };
    const Executed executed = executed_of(certified, text);
    return add(stem + ".etl", "the spec", std::string(spec.text())) &&
           add("budget.txt", "`etlc --emit report`: state, code, work, horizon",
               emit::report(compiled.plan, options)) &&
           add("certificate.txt", "`etlc prove`",
               certified ? certified->text : "not proved: " + *why) &&
           (executed.annotated.empty() ||
            add("coverage.txt", "the class in the proof, by gcov", executed.annotated)) &&
           outputs.add((folder / "dossier.md").string(),
                       index_of(stem, head_of(text), executed.summary, files)) &&
           outputs.commit();
}

}  // namespace etlc::driver
