#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

#include "ast/ast.hpp"
#include "ast/operators.hpp"

namespace etlc::ast {

namespace {

std::string_view symbol(Comparison comparison) {
    constexpr std::array<std::string_view, 6> kSymbols{"<=", "<", ">=", ">", "==", "!="};
    return kSymbols[static_cast<std::size_t>(comparison)];
}

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

std::string text_of(const FormulaPtr& formula) {
    return print(*formula);
}

std::string text_of(const Point& point) {
    std::string text = joined(point.inputs, ", ", [](const Name& n) { return n.text; });
    if (point.is_vector) text = fmt::format("[{}]", text);
    for (auto map = point.projections.rbegin(); map != point.projections.rend(); ++map)
        text = fmt::format("{}({})", map->text, text);
    return text;
}

std::string text_of(const ExprPtr& expression) {
    return print(*expression);
}

template <class... Alternatives>
std::string text_of(const std::variant<Alternatives...>& value) {
    return std::visit([](const auto& v) { return text_of(v); }, value);
}

std::string text_of(const Aggregation& aggregation) {
    switch (aggregation.kind) {
        case Aggregation::Kind::min: return "min ";
        case Aggregation::Kind::max: return "max ";
        case Aggregation::Kind::mean: return "mean ";
        case Aggregation::Kind::kth: break;
    }
    return fmt::format("kth({}) ", aggregation.n ? aggregation.n->text : "1");
}

std::string text_of(const Distance& distance) {
    const std::string aggregation = distance.aggregation ? text_of(*distance.aggregation) : "";
    const std::string weights =
        distance.weights ? fmt::format("({})", text_of(*distance.weights)) : "";
    return fmt::format("{}{}{}({}, {})", aggregation, distance.metric.text, weights,
                       text_of(distance.point), distance.target.text);
}

std::string text_of(const Fitted& fitted) {
    std::string arguments;
    for (const Fitted::Argument& a : fitted.arguments)
        arguments += fmt::format(", {} = {}", a.key.text, text_of(a.value));
    return fmt::format("fitted({}{})", fitted.method.text, arguments);
}

// ---- expressions --------------------------------------------------------------------------------

/// How tight an expression binds, from the loosest.
enum ExprLevel : std::uint8_t { kSum, kProduct, kSign, kPrimary };

ExprLevel level_of(const Expr& expression) {
    switch (expression.kind) {
        case Expr::Kind::add:
        case Expr::Kind::subtract: return kSum;
        case Expr::Kind::multiply:
        case Expr::Kind::divide: return kProduct;
        case Expr::Kind::negate: return kSign;
        default: return kPrimary;
    }
}

/// Appends, so that a long chain takes linear time.
class ExprPrinter {
public:
    explicit ExprPrinter(std::string& text) : text_(text) {}

    void print(const Expr& e, ExprLevel needed) {
        const bool brackets = level_of(e) < needed;
        if (brackets) text_ += '(';
        print(e);
        if (brackets) text_ += ')';
    }

private:
    void print(const Expr& e) {
        switch (e.kind) {
            case Expr::Kind::number:
            case Expr::Kind::name: text_ += e.text; break;
            case Expr::Kind::distance: text_ += text_of(*e.distance); break;
            case Expr::Kind::negate:
                text_ += '-';
                print(*e.arguments[0], kSign);
                break;
            case Expr::Kind::add: binary(e, " + "); break;
            case Expr::Kind::subtract: binary(e, " - "); break;
            case Expr::Kind::multiply: binary(e, " * "); break;
            case Expr::Kind::divide: binary(e, " / "); break;
            case Expr::Kind::abs: call(e, "abs"); break;
            case Expr::Kind::sqrt: call(e, "sqrt"); break;
            case Expr::Kind::min: call(e, "min"); break;
            case Expr::Kind::max: call(e, "max"); break;
        }
    }

    void binary(const Expr& e, std::string_view op) {
        const ExprLevel level = level_of(e);
        print(*e.arguments[0], level);
        text_ += op;
        print(*e.arguments[1], static_cast<ExprLevel>(level + 1));  // left associative
    }

    void call(const Expr& e, std::string_view function) {
        text_ += function;
        text_ += '(';
        for (const ExprPtr& argument : e.arguments) {
            if (&argument != &e.arguments.front()) text_ += ", ";
            print(*argument, kSum);
        }
        text_ += ')';
    }

