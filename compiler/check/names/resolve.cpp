// Looking up names and numbers, with what there is to say where they do not fit.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "check/context/context.hpp"
#include "check/numbers/decimal.hpp"

namespace etlc::check {

using diag::Code;

namespace {

/// What stands in the place of a name that other languages have: TRUE, infinity; Gp for G p. Empty:
/// nothing.
std::string meant_by(const Context& c, std::string_view name, const std::vector<NameKind>& kinds) {
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

const Reference* find(Context& c, const ast::Name& name, const std::vector<NameKind>& kinds,
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
            ? fmt::format("{} is beyond the largest float32, 3.40282347e+38", shown(number))
            : fmt::format(
                  "{} is not zero, but its nearest float32 is (the least above zero is 1.4e-45)",
                  shown(number)));
    return 1;
}

}  // namespace etlc::check
