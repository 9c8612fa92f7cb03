// Parses specs: any bytes give a tree or an error with a place, and the printed tree parses to the
// same tree.
#include <nlohmann/json.hpp>

#include "../unit/tree_text.hpp"
#include "diag/diag.hpp"
#include "fuzz_target.hpp"
#include "parse/parse.hpp"

namespace {

using namespace etlc;

void require_sound(const source::File& file, const diag::Sink& sink) {
    for (const diag::Diagnostic& d : sink.sorted()) {
        fuzz::require(!d.message.empty(), "a diagnostic says something");
        fuzz::require(
            !d.span || (d.span->begin <= d.span->end && d.span->end <= file.text().size()),
            "a span lies in the file");
    }
    const std::string text = diag::render_text(file, sink);
    fuzz::require(text.empty() != sink.has_errors(), "errors are shown");
    for (const char c : text)
        fuzz::require(static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t',
                      "messages are printable");
    const auto json = nlohmann::json::parse(diag::render_json(file, sink), nullptr, false);
    fuzz::require(!json.is_discarded(), "JSON is JSON");
    fuzz::require(json["diagnostics"].size() == sink.errors(), "JSON holds every error");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    const source::File file("a.etl", std::string(fuzz::text(bytes, size)));
    diag::Sink sink;
    ast::Spec spec = parse::parse(file, sink);
    require_sound(file, sink);
    fuzz::require(sink.has_errors() || !spec.name.text.empty(), "a spec has a name");

    if (spec.name.text.empty())
        spec.name.text = "a";  // the readable part of a broken file is still a spec
    const std::string printed = ast::print(spec);
    const source::File again("b.etl", printed);
    diag::Sink nothing;
    const ast::Spec copy = parse::parse(again, nothing);
    // Blanks that were omitted may make a text too large.
    const bool too_large = printed.size() > parse::kMaxSpecBytes;
    fuzz::require(too_large || !nothing.has_errors(), "what is printed can be read");
    fuzz::require(too_large || tree_text::of(copy) == tree_text::of(spec),
                  "what is printed is the same spec");
    fuzz::require(too_large || ast::print(copy) == printed, "printing is canonical");
    return 0;
}
