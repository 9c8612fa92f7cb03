#include "parse/parse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "EtlLexer.h"
#include "parse/build.hpp"
#include "parse/foreign/foreign.hpp"
#include "parse/stream/tokens.hpp"
#include "parse/syntax_error.hpp"
#include "source/text.hpp"

namespace etlc::parse {

using diag::Code;
using diag::Diagnostic;

namespace {

/// Reads one file, one declaration at a time.
class Reader {
public:
    Reader(const source::File& file, diag::Sink& sink) : file_(file), sink_(sink), builder_(file) {}

    ast::Spec read() {
        if (!is_text()) return {};
        tokens_ = tokens_of(file_);
        for (const Slice& slice : slices_of(tokens_)) read(slice);
        report_errors();
        report_missing_spec();
        return std::move(spec_);
    }

private:
    bool is_text() {
        const std::string_view text = file_.text();
        if (text.size() > kMaxSpecBytes) {
            sink_
                .report({Code::spec_too_large,
                         fmt::format("the spec has {} bytes; etlc reads at most {}", text.size(),
                                     kMaxSpecBytes)})
                .note("target sets of that size belong in .npy files");
            return false;
        }
        const bool utf16 = text.substr(0, 2) == "\xFF\xFE" || text.substr(0, 2) == "\xFE\xFF";
        if (utf16) {
            sink_.report({Code::invalid_utf8, "this file is UTF-16; save it as UTF-8"});
            return false;
        }
        if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
            sink_.report(Code::unexpected_character, span_at(nul),
                         "a NUL byte; is this a text file?");
            return false;
        }
        if (const std::size_t invalid = source::first_invalid_utf8(text); invalid < text.size())
            sink_.report(Code::invalid_utf8, span_at(invalid),
                         fmt::format("the byte 0x{:02X} is not UTF-8; save the file as UTF-8",
                                     static_cast<unsigned char>(text[invalid])));
        return true;
    }

    static source::Span span_at(std::size_t offset) {
        return {static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(offset + 1)};
    }

    void read(Slice slice) {
        const Token& first = token(slice.begin);
        const bool is_spec = first.getType() == Grammar::SPEC;
        try {
            add(parsed(slice), span_of(first));
        } catch (SyntaxError& error) {
            errors_.push_back(std::move(error));
            add_unreadable(slice);
            spec_seen_ = spec_seen_ || is_spec;
        } catch (const Unexplained&) {
            add_unreadable(slice);
        }
    }

    /// Thrown for a declaration whose error has already been reported.
    struct Unexplained {};

    const Token& token(std::size_t i) const { return *tokens_[i]; }

    void refuse_mistakes(Slice slice) const {
        for (std::size_t i = slice.begin; i < slice.end; ++i) {
            // A string that is not UTF-8 has been reported for the whole file.
            if (token(i).getType() == Grammar::STRING) {
                const std::string_view content = file_.text(span_of(token(i)));
                if (source::first_invalid_utf8(content) < content.size()) throw Unexplained{};
            }
            if (!is_mistake(token(i))) continue;
            std::optional<Diagnostic> explained =
                explain_mistake(token(i), i > slice.begin ? &token(i - 1) : nullptr, file_);
            if (!explained) throw Unexplained{};
            throw SyntaxError{std::move(*explained)};
        }
    }

    void refuse_deep_nesting(Slice slice) const {
        const std::optional<std::size_t> at = too_deep_at(tokens_, slice);
        if (!at) return;
        Diagnostic error{
            Code::nesting_too_deep,
            fmt::format("brackets and operators are nested more than {} deep", kMaxNesting),
            span_of(token(*at))};
        error.note("name parts of the formula with 'let'");
        throw SyntaxError{std::move(error)};
    }

    /// Returns the name in `spec NAME;`, or a declaration.
    std::variant<ast::Name, ast::Declaration> parsed(Slice slice) const {
        refuse_mistakes(slice);
        refuse_deep_nesting(slice);
        SliceStream stream(tokens_, slice);
        Grammar parser(&stream);
        parser.removeErrorListeners();
        parser.setErrorHandler(std::make_shared<Strategy>(file_, tokens_, slice));
        return builder_.declaration(*parser.declaration());
    }

    void add(std::variant<ast::Name, ast::Declaration> read, source::Span first) {
        if (auto* const declaration = std::get_if<ast::Declaration>(&read)) {
            spec_.declarations.push_back(std::move(*declaration));
            return;
        }
        auto& name = std::get<ast::Name>(read);
        if (spec_seen_)
            sink_.report(Code::misplaced_spec, first, "a second 'spec'")
                .note(spec_.name.span, "the first is here");
        else if (!spec_.declarations.empty() || !errors_.empty())
            sink_.report(Code::misplaced_spec, first,
                         "'spec' must be the first declaration of the file");
        if (!spec_seen_) spec_.name = std::move(name);
        spec_seen_ = true;
    }

    /// Records the names that a broken declaration would have declared, as far as its first words
    /// tell.
    void add_unreadable(Slice slice) {
        const std::size_t last = slice.end;
        std::size_t at = slice.begin;
        const std::size_t kind = token(at).getType();
        if (kind == Grammar::SLIDING && at + 1 < last &&
            token(at + 1).getType() == Grammar::MONITOR)
            ++at;
        if (kind == Grammar::SPEC || kind == Grammar::TRUTH) return;
        if (kind == Grammar::RATE || kind == Grammar::PERIOD) {
            spec_.unreadable.push_back({"rate", span_of(token(at))});
            return;
        }
        for (++at; at < last && (is_name(token(at)) || is_reserved_word(token(at), file_));
             at += 2) {
            spec_.unreadable.push_back({text_of(token(at), file_), span_of(token(at))});
            if (at + 1 >= last || token(at + 1).getType() != Grammar::COMMA) break;
        }
    }

