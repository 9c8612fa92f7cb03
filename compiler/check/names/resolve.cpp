// Looking up names and numbers, with what there is to say where they do not fit.
#include <fmt/format.h>

#include "check/context.hpp"
#include "check/numbers/decimal.hpp"

namespace etlc::check {

using diag::Code;

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
