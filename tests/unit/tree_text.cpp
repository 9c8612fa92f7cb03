#include "tree_text.hpp"

#include <fmt/format.h>

#include <array>
#include <variant>

namespace etlc::tree_text {

namespace {

using namespace ast;

std::string list(const std::string& head, const std::vector<std::string>& items) {
    std::string text = "(" + head;
    for (const std::string& item : items) text += " " + item;
    return text + ")";
}

std::string word(const Name& name) {
    return name.text;
}

std::string word(const VectorLiteral& vector) {
    std::vector<std::string> items;
    for (const Number& n : vector.values) items.push_back(n.text);
    return list("vector", items);
}

std::string word(const MatrixLiteral& matrix) {
    std::vector<std::string> rows;
    for (const auto& row : matrix.rows) rows.push_back(word(VectorLiteral{row, {}}));
    return list("matrix", rows);
}

std::string word(const Load& load) {
    return list("load", {"\"" + load.path + "\"", "\"" + load.key + "\""});
}

std::string word(const Bound& bound) {
    return bound.number.text + bound.unit;
}

std::string word(const Calibrated& calibrated) {
    std::vector<std::string> items{calibrated.method.text};
    for (const Calibrated::Argument& a : calibrated.arguments)
        items.push_back(
            list(a.key.text, {std::visit([](const auto& v) { return word(v); }, a.value)}));
    return list("calibrated", items);
}

std::string word(const Frames& frames) {
    std::vector<std::string> items{"\"" + frames.path + "\""};
    if (!frames.key.empty()) items.push_back("\"" + frames.key + "\"");
    for (const Number& n : frames.frames) items.push_back(n.text);
    if (frames.stride) items.push_back(list("stride", {frames.stride->text}));
    return list("frames", items);
}

std::string word(const Images& images) {
    return list("images", {"\"" + images.path + "\""});
}

std::string word(const Point& point) {
    std::vector<std::string> items;
    for (const Point& part : point.parts)
        items.push_back(point.is_vector && part.is_name() ? part.name.text : word(part));
    std::string text = point.is_vector       ? list("vector", items)
                       : point.parts.empty() ? list("input", {point.name.text})
                                             : list(point.name.text, items);
    for (const Bound& delay : point.delays) text = list("ago", {text, word(delay)});
    return text;
}

std::string word(const Number& number) {
    return number.text;
}

std::string word(const FormulaPtr& formula) {
    return of(*formula);
}

std::string word(const Fitted& fitted) {
    std::vector<std::string> items{fitted.method.text};
    for (const Fitted::Argument& a : fitted.arguments)
        items.push_back(
            list(a.key.text, {std::visit([](const auto& v) { return word(v); }, a.value)}));
    return list("fitted", items);
}

std::string word(const ExprPtr& threshold) {
    return of(*threshold);
}

std::string word(Comparison comparison) {
    switch (comparison) {
        case Comparison::less_equal: return "<=";
        case Comparison::less: return "<";
        case Comparison::greater_equal: return ">=";
        case Comparison::greater: return ">";
        case Comparison::equal: return "==";
        case Comparison::not_equal: return "!=";
    }
    return "?";
}

std::string word(const Distance& distance) {
    std::vector<std::string> items;
    if (distance.aggregation) {
        const char* const kinds[] = {"min", "max", "mean", "kth"};
        items.emplace_back(kinds[static_cast<int>(distance.aggregation->kind)]);
        if (distance.aggregation->n) items.push_back(distance.aggregation->n->text);
    }
    items.push_back(distance.metric.text);
    if (distance.weights)
        items.push_back(std::visit([](const auto& w) { return list("weights", {word(w)}); },
                                   *distance.weights));
    items.push_back(word(distance.point));
    items.push_back(distance.other.is_name() ? distance.other.name.text : word(distance.other));
    return list("distance", items);
}

std::string head(Expr::Kind kind) {
    switch (kind) {
        case Expr::Kind::number: return "number";
        case Expr::Kind::name: return "name";
        case Expr::Kind::distance: return "distance";
        case Expr::Kind::past: return "past";
        case Expr::Kind::negate: return "negate";
        case Expr::Kind::add: return "+";
        case Expr::Kind::subtract: return "-";
        case Expr::Kind::multiply: return "*";
        case Expr::Kind::divide: return "/";
        case Expr::Kind::abs: return "abs";
        case Expr::Kind::sqrt: return "sqrt";
        case Expr::Kind::min: return "min";
        case Expr::Kind::max: return "max";
    }
    return "?";
}

std::string head(Formula::Kind kind) {
    switch (kind) {
        case Formula::Kind::constant_true: return "true";
        case Formula::Kind::constant_false: return "false";
        case Formula::Kind::name: return "name";
        case Formula::Kind::comparison: return "compare";
        case Formula::Kind::negation: return "!";
        case Formula::Kind::conjunction: return "&&";
        case Formula::Kind::disjunction: return "||";
        case Formula::Kind::implication: return "->";
        case Formula::Kind::equivalence: return "<->";
        case Formula::Kind::next: return "X";
        case Formula::Kind::eventually: return "F";
        case Formula::Kind::always: return "G";
        case Formula::Kind::until: return "U";
        case Formula::Kind::weak_until: return "W";
        case Formula::Kind::release: return "R";
        case Formula::Kind::previous: return "Y";
        case Formula::Kind::once: return "O";
        case Formula::Kind::historically: return "H";
        case Formula::Kind::since: return "S";
        case Formula::Kind::rise: return "rise";
        case Formula::Kind::fall: return "fall";
        case Formula::Kind::held: return "held";
    }
    return "?";
}

std::string word(const Rate& d) {
    std::vector<std::string> items{d.number.text, d.unit};
    if (d.durations != Rounding::exact) items.emplace_back(word(d.durations));
    return list(d.is_period ? "period" : "rate", items);
}

std::string word(const Constant& d) {
    return list("const", {d.name.text, d.value.text, d.unit});
}

std::string word(const Encoder& d) {
    std::vector<std::string> items{d.name.text, word(d.model)};
    for (const Encoder::Setting& setting : d.settings) {
        std::vector<std::string> numbers;
        for (const Number& n : setting.values) numbers.push_back(n.text);
        items.push_back(list(setting.key.text, numbers));
    }
    return list("encoder", items);
}

std::string word(const Input& d) {
    const char* const types[] = {"f32", "f16", "i8", "bool"};
    std::vector<std::string> items;
    for (const Name& n : d.names) items.push_back(n.text);
    items.push_back(std::string(":") + types[static_cast<int>(d.type.kind)]);
    if (d.type.dimension) items.push_back(list("dimension", {d.type.dimension->text}));
    if (d.type.scale) items.push_back(list("scale", {d.type.scale->text}));
    if (d.encoder) items.push_back(list("by", {d.encoder->text}));
    if (d.range) items.push_back(list("range", {d.range->low.text, d.range->high.text}));
    if (d.hold) items.push_back(list("hold", {d.hold->number.text + d.hold->unit}));
    if (d.stale) items.push_back(list("stale", {d.stale->number.text + d.stale->unit}));
    return list("input", items);
}

std::string word(const Projection& d) {
    const auto text = [](const auto& v) { return word(v); };
    std::vector<std::string> items{d.name.text, std::visit(text, d.matrix)};
    if (d.offset) items.push_back(list("offset", {std::visit(text, *d.offset)}));
    return list("projection", items);
}

std::string word(const Target& d) {
    std::vector<std::string> items{d.name.text};
    for (const Target::Source& source : d.sources)
        items.push_back(std::visit([](const auto& v) { return word(v); }, source));
    if (d.encoder) items.push_back(list("by", {d.encoder->text}));
    if (d.space) items.push_back(list("of", {word(*d.space)}));
    return list("target", items);
}

std::string word(const Predicate& d) {
    return list("predicate", {d.name.text, word(d.comparison), of(*d.expression),
                              std::visit([](const auto& t) { return word(t); }, d.threshold)});
}

std::string word(const Truth& d) {
    return list("truth", {d.subject.text, of(*d.formula)});
}

std::string word(const Let& d) {
    return list("let", {d.name.text, of(*d.formula)});
}

std::string word(const Monitor& d) {
    std::vector<std::string> items{d.name.text, of(*d.formula)};
    if (d.calibrated) items.push_back(word(*d.calibrated));
    constexpr std::array<const char*, 4> kWords{"monitor", "sliding", "restartable", "repeating"};
    return list(kWords[static_cast<std::size_t>(d.kind)], items);
}

std::string word(const Drift& d) {
    std::vector<std::string> items{d.name.text, d.of.text};
    for (const Calibrated::Argument& a : d.arguments)
        items.push_back(
            list(a.key.text, {std::visit([](const auto& v) { return word(v); }, a.value)}));
    return list("drift", items);
}

}  // namespace

std::string of(const Expr& e) {
    if (e.kind == Expr::Kind::number || e.kind == Expr::Kind::name) return e.text;
    if (e.kind == Expr::Kind::distance) return word(*e.distance);
    std::vector<std::string> items;
    for (const ExprPtr& argument : e.arguments) items.push_back(of(*argument));
    return list(head(e.kind), items);
}

std::string of(const Formula& f) {
    if (f.kind == Formula::Kind::name) return f.name;
    if (f.kind == Formula::Kind::comparison)
        return list(word(f.comparison), {of(*f.left), of(*f.right)});
    if (f.operands.empty()) return head(f.kind);
    std::vector<std::string> items;
    if (f.interval) {
        items.push_back(fmt::format("[{},{}]", word(f.interval->low), word(f.interval->high)));
    }
    for (const FormulaPtr& operand : f.operands) items.push_back(of(*operand));
    return list(head(f.kind), items);
}

std::string of(const Declaration& declaration) {
    return std::visit([](const auto& d) { return word(d); }, declaration);
}

std::string of(const Spec& spec) {
    std::string text = "spec " + spec.name.text + "\n";
    for (const Declaration& declaration : spec.declarations) text += of(declaration) + "\n";
    return text;
}

}  // namespace etlc::tree_text
