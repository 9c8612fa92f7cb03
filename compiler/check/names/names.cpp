// Declares and resolves names, and checks whether they may be used.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "check/context/context.hpp"
#include "check/names/reserved.hpp"
#include "check/numbers/decimal.hpp"
#include "data/files/file.hpp"
#include "data/text/text.hpp"

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
    const bool is_written =
        kind == "spec" || kind == "input" || kind == "monitor" || kind == "drift";
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
          NameKind::target, NameKind::predicate, NameKind::let, NameKind::monitor, NameKind::drift})
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

// Replaces constants by their values, from the spec or from --set. A declaration with an unknown or
// unsuitable constant counts as unreadable, so that one error causes no others.

namespace {

std::string text_of(const ast::Constant& constant) {
    return with_unit(constant.value.text, constant.unit);
}

std::string_view kind_of(const ast::Constant& constant) {
    if (constant.unit.empty()) return "a number";
    return constant.unit == ast::kStepsUnit ? "a number of steps" : "a duration";
}

std::string text_of(const Setting& setting) {
    return fmt::format("--set {}={}{}", setting.name, setting.number, setting.unit);
}

/// Sets constants from --set.
void take_settings(Context& c, const std::vector<ast::Constant*>& constants) {
    for (const Setting& setting : c.options.settings) {
        const auto named = [&](const ast::Constant* k) { return k->name.text == setting.name; };
        const auto found = std::find_if(constants.begin(), constants.end(), named);
        if (found == constants.end()) {
            auto& error = c.sink.report(data::in_file(
                {Code::unknown_setting,
                 fmt::format("the spec has no constant {}", data::in_quotes(setting.name))},
                text_of(setting)));
            const std::string near = c.scope.nearest(setting.name, {NameKind::constant});
            if (!near.empty()) error.note(fmt::format("did you mean '{}'?", near));
            continue;
        }
        ast::Constant& constant = **found;
        if (constant.unit.empty() != setting.unit.empty()) {
            c.report(Code::constant_form, constant.span,
                     fmt::format("{}: '{}' is {}, {}; expected {}", text_of(setting), setting.name,
                                 kind_of(constant), text_of(constant),
                                 constant.unit.empty() ? "no unit" : "a unit after the number"));
            continue;
        }
        constant.value.text = setting.number;
        constant.unit = setting.unit;
        c.model.constants[static_cast<std::size_t>(found - constants.begin())].is_set = true;
    }
}

/// Replaces the constants in one declaration.
class Replacement {
public:
    Replacement(Context& context, const std::vector<ast::Constant*>& constants)
        : c_(context), constants_(constants) {}

    /// Returns false after an error.
    bool in(ast::Declaration& declaration) {
        good_ = true;
        std::visit([this](auto& d) { this->replace(d); }, declaration);
        return good_;
    }

private:
    const ast::Constant* value_of(const ast::Name& name) {
        const Index index = resolve(c_, name, NameKind::constant);
        if (index == kNone) {
            good_ = false;
            return nullptr;
        }
        c_.used_constants.insert(name.text);
        return constants_[index];
    }

    const ast::Constant* value_of(const ast::Number& number) {
        return number.constant.empty() ? nullptr
                                       : value_of(ast::Name{number.constant, number.span});
    }

    bool has_no_unit(const ast::Constant& constant, Span use) {
        if (constant.unit.empty()) return true;
        good_ = false;
        c_.report(Code::constant_form, use,
                  fmt::format("'{}' is {}, {}; expected a number", constant.name.text,
                              kind_of(constant), text_of(constant)))
            .note(constant.span, fmt::format("'{}' is declared here", constant.name.text));
        return false;
    }

    static void set(ast::Number& number, const ast::Constant& constant) {
        std::string text = constant.value.text;
        if (number.text.starts_with('-')) {
            text = text.starts_with('-') ? text.substr(1) : '-' + text;
            number.constant.insert(0, "-");
        }
        number.text = std::move(text);
    }

    void replace(ast::Number& number) {
        const ast::Constant* constant = value_of(number);
        if (constant != nullptr && has_no_unit(*constant, number.span)) set(number, *constant);
    }

    /// Replaces a time; the constant has a unit, or one follows it.
    void replace(ast::Number& number, std::string& unit) {
        const ast::Constant* constant = value_of(number);
        if (constant == nullptr) return;
        if (!unit.empty() && !has_no_unit(*constant, number.span)) return;
        set(number, *constant);
        if (unit.empty()) unit = constant->unit;
    }

    template <class T>
    void replace(std::optional<T>& optional) {
        if (optional) replace(*optional);
    }
    template <class T>
    void replace(std::vector<T>& all) {
        for (T& one : all) replace(one);
    }
    template <class T>
    void replace(std::unique_ptr<T>& pointer) {
        if (pointer) replace(*pointer);
    }
    template <class... Alternatives>
    void replace(std::variant<Alternatives...>& value) {
        std::visit([this](auto& v) { this->replace(v); }, value);
    }

    template <class... Parts>
    void each(Parts&... parts) {
        (replace(parts), ...);
    }

