// Declarations of encoders.
#include <fmt/format.h>

#include <set>

#include "check/context/steps.hpp"
#include "check/encoders/settings.hpp"

namespace etlc::check {

namespace {

using diag::Code;

bool set_settings(Context& c, const ast::Encoder& declaration, Encoder& encoder) {
    std::set<std::string> given;
    for (const ast::Encoder::Setting& setting : declaration.settings) {
        std::vector<std::string> numbers;
        for (const ast::Number& number : setting.values) numbers.push_back(number.text);
        const auto mistake =
            given.insert(setting.key.text).second
                ? set_setting(encoder, setting.key.text, numbers)
                : std::optional(fmt::format("{} is given twice", setting.key.text));
        if (!mistake) continue;
        c.report(Code::encoder_form, setting.span, *mistake);
        return false;
    }
    return true;
}

}  // namespace

void check_encoders(Context& c) {
    for_each_declaration<ast::Encoder>(c.spec, [&](const ast::Encoder& declaration, Index index) {
        Encoder encoder;
        encoder.name = declaration.name.text;
        encoder.model = declaration.model.path;
        encoder.span = declaration.name.span;
        bool good = set_settings(c, declaration, encoder);
        if (!declaration.model.key.empty()) {
            c.report(Code::encoder_form, declaration.model.key_span,
                     "a model is a file of its own; expected load(\"FILE\") without a key");
            good = false;
        }
        if (!good) c.scope.entity(NameKind::encoder, index).broken = true;
        encoder.declaration =
            fmt::format("load(\"{}\"), {}", encoder.model, settings_text(encoder));
        c.model.encoders.push_back(std::move(encoder));
    });
}

}  // namespace etlc::check
