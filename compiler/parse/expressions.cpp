#include <fmt/format.h>

#include <algorithm>

#include "parse/build.hpp"
#include "parse/parse.hpp"

namespace etlc::parse {

using ast::ExprKind;

namespace {

ast::ExprPtr expr_node(ExprKind kind, source::Span span) {
    auto result = std::make_unique<ast::Expr>();
    result->kind = kind;
    result->span = span;
    return result;
}

ExprKind expr_kind(const Token& op) {
    switch (op.getType()) {
        case Grammar::PLUS: return ExprKind::add;
        case Grammar::MINUS: return ExprKind::subtract;
        case Grammar::TIMES: return ExprKind::multiply;
        case Grammar::DIVIDE: return ExprKind::divide;
        case Grammar::ABS: return ExprKind::abs;
        case Grammar::SQRT: return ExprKind::sqrt;
        case Grammar::MIN: return ExprKind::min;
        default: return ExprKind::max;
    }
}

template <class Context>
Context& only_child(const ParserRuleContext& context) {
    return *dynamic_cast<Context*>(context.children.front());
}

bool is_single(const ParserRuleContext& context) {
    return context.children.size() == 1;
}

/// Returns the sum that a formula rule consists of; nullptr if it has an operator of formulas.
Grammar::SumContext* only_sum(const Grammar::FormulaContext& context) {
    const ParserRuleContext* at = &context;
    while (is_single(*at)) {
        auto* const child = dynamic_cast<ParserRuleContext*>(at->children.front());
        if (auto* const sum = dynamic_cast<Grammar::SumContext*>(child)) return sum;
        at = child;
    }
    return nullptr;
}

}  // namespace

Builder::Expression Builder::expression(Grammar::FormulaContext& context) const {
    if (Grammar::SumContext* const sum = only_sum(context)) return expression(*sum);
    fail(diag::Code::mixed_up_kinds, span_of(context), "expected an expression, found a formula",
         "expressions are made of scalar inputs, numbers, distances, + - * / and functions");
}

Builder::Expression Builder::combined(ExprKind kind, source::Span span, source::Span op,
                                      std::vector<Expression> arguments) {
    Expression result{expr_node(kind, span)};
    for (Expression& argument : arguments) {
        result.height = std::max(result.height, argument.height + 1);
        result.root->arguments.push_back(std::move(argument.root));
    }
    if (result.height > kMaxHeight) too_high(op);
    return result;
}

template <class Operand>
Builder::Expression Builder::chain(const ParserRuleContext& context) const {
    Expression left = expression(*dynamic_cast<Operand*>(context.children[0]));
    for (std::size_t i = 1; i + 1 < context.children.size(); i += 2) {
        const Token& op =
            *dynamic_cast<antlr4::tree::TerminalNode*>(context.children[i])->getSymbol();
        auto& operand = *dynamic_cast<Operand*>(context.children[i + 1]);
        std::vector<Expression> both;
        both.push_back(std::move(left));
        both.push_back(expression(operand));
        left = combined(expr_kind(op), source::join(span_of(*context.start), span_of(operand)),
                        span_of(op), std::move(both));
    }
    return left;
}

Builder::Expression Builder::expression(Grammar::SumContext& context) const {
    return chain<Grammar::ProductContext>(context);
}

Builder::Expression Builder::expression(Grammar::ProductContext& context) const {
    return chain<Grammar::FactorContext>(context);
}

Builder::Expression Builder::expression(Grammar::FactorContext& context) const {
    if (auto* const plain = dynamic_cast<Grammar::UnsignedContext*>(&context))
        return expression(*plain->primary());
    auto& negation = dynamic_cast<Grammar::NegationContext&>(context);
    std::vector<Expression> operand;
    operand.push_back(expression(*negation.factor()));
    return combined(ExprKind::negate, span_of(context), span_of(*context.start),
                    std::move(operand));
}

Builder::Expression Builder::expression(Grammar::PrimaryContext& context) const {
    if (auto* const bracket = dynamic_cast<Grammar::BracketPrimaryContext*>(&context))
        return expression(*bracket->formula());
    if (auto* const unary = dynamic_cast<Grammar::UnaryFunctionPrimaryContext*>(&context))
        return call(*unary->op, {unary->formula()}, context);
    if (auto* const variadic = dynamic_cast<Grammar::VariadicFunctionPrimaryContext*>(&context))
        return call(*variadic->op, variadic->formula(), context);
    if (dynamic_cast<Grammar::ConstantPrimaryContext*>(&context) != nullptr)
        fail(diag::Code::mixed_up_kinds, span_of(context),
             fmt::format("expected an expression, found the formula '{}'", text(context)));

    ast::ExprPtr result = expr_node(ExprKind::name, span_of(context));
    if (auto* const measured = dynamic_cast<Grammar::DistancePrimaryContext*>(&context)) {
        result->kind = ExprKind::distance;
        result->distance = distance(*measured->distance());
        return {std::move(result), 1};
    }
    if (dynamic_cast<Grammar::NumberPrimaryContext*>(&context) != nullptr)
        result->kind = ExprKind::number;
    result->text = text(context);
    return {std::move(result), 1};
}

Builder::Expression Builder::call(const Token& function,
                                  const std::vector<Grammar::FormulaContext*>& arguments,
                                  const ParserRuleContext& whole) const {
    std::vector<Expression> values;
    for (Grammar::FormulaContext* const argument : arguments)
        values.push_back(expression(*argument));
    return combined(expr_kind(function), span_of(whole), span_of(function), std::move(values));
}

std::unique_ptr<ast::Distance> Builder::distance(Grammar::DistanceContext& context) const {
    auto result = std::make_unique<ast::Distance>();
    result->span = span_of(context);
    if (auto* const aggregated = context.aggregation())
        result->aggregation = aggregation(*aggregated);
    const Token& word = *context.metric()->start;
    result->metric = {text(word), span_of(word)};
    if (auto* const weighted = dynamic_cast<Grammar::WeightedMetricContext*>(context.metric()))
        result->weights = weights(*weighted->weights());

    result->point = point(*context.point());
    result->target = name(*context.name());
    return result;
}

ast::Point Builder::point(Grammar::PointContext& context) const {
    ast::Point result;
    result.span = span_of(context);
    Grammar::PointContext* at = &context;
    while (auto* const named = dynamic_cast<Grammar::NamedPointContext*>(at)) {
        at = named->point();
        (at == nullptr ? result.inputs : result.projections).push_back(name(*named->name()));
        if (at == nullptr) return result;
    }
    result.is_vector = true;
    for (const Grammar::NameContext* const n :
         dynamic_cast<Grammar::VectorPointContext&>(*at).name())
        result.inputs.push_back(name(*n));
    return result;
}

ast::Aggregation Builder::aggregation(Grammar::AggregationContext& context) const {
    using Aggregation = ast::Aggregation::Kind;
    ast::Aggregation result;
    result.span = span_of(context);
    if (auto* const kth = dynamic_cast<Grammar::KthAggregationContext*>(&context)) {
        result.kind = Aggregation::kth;
        result.n = number(*kth->amount());
        return result;
    }
    const std::size_t word = context.start->getType();
    result.kind = word == Grammar::MIN   ? Aggregation::min
                  : word == Grammar::MAX ? Aggregation::max
                                         : Aggregation::mean;
    return result;
}

ast::Weights Builder::weights(Grammar::WeightsContext& context) const {
    if (auto* const loaded = dynamic_cast<Grammar::LoadedWeightsContext*>(&context))
        return load(*loaded->load());
    if (auto* const named = dynamic_cast<Grammar::NamedWeightsContext*>(&context))
        return name(*named->name());
    if (auto* const fit = dynamic_cast<Grammar::FittedWeightsContext*>(&context))
        return fitted(*fit->fitted());
    auto value = literal(*dynamic_cast<Grammar::LiteralWeightsContext&>(context).literal());
    return std::visit([](auto&& v) -> ast::Weights { return std::move(v); }, std::move(value));
}

}  // namespace etlc::parse