    std::string& text_;
};

// ---- formulas -----------------------------------------------------------------------------------

/// "1 step", "n steps"
std::string unit_word(const Number& number, const std::string& unit) {
    return unit == kStepsUnit && number.text == "1" ? "step" : unit;
}

std::string text_of(const Bound& bound) {
    const bool apart =
        !bound.unit.empty() && (!bound.number.constant.empty() || bound.unit == kStepsUnit);
    return fmt::format("{}{}{}", bound.number.text, apart ? " " : "",
                       unit_word(bound.number, bound.unit));
}

std::string text_of(const Interval& interval) {
    return fmt::format("[{}, {}]", text_of(interval.low), text_of(interval.high));
}

class FormulaPrinter {
public:
    explicit FormulaPrinter(std::string& text) : text_(text) {}

    void print(const Formula& f, FormulaLevel needed) {
        const bool brackets = operator_of(f.kind).level < needed;
        if (brackets) text_ += '(';
        print(f);
        if (brackets) text_ += ')';
    }

private:
    void print(const Formula& f) {
        const Operator op = operator_of(f.kind);
        switch (op.level) {
            case kAtom:
                text_ += f.kind == Formula::Kind::name ? std::string_view(f.name) : op.symbol;
                break;
            case kComparison: comparison(f); break;
            case kPrefix: prefix(f, op); break;
            case kIff: chain(f, op, kIff, kImplies); break;
            case kImplies: chain(f, op, kOr, kImplies); break;
            case kOr: chain(f, op, kAnd, kAnd); break;
            case kAnd: chain(f, op, kBinary, kBinary); break;
            case kBinary: chain(f, op, kPrefix, kBinary); break;
        }
    }

    void comparison(const Formula& f) {
        ExprPrinter(text_).print(*f.left, kSum);
        text_ += fmt::format(" {} ", symbol(f.comparison));
        ExprPrinter(text_).print(*f.right, kSum);
    }

    void prefix(const Formula& f, const Operator& op) {
        text_ += op.symbol;
        if (f.kind == Formula::Kind::held)
            text_ += fmt::format("[{}]", text_of(f.interval->high));
        else if (f.interval)
            text_ += text_of(*f.interval);
        if (f.kind != Formula::Kind::negation) text_ += ' ';
        // `!x > 0` is !(x > 0); the brackets are there for readers who know another language.
        const bool compared = f.operands[0]->kind == Formula::Kind::comparison;
        print(*f.operands[0], compared ? kAtom : kPrefix);
    }

    /// The first operand needs `first` or tighter, the others `rest`.
    void chain(const Formula& f, const Operator& op, FormulaLevel first, FormulaLevel rest) {
        for (const FormulaPtr& operand : f.operands) {
            const bool is_first = &operand == &f.operands.front();
            if (!is_first) {
                text_ += fmt::format(" {}{} ", op.symbol, f.interval ? text_of(*f.interval) : "");
            }
            print(*operand, is_first ? first : rest);
        }
    }

    std::string& text_;
};

// ---- declarations -------------------------------------------------------------------------------

std::string text_of(const Calibrated& calibrated) {
    std::string arguments;
    for (const Calibrated::Argument& a : calibrated.arguments)
        arguments += fmt::format(", {} = {}", a.key.text, text_of(a.value));
    return fmt::format("calibrated({}{})", calibrated.method.text, arguments);
}

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
    for (const Encoder::Setting& setting : encoder.settings)
        result +=
            fmt::format(", {} {}", setting.key.text, text_of(VectorLiteral{setting.values, {}}));
    return result;
}

std::string text_of(const Input& input) {
    std::string result = fmt::format(
        "input {} : {}{}", joined(input.names, ", ", [](const Name& n) { return n.text; }),
        text_of(input.type), text_of_encoder(input.encoder));
    if (input.range)
        result += fmt::format(" in [{}, {}]", input.range->low.text, input.range->high.text);
    if (input.hold) result += fmt::format(" hold {}", text_of(*input.hold));
    return result + text_of_missing(input.missing);
}

std::string text_of(const Projection& projection) {
    const std::string offset =
        projection.offset ? fmt::format(" offset {}", text_of(*projection.offset)) : "";
    return fmt::format("projection {} = {}{}", projection.name.text, text_of(projection.matrix),
                       offset);
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
    return fmt::format("truth {} = {}", truth.predicate.text, print(*truth.formula));
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
    FormulaPrinter(text).print(formula, kIff);
    return text;
}

std::string print(const Expr& expression) {
    std::string text;
    ExprPrinter(text).print(expression, kSum);
    return text;
}

std::string print(const Frames& frames) {
    return text_of(frames);
}

std::string print(const Images& images) {
    return text_of(images);
}

}  // namespace etlc::ast
