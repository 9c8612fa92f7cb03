#include <fmt/format.h>

#include <algorithm>

#include "parse/build.hpp"
#include "parse/parse.hpp"

namespace etlc::parse {

using Kind = ast::Formula::Kind;

namespace {

ast::FormulaPtr node(Kind kind, source::Span span) {
    auto result = std::make_unique<ast::Formula>();
    result->kind = kind;
    result->span = span;
    return result;
}

const Token& symbol(antlr4::tree::ParseTree* child) {
    return *dynamic_cast<antlr4::tree::TerminalNode*>(child)->getSymbol();
}

/// Returns the factor that a sum consists of; nullptr if it has an operator of expressions.
Grammar::UnsignedContext* only_factor(Grammar::SumContext& context) {
    if (context.children.size() != 1) return nullptr;
    auto& product = dynamic_cast<Grammar::ProductContext&>(*context.children[0]);
    if (product.children.size() != 1) return nullptr;
    return dynamic_cast<Grammar::UnsignedContext*>(product.children[0]);
}

/// Texts that would make a message hard to read are not quoted in it.
constexpr std::size_t kLongestQuoted = 60;

}  // namespace

Builder::Formula Builder::combined(const Token& op, source::Span span,
                                   std::vector<Formula> operands) {
    Formula result{node(*operator_kind(op.getType()), span)};
    result.root->operator_span = span_of(op);
    for (Formula& operand : operands) {
        result.height = std::max(result.height, operand.height + 1);
        result.root->operands.push_back(std::move(operand.root));
    }
    if (result.height > kMaxHeight) too_high(span_of(op));
    return result;
}

Builder::Formula Builder::combined(const Token& op, source::Span span, Formula left,
                                   Formula right) {
    std::vector<Formula> operands;
    operands.push_back(std::move(left));
    operands.push_back(std::move(right));
    return combined(op, span, std::move(operands));
}

template <class Operand>
Builder::Formula Builder::n_ary(const ParserRuleContext& context) const {
    std::vector<Formula> operands;
    for (std::size_t i = 0; i < context.children.size(); i += 2)
        operands.push_back(formula(*dynamic_cast<Operand*>(context.children[i])));
    if (operands.size() == 1) return std::move(operands[0]);
    return combined(symbol(context.children[1]), span_of(context), std::move(operands));
}

Builder::Formula Builder::formula(Grammar::FormulaContext& context) const {
    Formula left = formula(*dynamic_cast<Grammar::ImplicationContext*>(context.children[0]));
    for (std::size_t i = 1; i + 1 < context.children.size(); i += 2) {
        auto& operand = dynamic_cast<Grammar::ImplicationContext&>(*context.children[i + 1]);
        left = combined(symbol(context.children[i]),
                        source::join(span_of(*context.start), span_of(operand)), std::move(left),
                        formula(operand));
    }
    return left;
}

Builder::Formula Builder::formula(Grammar::ImplicationContext& context) const {
    Formula left = formula(*context.disjunction());
    if (context.children.size() == 1) return left;
    return combined(symbol(context.children[1]), span_of(context), std::move(left),
                    formula(*context.implication()));
}

Builder::Formula Builder::formula(Grammar::DisjunctionContext& context) const {
    return n_ary<Grammar::ConjunctionContext>(context);
}

Builder::Formula Builder::formula(Grammar::ConjunctionContext& context) const {
    return n_ary<Grammar::BinaryTemporalContext>(context);
}

Builder::Formula Builder::formula(Grammar::BinaryTemporalContext& context) const {
    Formula left = formula(*context.prefixed());
    if (context.op == nullptr) return left;
    Formula result = combined(*context.op, span_of(context), std::move(left),
                              formula(*context.binaryTemporal()));
    if (auto* const bounds = context.interval()) result.root->interval = interval(*bounds);
    return result;
}

Builder::Formula Builder::prefix(const Token& op, Grammar::PrefixedContext& operand,
                                 const ParserRuleContext& whole) const {
    std::vector<Formula> operands;
    operands.push_back(formula(operand));
    return combined(op, span_of(whole), std::move(operands));
}

Builder::Formula Builder::formula(Grammar::PrefixedContext& context) const {
    if (auto* const atom = dynamic_cast<Grammar::AtomContext*>(&context))
        return formula(*atom->comparison());
    if (auto* const plain = dynamic_cast<Grammar::PlainPrefixContext*>(&context))
        return prefix(*plain->op, *plain->prefixed(), context);
    if (auto* const held = dynamic_cast<Grammar::HeldPrefixContext*>(&context)) {
        Formula result = prefix(*held->op, *held->prefixed(), context);
        const ast::Bound high = bound(*held->duration()->bound());
        result.root->interval = {{{"0", high.span}, "", high.span}, high, high.span};
        return result;
    }
    auto& bounded = dynamic_cast<Grammar::IntervalPrefixContext&>(context);
    Formula result = prefix(*bounded.op, *bounded.prefixed(), context);
    if (auto* const bounds = bounded.interval()) result.root->interval = interval(*bounds);
    return result;
}

Builder::Formula Builder::formula(Grammar::ComparisonContext& context) const {
    auto& left = dynamic_cast<Grammar::SumContext&>(*context.children[0]);
    if (context.children.size() > 1) return compared(left, context);
    if (Grammar::UnsignedContext* const factor = only_factor(left)) return formula(*factor);
    fail(diag::Code::mixed_up_kinds, span_of(context), "expected a formula, found an expression",
         "an expression becomes a formula by comparing it with a number, as in 'x - y > 0'");
}

Builder::Formula Builder::compared(Grammar::SumContext& left,
                                   Grammar::ComparisonContext& context) const {
    auto& op = dynamic_cast<Grammar::ComparisonOperatorContext&>(*context.children[1]);
    if (context.children.size() > 3)
        fail(diag::Code::comparison_form,
             span_of(dynamic_cast<ParserRuleContext&>(*context.children[3])),
             "comparisons do not chain", "write two of them: 'x > 0 && x < 1'");
    if (dynamic_cast<antlr4::tree::TerminalNode*>(context.children[2]) != nullptr)
        return of_subtask(left, context);
    auto* const written = dynamic_cast<Grammar::SumContext*>(context.children[2]);
    if (written == nullptr)
        fail(diag::Code::comparison_form,
             span_of(dynamic_cast<ParserRuleContext&>(*context.children[2])),
             "a calibrated threshold is allowed only in a predicate",
             "declare 'predicate NAME = ... calibrated(...);' and use its name here");
    Expression value = expression(left);
    Expression right = expression(*written);
    Formula result{node(Kind::comparison, span_of(context)),
                   std::max(value.height, right.height) + 1};
    result.root->left = std::move(value.root);
    result.root->comparison = comparison(op);
    result.root->right = std::move(right.root);
    result.root->operator_span = span_of(op);
    if (result.height > kMaxHeight) too_high(span_of(op));
    return result;
}

/// `subtask == "reach"` is the name of an input that recordings have; `!=` negates it.
Builder::Formula Builder::of_subtask(Grammar::SumContext& left,
                                     Grammar::ComparisonContext& context) const {
    auto& op = dynamic_cast<Grammar::ComparisonOperatorContext&>(*context.children[1]);
    const bool negated = op.NOT_EQUAL() != nullptr;
    Grammar::UnsignedContext* const factor = only_factor(left);
    const bool is_name = factor != nullptr && factor->delay().empty() &&
                         dynamic_cast<Grammar::NamePrimaryContext*>(factor->primary()) != nullptr;
    if (!is_name || (!negated && op.EQUAL() == nullptr))
        fail(diag::Code::comparison_form, span_of(context),
             "only the subtask of a recording is compared with a text, by '==' or '!='",
             "write it as in 'truth grasp = subtask == \"pick up the cup\";'");
    Formula result{node(Kind::name, span_of(context)), 1};
    result.root->name = fmt::format("{} == {}", text(left), text(symbol(context.children[2])));
    if (!negated) return result;
    Formula outer{node(Kind::negation, span_of(context)), 2};
    outer.root->operator_span = span_of(op);
    outer.root->operands.push_back(std::move(result.root));
    return outer;
}

Builder::Formula Builder::formula(Grammar::UnsignedContext& context) const {
    Formula result = formula(*context.primary());
    if (context.delay().empty()) return result;
    std::string was = text(*context.primary());
    if (was.size() > kLongestQuoted || was.find('\n') != std::string::npos) was = "(...)";
    const std::string now = was;
    for (Grammar::DelayContext* const ago : context.delay()) {
        const std::string time = written_time(*ago);
        was = fmt::format("O[{0}, {0}] {1}", time, was);
    }
    diag::Diagnostic error{diag::Code::mixed_up_kinds,
                           "'@' gives an earlier number or point, not an earlier truth value",
                           span_of(context)};
    error.note(fmt::format("whether '{}' held then is '{}'", now, was));
    if (result.root->kind == Kind::name)
        error.note(fmt::format("if '{}' is a number, compare it with another, as in '{} > 0'", now,
                               text(context)));
    throw SyntaxError{std::move(error)};
}

std::string Builder::written_time(Grammar::DelayContext& context) const {
    const std::string number = text(*context.amount());
    if (context.unit() != nullptr || is_name(*context.start)) return text(context);
    return fmt::format("{} {}", number, number == "1" ? "step" : ast::kStepsUnit);
}

Builder::Formula Builder::formula(Grammar::PrimaryContext& context) const {
    if (auto* const bracket = dynamic_cast<Grammar::BracketPrimaryContext*>(&context))
        return formula(*bracket->formula());
    if (auto* const constant = dynamic_cast<Grammar::ConstantPrimaryContext*>(&context))
        return {node(constant->op->getType() == Grammar::TRUE ? Kind::constant_true
                                                              : Kind::constant_false,
                     span_of(context)),
                1};
    if (auto* const named = dynamic_cast<Grammar::NamePrimaryContext*>(&context)) {
        ast::FormulaPtr result = node(Kind::name, span_of(context));
        result->name = text(*named->start);
        return {std::move(result), 1};
    }
    const bool is_number = dynamic_cast<Grammar::NumberPrimaryContext*>(&context) != nullptr;
    const bool is_distance = dynamic_cast<Grammar::DistancePrimaryContext*>(&context) != nullptr;
    fail(diag::Code::mixed_up_kinds, span_of(context),
         fmt::format("expected a formula, found {}", is_number     ? "a number"
                                                     : is_distance ? "a distance"
                                                                   : "an expression"),
         "an expression becomes a formula by comparing it with a number, as in 'x - y > 0'");
}

ast::Interval Builder::interval(Grammar::IntervalContext& context) const {
    return {bound(*context.bound(0)), bound(*context.bound(1)), span_of(context)};
}

ast::Bound Builder::bound(Grammar::BoundContext& context) const {
    if (auto* const open = dynamic_cast<Grammar::CalibratedBoundContext*>(&context))
        return {{"0", span_of(context)},
                "",
                span_of(context),
                std::make_unique<ast::Calibrated>(calibrated(*open->calibrated()))};
    ast::Bound result{number(*context.start), {}, span_of(context)};
    if (auto* const finite = dynamic_cast<Grammar::FiniteBoundContext*>(&context))
        if (finite->unit() != nullptr) result.unit = unit(*finite->unit());
    return result;
}

std::string Builder::unit(Grammar::UnitContext& context) const {
    return context.STEPS() != nullptr ? std::string(ast::kStepsUnit) : text(context);
}

ast::Comparison Builder::comparison(Grammar::ComparisonOperatorContext& context) {
    switch (context.start->getType()) {
        case Grammar::LESS_EQUAL: return ast::Comparison::less_equal;
        case Grammar::LESS: return ast::Comparison::less;
        case Grammar::GREATER_EQUAL: return ast::Comparison::greater_equal;
        case Grammar::GREATER: return ast::Comparison::greater;
        case Grammar::EQUAL: return ast::Comparison::equal;
        default: return ast::Comparison::not_equal;
    }
}

}  // namespace etlc::parse
