#include <fmt/format.h>

#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "ast/ast.hpp"

namespace etlc::ast {

namespace {

template <class Items, class Print>
std::string joined(const Items& items, std::string_view separator, Print print) {
    std::string result;
    for (const auto& item : items) {
        if (&item != &*std::begin(items)) result += separator;
        result += print(item);
    }
    return result;
}

std::string text_of(const Name& name) {
    return name.text;
}

std::string text_of(const Number& number) {
    return number.text;
}

std::string text_of(const VectorLiteral& vector) {
    return fmt::format("[{}]", joined(vector.values, ", ", [](const Number& n) { return n.text; }));
}

std::string text_of(const MatrixLiteral& matrix) {
    const auto row = [](const std::vector<Number>& values) {
        return text_of(VectorLiteral{values, {}});
    };
    return fmt::format("[{}]", joined(matrix.rows, ", ", row));
}

std::string text_of(const Load& load) {
    if (load.key.empty()) return fmt::format("load(\"{}\")", load.path);
    return fmt::format("load(\"{}\", \"{}\")", load.path, load.key);
}

std::string text_of(const Frames& frames) {
    const std::string key = frames.key.empty() ? "" : fmt::format("\"{}\", ", frames.key);
    const std::string stride = frames.stride ? ", stride = " + frames.stride->text : "";
    return fmt::format("frames(\"{}\", {}{}{})", frames.path, key,
                       text_of(VectorLiteral{frames.frames, {}}), stride);
}

std::string text_of(const Images& images) {
    return fmt::format("images(\"{}\")", images.path);
}

std::string text_of(const Calibrated& calibrated);
std::string text_of(const Fitted& fitted);

template <class Node>
std::string text_of(const std::unique_ptr<Node>& node) {
    return print(*node);
}

/// "1 step", "n steps".
std::string unit_word(const Number& number, const std::string& unit) {
    return unit == kStepsUnit && number.text == "1" ? "step" : unit;
}

std::string text_of(const Bound& bound) {
    if (bound.calibrated) return text_of(*bound.calibrated);
    const bool apart =
        !bound.unit.empty() && (!bound.number.constant.empty() || bound.unit == kStepsUnit);
    return fmt::format("{}{}{}", bound.number.text, apart ? " " : "",
                       unit_word(bound.number, bound.unit));
}

std::string text_of(const Point& point);

/// "z - 2 * (v + w)"
std::string text_of_sum(const Point& sum) {
    std::string text;
    for (std::size_t i = 0; i < sum.parts.size(); ++i) {
        std::string_view factor = sum.factors[i].text;
        const bool negative = factor.starts_with('-');
        if (negative) factor.remove_prefix(1);
        text += i == 0 ? (negative ? "-" : "") : (negative ? " - " : " + ");
        if (factor != "1") text += fmt::format("{} * ", factor);
        const Point& part = sum.parts[i];
        const bool nested = !part.factors.empty() && part.delays.empty();
        text += nested ? fmt::format("({})", text_of(part)) : text_of(part);
    }
    return sum.delays.empty() ? text : fmt::format("({})", text);
}

std::string text_of(const Point& point) {
    std::string text = joined(point.parts, ", ", [](const Point& part) { return text_of(part); });
    if (point.is_vector)
        text = fmt::format("[{}]", text);
    else if (!point.factors.empty())
        text = text_of_sum(point);
    else
        text = point.parts.empty() ? point.name.text : fmt::format("{}({})", point.name.text, text);
    for (const Bound& delay : point.delays) text += '@' + text_of(delay);
    return text;
}

template <class... Alternatives>
std::string text_of(const std::variant<Alternatives...>& value) {
    return std::visit([](const auto& v) { return text_of(v); }, value);
}

std::string text_of(const Aggregation& aggregation) {
    if (aggregation.kind != Aggregation::Kind::kth)
        return fmt::format("{} ", word(aggregation.kind));
    return fmt::format("kth({}) ", aggregation.n ? aggregation.n->text : "1");
}

std::string text_of(const Distance& distance) {
    const std::string aggregation = distance.aggregation ? text_of(*distance.aggregation) : "";
    const std::string weights =
        distance.weights ? fmt::format("({})", text_of(*distance.weights)) : "";
    return fmt::format("{}{}{}({}, {})", aggregation, distance.metric.text, weights,
                       text_of(distance.point), text_of(distance.other));
}

/// ", k = 8, of = z".
template <class Argument>
std::string text_of_all(const std::vector<Argument>& arguments) {
    std::string text;
    for (const Argument& a : arguments)
        text += fmt::format(", {} = {}", a.key.text, text_of(a.value));
    return text;
}

/// "calibrated(f1)", "fitted(kmeans, k = 8, ...)".
template <class Call>
std::string call_text(std::string_view word, const Call& call) {
    return fmt::format("{}({}{})", word, call.method.text, text_of_all(call.arguments));
}

std::string text_of(const Fitted& fitted) {
    return call_text("fitted", fitted);
}

std::string text_of(const Calibrated& calibrated) {
    return call_text("calibrated", calibrated);
}

// ---- formulas -----------------------------------------------------------------------------------

std::string text_of(const Interval& interval) {
    return fmt::format("[{}, {}]", text_of(interval.low), text_of(interval.high));
}

FormulaLevel level_of(const Formula& f) {
    if (const Operator* const op = operator_of(f.kind)) return op->level;
    return f.kind == Formula::Kind::comparison ? kComparison : kAtom;
}

/// Returns the level that an operand needs to stand without brackets.
FormulaLevel needed_by(const Formula& f, bool is_first) {
    switch (level_of(f)) {
        case kIff: return is_first ? kIff : kImplies;
        case kImplies: return is_first ? kOr : kImplies;
        case kOr: return kAnd;
        case kAnd: return kBinary;
        case kBinary: return is_first ? kPrefix : kBinary;
        // `!x > 0` means !(x > 0); the brackets help readers who know another language.
        default: return f.operands[0]->kind == Formula::Kind::comparison ? kAtom : kPrefix;
    }
}

std::string operator_text(const Formula& f) {
    std::string text(operator_of(f.kind)->symbol);
    if (f.kind == Formula::Kind::held) return text + fmt::format("[{}]", text_of(f.interval->high));
    return f.interval ? text + text_of(*f.interval) : text;
}

/// Appends, so that a long chain takes linear time.
void append(std::string& text, const Formula& f, FormulaLevel needed) {
    const FormulaLevel level = level_of(f);
    if (level < needed) text += '(';
    if (f.kind == Formula::Kind::name) {
        text += f.name;
    } else if (level == kAtom) {
        text += f.kind == Formula::Kind::constant_true ? "true" : "false";
    } else if (level == kComparison) {
        text += fmt::format("{} {} {}", print(*f.left), symbol(f.comparison), print(*f.right));
    } else {
        if (level == kPrefix) text += operator_text(f);
        if (level == kPrefix && f.kind != Formula::Kind::negation) text += ' ';
        for (const FormulaPtr& operand : f.operands) {
            const bool is_first = &operand == &f.operands.front();
            if (!is_first) text += fmt::format(" {} ", operator_text(f));
            append(text, *operand, needed_by(f, is_first));
        }
    }
    if (level < needed) text += ')';
}

/// "x@3s", "(x + y)@10", "mean(x, 2s)", "count(f, 60s)"
std::string text_of_past(const Expr& e) {
    const std::string time = text_of(e.past->time);
    if (e.past->formula != nullptr)
        return fmt::format("{}({}, {})", word(e.past->kind), print(*e.past->formula), time);
    const std::string of = print(*e.arguments[0]);
    if (e.past->kind != PastKind::ago)
        return fmt::format("{}({}, {})", word(e.past->kind), of, time);
    const bool whole = operator_of(e.arguments[0]->kind).level == kPrimary;
    return whole ? fmt::format("{}@{}", of, time) : fmt::format("({})@{}", of, time);
}

// ---- declarations -------------------------------------------------------------------------------

std::string text_of(const Type& type) {
    constexpr std::array<std::string_view, 4> kWords{"f32", "f16", "i8", "bool"};
    std::string result(kWords[static_cast<std::size_t>(type.kind)]);
    if (type.dimension) result += fmt::format("[{}]", type.dimension->text);
    if (type.scale) result += fmt::format(" scale {}", type.scale->text);
    return result;
}

std::string text_of(const Rate& rate) {
    const std::string rounding = rate.durations == Rounding::exact
                                     ? ""
                                     : fmt::format(", durations {}", word(rate.durations));
    return fmt::format("{} {}{}{}{}", rate.is_period ? "period" : "rate", rate.number.text,
                       rate.unit.empty() ? "" : " ", rate.unit, rounding);
}

std::string text_of(const Constant& constant) {
    return fmt::format("const {} = {}{}{}", constant.name.text, constant.value.text,
                       constant.unit.empty() ? "" : " ", unit_word(constant.value, constant.unit));
}

std::string text_of_missing(std::optional<bool> missing) {
    return missing ? fmt::format(" missing {}", *missing) : "";
}

std::string text_of_encoder(const std::optional<Name>& encoder) {
    return encoder ? " by " + encoder->text : "";
}

std::string text_of(const Encoder& encoder) {
    std::string result = fmt::format("encoder {} = {}", encoder.name.text, text_of(encoder.model));
    for (const Encoder::Setting& setting : encoder.settings) {
        result += ", " + setting.key.text;
        if (setting.word)
            result += setting.is_quoted ? fmt::format(" \"{}\"", setting.word->text)
                                        : " " + setting.word->text;
        if (setting.file) result += " " + text_of(*setting.file);
        if (!setting.values.empty()) result += " " + text_of(VectorLiteral{setting.values, {}});
    }
    return result;
}

std::string text_of(const Input& input) {
    std::string result = fmt::format(
        "input {} : {}{}", joined(input.names, ", ", [](const Name& n) { return n.text; }),
        text_of(input.type), text_of_encoder(input.encoder));
    if (input.range)
        result += fmt::format(" in [{}, {}]", input.range->low.text, input.range->high.text);
    if (input.hold) result += fmt::format(" hold {}", text_of(*input.hold));
    result += text_of_missing(input.missing);
    if (input.stale) result += fmt::format(", stale after {}", text_of(*input.stale));
    return result;
}

std::string text_of(const Projection& projection) {
    const std::string offset =
        projection.offset ? fmt::format(" offset {}", text_of(*projection.offset)) : "";
    const std::string space = projection.space ? " in " + projection.space->text : "";
    return fmt::format("projection {} = {}{}{}", projection.name.text, text_of(projection.matrix),
                       offset, space);
}

std::string text_of(const Target& target) {
    const auto source = [](const Target::Source& one) { return text_of(one); };
    const std::string space = target.space ? fmt::format(" of {}", text_of(*target.space)) : "";
    return fmt::format("target {} = {}{}{}", target.name.text, joined(target.sources, ", ", source),
                       text_of_encoder(target.encoder), space);
}

std::string text_of(const Predicate& predicate) {
    return fmt::format("predicate {} = {} {} {}{}", predicate.name.text,
                       print(*predicate.expression), symbol(predicate.comparison),
                       text_of(predicate.threshold), text_of_missing(predicate.missing));
}

std::string text_of(const Truth& truth) {
    return fmt::format("truth {} = {}", truth.subject.text, print(*truth.formula));
}

std::string text_of(const Let& let) {
    return fmt::format("let {} = {}", let.name.text, print(*let.formula));
}

std::string text_of(const Monitor& monitor) {
    const std::string calibrated =
        monitor.calibrated ? fmt::format(" {}", text_of(*monitor.calibrated)) : "";
    constexpr std::array<std::string_view, 4> kWords{"", "sliding ", "restartable ", "repeating "};
    return fmt::format("{}monitor {} = {}{}", kWords[static_cast<std::size_t>(monitor.kind)],
                       monitor.name.text, print(*monitor.formula), calibrated);
}

std::string text_of(const Drift& drift) {
    return fmt::format("drift {} = of {}{}", drift.name.text, drift.of.text,
                       text_of_all(drift.arguments));
}

}  // namespace

std::string_view word(Rounding rounding) {
    constexpr std::array<std::string_view, 4> kWords{"exact", "up", "down", "nearest"};
    return kWords[static_cast<std::size_t>(rounding)];
}

std::string print(const Spec& spec) {
    std::string text;
    if (!spec.name.text.empty()) text += fmt::format("spec {};\n", spec.name.text);
    for (const Declaration& declaration : spec.declarations)
        text += std::visit([](const auto& d) { return text_of(d); }, declaration) + ";\n";
    return text;
}

std::string print(const Formula& formula) {
    std::string text;
    append(text, formula, kIff);
    return text;
}

std::string print(const Expr& expression) {
    std::string text;
    const auto leaf = [](const Expr& e) {
        if (e.kind == Expr::Kind::past) return text_of_past(e);
        return e.kind == Expr::Kind::distance ? text_of(*e.distance) : e.text;
    };
    const auto argument = [](const ExprPtr& e) -> const Expr& { return *e; };
    append(text, expression, leaf, argument);
    return text;
}

std::string print(const Frames& frames) {
    return text_of(frames);
}

std::string print(const Images& images) {
    return text_of(images);
}

}  // namespace etlc::ast