    /// A reserved word used as a name breaks every other declaration that uses it; this single
    /// cause is reported once.
    void report_errors() {
        std::vector<std::string> misused;
        for (const SyntaxError& error : errors_)
            if (error.diagnostic.code == Code::reserved_name) misused.push_back(error.found);
        const auto is_misused = [&misused](const std::string& word) {
            return std::find(misused.begin(), misused.end(), word) != misused.end();
        };
        for (SyntaxError& error : errors_) {
            const bool follows = error.diagnostic.code != Code::reserved_name &&
                                 (is_misused(error.found) || is_misused(error.previous));
            if (!follows && !is_missing_spec(error)) sink_.report(std::move(error.diagnostic));
        }
    }

    void report_missing_spec() {
        if (spec_seen_) return;
        const Token& first = token(0);
        const bool empty = first.getType() == Token::EOF;
        Diagnostic& missing = sink_.report(
            Code::misplaced_spec, span_of(first),
            empty ? "the file is empty"
                  : fmt::format("expected 'spec NAME;', found {}", quoted(first, file_)));
        if (diag::nearest_name(text_of(first, file_), {"spec"}))
            diag::did_you_mean(missing, "spec");
        missing.note("a file begins with 'spec NAME;', which names the generated code");
    }

    /// Whether the error is about a first statement that is no declaration in a file without `spec
    /// NAME;`. The missing spec is the real error.
    bool is_missing_spec(const SyntaxError& error) const {
        return !spec_seen_ && error.previous.empty() && !error.found.empty() &&
               error.diagnostic.span == span_of(token(0));
    }

    const source::File& file_;
    diag::Sink& sink_;
    Builder builder_;
    Tokens tokens_;
    ast::Spec spec_;
    std::vector<SyntaxError> errors_;
    bool spec_seen_ = false;
};

}  // namespace

ast::Spec parse(const source::File& file, diag::Sink& sink) {
    return Reader(file, sink).read();
}

// Measures how deep a declaration nests, in one pass: everything that the grammar reads by
// recursion counts.

using grammar::EtlLexer;

namespace {

/// Operators that are open between one pair of brackets.
struct Level {
    int base = 0;      ///< depth outside the bracket, plus one
    int arrows = 0;    ///< `->` in a row
    int untils = 0;    ///< U W R S in a row
    int prefixes = 0;  ///< ! X F G Y O H rise fall held in a row
    int signs = 0;     ///< `-` before an operand, in a row

    int depth() const { return base + arrows + untils + prefixes + signs; }
};

/// `rise`, `fall` and `held` are names elsewhere.
bool is_prefix_word(const Token& token, const Token& next) {
    if (token.getType() == EtlLexer::HELD) return next.getType() == EtlLexer::LBRACKET;
    const bool edge = token.getType() == EtlLexer::RISE || token.getType() == EtlLexer::FALL;
    return edge && begins_operand(next);
}

void operator_seen(Level& level, const Token& token, bool after_operand) {
    if (const auto kind = operator_kind(token.getType()); kind && !is_name(token)) {
        switch (ast::operator_of(*kind)->level) {
            case ast::kPrefix: ++level.prefixes; return;
            case ast::kBinary: level = {level.base, level.arrows, level.untils + 1}; return;
            case ast::kAnd:
            case ast::kOr: level = {level.base, level.arrows}; return;
            case ast::kImplies: level = {level.base, level.arrows + 1}; return;
            default: level = {level.base}; return;
        }
    }
    if (token.getType() == EtlLexer::MINUS && !after_operand)
        ++level.signs;
    else if (is(&token, {EtlLexer::MINUS, EtlLexer::PLUS, EtlLexer::TIMES, EtlLexer::DIVIDE,
                         EtlLexer::LESS_EQUAL, EtlLexer::LESS, EtlLexer::GREATER_EQUAL,
                         EtlLexer::GREATER, EtlLexer::EQUAL, EtlLexer::NOT_EQUAL}))
        level.signs = 0;
    else if (token.getType() == EtlLexer::COMMA)
        level = {level.base};
}

}  // namespace

std::optional<std::size_t> too_deep_at(const Tokens& tokens, Slice slice) {
    std::vector<Level> levels(1);
    bool after_operand = false;
    for (std::size_t i = slice.begin; i < slice.end; ++i) {
        const std::size_t type = tokens[i]->getType();
        if (type == EtlLexer::LPAREN || type == EtlLexer::LBRACKET) {
            levels.push_back({levels.back().depth() + 1});
        } else if (type == EtlLexer::RPAREN || type == EtlLexer::RBRACKET) {
            if (levels.size() > 1) levels.pop_back();
        } else if (i + 1 < slice.end && is_prefix_word(*tokens[i], *tokens[i + 1])) {
            ++levels.back().prefixes;
        } else {
            operator_seen(levels.back(), *tokens[i], after_operand);
        }
        if (levels.back().depth() > kMaxNesting) return i;
        after_operand = ends_operand(tokens[i].get());
    }
    return std::nullopt;
}

}  // namespace etlc::parse
