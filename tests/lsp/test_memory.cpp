// Edits texts at random, and compares what is read of each state, and what the server answers about
// it, with the same without a memory of earlier states.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "good_specs.hpp"
#include "lsp/answers/answers.hpp"
#include "lsp/spec/analysis.hpp"
#include "parse/parse.hpp"

namespace etlc::lsp {
namespace {

std::string shown(source::Span span) {
    return fmt::format("{}-{} ", span.begin, span.end);
}

/// Returns everything that an analysis finds, with its places.
std::string findings(const std::string& text, parse::Memory& memory) {
    check::KnownMatrices known;
    Analysis all("", text, Encoding::utf8, memory, known);
    std::string result;
    for (const diag::Diagnostic& one : all.sink.sorted()) {
        result += diag::info(one.code).code;
        result += one.span ? shown(*one.span) : "";
        result += one.message + "\n";
        for (const diag::Note& note : one.notes)
            result += "  " + (note.span ? shown(*note.span) : "") + note.text + "\n";
    }
    for (const Declared& one : all.names().declared)
        result += one.name + " " + shown(one.name_span) + shown(one.span) + "\n";
    for (const Occurrence& one : all.names().occurrences)
        result += one.name + " " + shown(one.span) + (one.uncertain ? "?\n" : "\n");
    for (const NamedFile& one : all.names().files)
        result += one.path + " " + shown(one.span) + "\n";
    for (const parse::Word& word : memory.words_of(all.file))
        result += fmt::format("{} {}", static_cast<int>(word.kind), shown(word.span));
    diag::Sink sink;
    return result + "\n" + ast::print(memory.parse(all.file, sink));
}

/// Returns the diagnostics, the outline, and hovers and completions at places all over the text.
std::string answers(Document& document) {
    const Client client{true, true, true};
    const Json nothing;
    const Analysis& analysis = document.analysis();
    Json all{diagnostics_of(analysis, nullptr, document.uri(), client),
             symbols({document, nothing, client})};
    const auto ask = [&](std::uint32_t offset) {
        const Json params{{"position", analysis.lines.position(offset)}};
        for (const auto answer : {hover, definition, references, completion})
            all.push_back(answer({document, params, client}));
    };
    for (std::size_t i = 0; i < analysis.names().declared.size(); i += 3)
        ask(analysis.names().declared[i].name_span.begin);
    for (std::uint32_t at = 0; at < document.text().size(); at += 97) ask(at);
    return all.dump(1, ' ', false, Json::error_handler_t::replace);
}

/// Replaces some bytes, or most often inserts some, as one who types does.
void edit(std::string& text, const std::string& other, std::mt19937& random) {
    static const std::vector<std::string> kTyped{
        " ",  "\n", ";",  "/*",   "*/", "//", "\"", "(",        ")",     "1",     ".",
        "e5", "x",  "<-", "<-->", "!=", "=",  "@",  "\xC3\xA9", "spec ", "let a", "monitor m = "};
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    const std::size_t at = below(text.size() + 1);
    std::string typed = kTyped[below(kTyped.size())];
    if (random() % 4 == 0 && !other.empty())
        typed = other.substr(below(other.size()), 1 + below(80));
    text.replace(at, random() % 3 == 0 ? below(30) : 0, typed);
}

TEST(Memory, FindsWhatAFreshReaderFinds) {
    std::mt19937 random(11);
    const std::vector<std::string> specs = good_specs();
    for (std::size_t s = 0; s < specs.size(); s += 3) {
        std::string text = specs[s];
        const std::string saved = text;
        parse::Memory memory;
        for (int step = 0; step < 20; ++step) {
            if (step % 8 == 7) text = saved;  // most of it is sound again
            edit(text, specs[random() % specs.size()], random);
            parse::Memory fresh;
            ASSERT_EQ(findings(text, memory), findings(text, fresh)) << text;
        }
    }
}

TEST(Memory, AnswersWhatAFreshServerAnswers) {
    std::mt19937 random(12);
    const std::vector<std::string> specs = good_specs();
    for (std::size_t s = 0; s < specs.size(); s += 5) {
        std::string text = specs[s];
        Document edited("file:///nowhere/a.etl", text, 1, Encoding::utf16);
        for (int step = 0; step < 16; ++step) {
            if (step % 4 == 3) text = specs[s];
            edit(text, specs[random() % specs.size()], random);
            edited.replace(text);
            Document fresh("file:///nowhere/a.etl", text, 1, Encoding::utf16);
            ASSERT_EQ(answers(edited), answers(fresh)) << text;
        }
    }
}

TEST(Memory, MovesDeclarationsWithAllTheirPlaces) {
    for (const std::string& text : good_specs()) {
        parse::Memory memory;
        for (const std::string before : {"", "/* moved */\n", " "}) {
            parse::Memory fresh;
            ASSERT_EQ(findings(before + text, memory), findings(before + text, fresh)) << text;
        }
    }
}

TEST(Memory, ReadsTextsThatHaveNothingInCommon) {
    parse::Memory memory;
    for (const char* text :
         {"", "spec a;", "\xEF\xBB\xBFspec a;", "", "/* open", "/* open */ spec a;", "\"", "x"}) {
        parse::Memory fresh;
        EXPECT_EQ(findings(text, memory), findings(text, fresh)) << text;
    }
}

}  // namespace
}  // namespace etlc::lsp