    void replace(ast::Name& /*name*/) {}
    void replace(ast::Load& /*load*/) {}
    void replace(ast::Constant& /*constant*/) {}
    void replace(ast::Images& /*images*/) {}
    void replace(ast::Point& point) { each(point.parts, point.factors, point.delays); }
    void replace(ast::Past& past) { each(past.formula, past.time); }
    void replace(ast::MatrixLiteral& matrix) { replace(matrix.rows); }
    void replace(ast::VectorLiteral& vector) { replace(vector.values); }
    void replace(ast::Frames& frames) { each(frames.frames, frames.stride); }
    void replace(ast::Fitted& fitted) { replace(fitted.arguments); }
    void replace(ast::Fitted::Argument& argument) { replace(argument.value); }
    void replace(ast::Aggregation& aggregation) { replace(aggregation.n); }
    void replace(ast::Distance& distance) {
        each(distance.aggregation, distance.weights, distance.point, distance.other);
    }
    void replace(ast::Bound& bound) {
        if (bound.calibrated) return replace(*bound.calibrated);
        replace(bound.number, bound.unit);
    }
    void replace(ast::Interval& interval) { each(interval.low, interval.high); }
    void replace(ast::Formula& f) { each(f.operands, f.interval, f.left, f.right); }
    void replace(ast::Encoder::Setting& setting) { replace(setting.values); }
    void replace(ast::Encoder& encoder) { replace(encoder.settings); }
    void replace(ast::Type& type) { each(type.dimension, type.scale); }
    void replace(ast::Range& range) { each(range.low, range.high); }
    void replace(ast::Input& input) { each(input.type, input.range, input.hold, input.stale); }
    void replace(ast::Projection& projection) { each(projection.matrix, projection.offset); }
    void replace(ast::Target& target) { replace(target.sources); }
    void replace(ast::Predicate& p) { each(p.expression, p.threshold); }
    void replace(ast::Truth& truth) { replace(truth.formula); }
    void replace(ast::Let& let) { replace(let.formula); }
    void replace(ast::Monitor& monitor) { each(monitor.formula, monitor.calibrated); }

    void replace(ast::Expr& expression) {
        take_window(expression);
        each(expression.distance, expression.past, expression.arguments);
        const Reference* meant =
            expression.kind == ast::Expr::Kind::name ? c_.scope.find(expression.text) : nullptr;
        if (meant == nullptr || meant->kind != NameKind::constant) return;
        ast::Number number{expression.text, expression.span, expression.text};
        replace(number);
        expression.kind = ast::Expr::Kind::number;
        expression.text = number.text;
        expression.constant = number.constant;
    }

    /// min(x, k) is a window if k is the name of a time.
    void take_window(ast::Expr& e) {
        const bool is_call = e.kind == ast::ExprKind::min || e.kind == ast::ExprKind::max;
        if (!is_call || e.arguments.size() != 2) return;
        const ast::Expr& last = *e.arguments.back();
        const Reference* const meant =
            last.kind == ast::ExprKind::name ? c_.scope.find(last.text) : nullptr;
        if (meant == nullptr || meant->kind != NameKind::constant ||
            constants_[meant->index]->unit.empty())
            return;
        const auto kind = e.kind == ast::ExprKind::min ? ast::PastKind::min : ast::PastKind::max;
        const ast::Number number{last.text, last.span, last.text};
        e.past = std::make_unique<ast::Past>(
            ast::Past{kind, nullptr, ast::Bound{number, "", last.span}});
        e.kind = ast::ExprKind::past;
        e.arguments.pop_back();
    }

    void replace(ast::Calibrated& calibrated) { replace(calibrated.arguments); }
    void replace(ast::Drift& drift) { replace(drift.arguments); }
    void replace(ast::Calibrated::Argument& argument) {
        auto* const name = std::get_if<ast::Name>(&argument.value);
        if (name != nullptr && argument.key.text != "against" &&
            c_.scope.find(name->text) != nullptr)
            argument.value = ast::Bound{{name->text, name->span, name->text}, "", name->span};
        auto* const bound = std::get_if<ast::Bound>(&argument.value);
        if (bound != nullptr)
            argument.key.text == "within" ? replace(*bound) : replace(bound->number);
    }

    void replace(ast::Rate& rate) {
        if (!rate.is_period) return replace(rate.number);
        replace(rate.number, rate.unit);
        const bool in_steps = rate.unit == ast::kStepsUnit;
        if ((!rate.unit.empty() && !in_steps) || !good_) return;
        good_ = false;
        c_.report(Code::constant_form, rate.number.span,
                  fmt::format("'{0}' is a number{2}, {1}, and a period has a unit of time; "
                              "expected one, as in 'period {0} ms'",
                              rate.number.constant, rate.number.text, in_steps ? " of steps" : ""));
    }

    Context& c_;
    const std::vector<ast::Constant*>& constants_;
    bool good_ = true;
};

}  // namespace

void set_constants(Context& c, ast::Spec& spec) {
    std::vector<ast::Constant*> constants;
    for (ast::Declaration& declaration : spec.declarations) {
        for_each_name(declaration,
                      [&](NameKind kind, const ast::Name& name) { c.scope.declare(kind, name); });
        if (auto* const constant = std::get_if<ast::Constant>(&declaration))
            constants.push_back(constant);
    }
    for (const ast::Name& name : spec.unreadable) c.scope.declare(NameKind::unreadable, name);
    c.model.constants.resize(constants.size());
    take_settings(c, constants);
    for (std::size_t i = 0; i < constants.size(); ++i) {
        c.model.constants[i].name = constants[i]->name.text;
        c.model.constants[i].text = text_of(*constants[i]);
    }

    Replacement replacement(c, constants);
    std::vector<ast::Declaration> sound;
    std::vector<bool> is_sound;  // `constants` points to the declarations, which stay until the end
    for (ast::Declaration& declaration : spec.declarations) {
        is_sound.push_back(replacement.in(declaration));
        if (is_sound.back()) continue;
        for_each_name(declaration, [&](NameKind /*kind*/, const ast::Name& name) {
            spec.unreadable.push_back(name);
        });
        c.incomplete = true;
    }
    for (std::size_t i = 0; i < is_sound.size(); ++i)
        if (is_sound[i]) sound.push_back(std::move(spec.declarations[i]));
    spec.declarations = std::move(sound);
    c.scope = {};  // declare_names builds it from the remaining declarations
}

}  // namespace etlc::check
