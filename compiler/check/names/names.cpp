// Declares and resolves names, and checks whether they may be used.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "check/context/context.hpp"
#include "check/names/reserved.hpp"
#include "check/numbers/decimal.hpp"

namespace etlc::check {

namespace {

using diag::Code;

void suggest(Context& c, diag::Diagnostic& to, std::string suggestion, bool is_namespace) {
    while (!is_namespace && c.scope.find(suggestion) != nullptr) suggestion += "1";
    to.note(fmt::format("use another name, for example '{}'", suggestion)).meant = suggestion;
}

void check_spelling(Context& c, const ast::Name& name, std::string_view kind, bool is_namespace) {
    if (name.text.empty()) return;
    if (const auto why = why_forbidden(name.text, is_namespace)) {
        auto& error =
            c.report(Code::forbidden_name, name.span, fmt::format("'{}' {}", name.text, *why));
        return suggest(c, error, allowed_name(name.text, kind, is_namespace), is_namespace);
    }
    // Programs write these names; all others occur only in generated code.
    const bool is_written = kind == "spec" || kind == "input" || kind == "monitor";
    const auto header = macro_elsewhere(name.text);
    if (!header || !is_written) return;
    auto& warning =
        c.report(Code::macro_elsewhere, name.span,
                 fmt::format("'{}' is a macro of {}; programs that include it cannot use the name",
                             name.text, *header));
    suggest(c, warning, fmt::format("{}_{}", name.text, kind), is_namespace);
}

void declare(Context& c, NameKind kind, const ast::Name& name) {
    const Entity* first = c.scope.declare(kind, name);
    if (first == nullptr || name.text.empty()) return;
    c.report(Code::duplicate_name, name.span, fmt::format("'{}' is declared twice", name.text))
        .note(first->span, fmt::format("'{}' is declared here first", name.text));
}

void declare_all(Context& c) {
    for (const ast::Declaration& declaration : c.spec.declarations) {
        for_each_name(declaration,
                      [&](NameKind kind, const ast::Name& name) { declare(c, kind, name); });
    }
    for (const ast::Name& name : c.spec.unreadable)
        if (c.scope.find(name.text) == nullptr) c.scope.declare(NameKind::unreadable, name);
}

/// Returns the replacement for a name known from other languages (TRUE, infinity; G p for Gp), or
/// nothing.
std::string meant_by(const Context& c, std::string_view name,
                     std::initializer_list<NameKind> kinds) {
    std::string lower(name);
    for (char& letter : lower)
        letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
    const auto wanted = [&](NameKind kind) {
        return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
    };
    if (wanted(NameKind::constant) && (lower == "inf" || lower == "infinity" || lower == "oo"))
        return "inf";
    if (!wanted(NameKind::let)) return {};
    if (lower == "true" || lower == "false") return lower;
    std::string apart;
    for (std::size_t i = 0;
         i + 1 < name.size() && std::string_view("FGXYOH").find(name[i]) != name.npos;) {
        apart += fmt::format("{} ", name[i++]);
        if (c.scope.find(std::string(name.substr(i))) != nullptr)
            return apart + std::string(name.substr(i));
    }
    return {};
}

}  // namespace

void declare_names(Context& c) {
    declare_all(c);
    c.model.name = c.spec.name.text;
    check_spelling(c, c.spec.name, "spec", true);
    for (const NameKind kind :
         {NameKind::constant, NameKind::encoder, NameKind::input, NameKind::projection,
          NameKind::target, NameKind::predicate, NameKind::let, NameKind::monitor})
        for (const Entity& entity : c.scope.all(kind))
            if (!entity.duplicate) check_spelling(c, {entity.name, entity.span}, word(kind), false);
    if (c.scope.all(NameKind::monitor).empty() && !c.incomplete)
        c.report(Code::no_monitor, c.spec.name.span,
                 "the spec has no monitor, so there is nothing to compile")
            .note("add a line such as 'monitor m = G p;'");
}

const Reference* find(Context& c, const ast::Name& name, std::initializer_list<NameKind> kinds,
                      std::string_view wanted) {
    const Reference* found = c.scope.find(name.text);
    if (found != nullptr) {
        c.scope.entity(*found).used = true;
        return found;
    }
    if (name.text.empty() || !c.unknown_names.insert(name.text).second) return nullptr;
    auto& error = c.report(Code::unknown_name, name.span,
                           fmt::format("'{}' is not declared; expected {}", name.text, wanted));
    if (const std::string meant = meant_by(c, name.text, kinds); !meant.empty()) {
        diag::did_you_mean(error, meant);
        return nullptr;
    }
    const std::string near = c.scope.nearest(name.text, kinds);
    if (near.empty()) return nullptr;
    diag::did_you_mean(error, near, c.scope.entity(*c.scope.find(near)).span);
    return nullptr;
}

Index resolve(Context& c, const ast::Name& name, NameKind kind) {
    const Reference* found = find(c, name, {kind}, word_with_article(kind));
    if (found == nullptr || found->kind == NameKind::unreadable) return kNone;
    const Entity& entity = c.scope.entity(*found);
    if (found->kind == kind) return entity.broken ? kNone : found->index;
    c.report(Code::wrong_kind, name.span,
             fmt::format("'{}' is {}; expected {}", name.text, word_with_article(found->kind),
                         word_with_article(kind)))
        .note(entity.span, fmt::format("'{}' is declared here", name.text));
    return kNone;
}

void report_unknown_word(Context& c, Code code, const ast::Name& word, std::string_view why,
                         const std::vector<std::string>& words) {
    auto& error =
        c.report(code, word.span,
                 fmt::format("'{}' {}; expected {}", word.text, why, diag::alternatives(words)));
    if (const auto near = diag::nearest_name(word.text, words)) diag::did_you_mean(error, *near);
}

bool is_up_to_date(Context& c, Code code, Span span, std::string message,
                   const std::vector<std::string>& differences, std::string_view again) {
    if (differences.empty()) return true;
    auto& error = c.report(code, span, std::move(message));
    for (const std::string& difference : differences) error.note(difference);
    error.note(std::string(again));
    return false;
}

std::string shown(const ast::Number& number) {
    if (number.constant.empty()) return number.text;
    return fmt::format("{} = {}", number.constant, number.text);
}

float number32(Context& c, const ast::Number& number) {
    float value = 1;
    const Fit fit = to_float(number.text, value);
    if (fit == Fit::fits) return value;
    const bool overflow = fit == Fit::overflow;
    c.report(
        overflow ? Code::number_overflow : Code::number_underflow, number.span,
        overflow
            ? fmt::format("{} exceeds the largest float32, 3.40282347e+38", shown(number))
            : fmt::format(
                  "{} is not zero, but its nearest float32 is (the least above zero is 1.4e-45)",
                  shown(number)));
    return 1;
}

}  // namespace etlc::check
