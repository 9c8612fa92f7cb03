#include <fmt/format.h>

#include <algorithm>

#include "parse/build.hpp"
#include "parse/parse.hpp"

namespace etlc::parse {

using ast::ExprKind;
using ast::PastKind;

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
    if (auto* const plain = dynamic_cast<Grammar::UnsignedContext*>(&context)) {
        Expression result = expression(*plain->primary());
        for (Grammar::DelayContext* const ago : plain->delay()) {
            std::vector<Expression> of;
            of.push_back(std::move(result));
            const source::Span span = source::join(span_of(context), span_of(*ago));
            result =
                past({PastKind::ago, nullptr, delay(*ago)}, span, span_of(*ago), std::move(of));
        }
        return result;
    }
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
        return this->variadic(*variadic);
    if (auto* const counted = dynamic_cast<Grammar::CountPrimaryContext*>(&context))
        return count(*counted);
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

Builder::Expression Builder::past(ast::Past how, source::Span span, source::Span op,
                                  std::vector<Expression> of) {
    Expression result = combined(ExprKind::past, span, op, std::move(of));
    result.root->past = std::make_unique<ast::Past>(std::move(how));
    return result;
}

/// min(x, y) is the smaller of two; min(x, 2 s), with a unit, is the least of a window.
Builder::Expression Builder::variadic(Grammar::VariadicFunctionPrimaryContext& context) const {
    const auto arguments = context.formula();
    const auto units = context.unit();
    const Token& op = *context.op;
    const std::string word = text(op);
    if (units.empty() && op.getType() != Grammar::MEAN) return call(op, arguments, context);
    if (arguments.size() != 2 || units.size() > 1)
        fail(diag::Code::past_form, span_of(context),
             fmt::format("expected {0} of an expression and a time, as in '{0}(x, 2 s)'", word));
    Expression time = expression(*arguments[1]);
    const bool is_amount = time.root->kind == ExprKind::number || time.root->kind == ExprKind::name;
    if (!is_amount)
        fail(diag::Code::past_form, span_of(*arguments[1]),
             fmt::format("expected a time, as in '{}(x, 2 s)'", word));
    const bool is_name = time.root->kind == ExprKind::name;
    ast::Bound bound{
        {time.root->text, time.root->span, is_name ? time.root->text : ""},
        units.empty() ? "" : unit(*units[0]),
        units.empty() ? time.root->span : source::join(time.root->span, span_of(*units[0]))};
    const PastKind kind = op.getType() == Grammar::MEAN  ? PastKind::mean
                          : op.getType() == Grammar::MIN ? PastKind::min
                                                         : PastKind::max;
    std::vector<Expression> of;
    of.push_back(expression(*arguments[0]));
    return past({kind, nullptr, std::move(bound)}, span_of(context), span_of(op), std::move(of));
}

Builder::Expression Builder::count(Grammar::CountPrimaryContext& context) const {
    Formula counted = formula(*context.formula());
    const PastKind kind =
        context.op->getType() == Grammar::COUNT ? PastKind::count : PastKind::fraction;
    Expression result = past({kind, std::move(counted.root), bound(*context.bound())},
                             span_of(context), span_of(*context.start), {});
    result.height = counted.height + 1;
    if (result.height > kMaxHeight) too_high(span_of(*context.start));
    return result;
}

ast::Bound Builder::delay(Grammar::DelayContext& context) const {
    return time(*context.amount(), context.unit());
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

    result->point = point(*context.point(0));
    result->other = point(*context.point(1));
    return result;
}

/// A single point without a sign or a number is no sum.
ast::Point Builder::point(Grammar::PointContext& context) const {
    ast::Point sum;
    sum.span = span_of(context);
    bool negative = false;
    std::optional<ast::Number> factor;
    const auto& children = context.children;
    const auto token_at = [&](std::size_t i) -> const Token* {
        auto* const leaf =
            i < children.size() ? dynamic_cast<antlr4::tree::TerminalNode*>(children[i]) : nullptr;
        return leaf == nullptr ? nullptr : leaf->getSymbol();
    };
    for (std::size_t i = 0; i < children.size(); ++i) {
        if (const Token* const token = token_at(i)) {
            if (token->getType() == Grammar::NUMBER) factor = number(*token);
            negative = negative || token->getType() == Grammar::MINUS;
            continue;
        }
        auto& operand = *dynamic_cast<Grammar::LocatedContext*>(children[i]);
        ast::Point part = point(operand);
        const Token* const next = token_at(i + 1);
        if (next != nullptr && next->getType() == Grammar::TIMES) {
            if (factor || !part.is_name())
                fail(diag::Code::point_form, part.span,
                     fmt::format("expected one number before a point, found '{} *'", text(operand)),
                     "a number stands before the point that it multiplies: 2 * z");
            factor = {part.name.text, part.span, part.name.text};
            continue;
        }
        if (!factor) factor = {"1", part.span, ""};
        if (negative) factor->text.insert(0, "-");
        sum.parts.push_back(std::move(part));
        sum.factors.push_back(*std::exchange(factor, std::nullopt));
        negative = false;
    }
    if (children.size() == 1) return std::move(sum.parts.front());
    return sum;
}

ast::Point Builder::point(Grammar::LocatedContext& context) const {
    ast::Point result;
    const bool nested = context.name() == nullptr && context.LBRACKET() == nullptr;
    if (nested) result = point(*context.point(0));
    result.span = span_of(context);
    if (context.name() != nullptr) result.name = name(*context.name());
    result.is_vector = result.is_vector || context.LBRACKET() != nullptr;
    if (!nested)
        for (auto* const part : context.point()) result.parts.push_back(point(*part));
    for (Grammar::DelayContext* const ago : context.delay()) result.delays.push_back(delay(*ago));
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
