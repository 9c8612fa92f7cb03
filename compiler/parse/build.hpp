// Turns ANTLR's parse trees into ast:: structs. Throws SyntaxError where the grammar accepts more
// than the language: expressions in place of formulas and vice versa, chained comparisons, trees
// higher than kMaxHeight.
#pragma once

#include <string>

#include "EtlParser.h"
#include "ast/ast.hpp"
#include "parse/syntax_error.hpp"

namespace etlc::parse {

using Grammar = grammar::EtlParser;
using antlr4::ParserRuleContext;

/// Builds the trees of one file.
class Builder {
public:
    explicit Builder(const source::File& file) : file_(file) {}

    /// Returns the name in `spec NAME;`, or the declaration.
    std::variant<ast::Name, ast::Declaration> declaration(
        Grammar::DeclarationContext& context) const;

private:
    ast::Declaration built(Grammar::DeclarationContext& context) const;

    /// A tree and the length of its longest path.
    template <class T>
    struct Tree {
        T root;
        int height = 1;
    };
    using Expression = Tree<ast::ExprPtr>;
    using Formula = Tree<ast::FormulaPtr>;

    // declarations.cpp
    static ast::Rounding rounding(Grammar::RoundingContext* context);  ///< null if not written
    ast::Rate period(Grammar::PeriodDeclarationContext& context, source::Span span) const;
    ast::Constant constant(Grammar::ConstDeclarationContext& context, source::Span span) const;
    ast::Encoder encoder(Grammar::EncoderDeclarationContext& context, source::Span span) const;
    /// `context` is null if not written.
    std::optional<ast::Name> encoded_by(Grammar::EncodedByContext* context) const;
    ast::Input input(Grammar::InputDeclarationContext& context, source::Span span) const;
    ast::Type type(Grammar::TypeContext& context) const;
    ast::Range range(Grammar::RangeContext& context) const;
    ast::Projection projection(Grammar::ProjectionDeclarationContext& context,
                               source::Span span) const;
    ast::Target target(Grammar::TargetDeclarationContext& context, source::Span span) const;
    ast::Target::Source target_source(Grammar::SourceContext& context) const;
    ast::Predicate predicate(Grammar::PredicateDeclarationContext& context,
                             source::Span span) const;
    static std::optional<bool> missing(Grammar::MissingContext* context);  ///< null if not written
    ast::Monitor monitor(Grammar::MonitorDeclarationContext& context, source::Span span) const;
    ast::Calibrated calibrated(Grammar::CalibratedContext& context) const;
    std::vector<ast::Calibrated::Argument> arguments(
        const std::vector<Grammar::ArgumentContext*>& contexts) const;
    std::string content(const Token& string) const;  ///< without its quotes
    template <class Named, class Context>
    void set_file(Named& to, const Context& context) const;  ///< sets path and key
    ast::Load load(Grammar::LoadContext& context) const;
    ast::Frames frames(Grammar::FramesContext& context) const;
    ast::Fitted fitted(Grammar::FittedContext& context) const;
    ast::Projection::Numbers numbers(Grammar::NumbersContext& context) const;
    std::variant<ast::MatrixLiteral, ast::VectorLiteral> literal(
        Grammar::LiteralContext& context) const;
    ast::Name name(const Grammar::NameContext& context) const;
    ast::Number number(const Token& token) const;
    /// Reads an amount with an optional '-' into one text without blanks.
    ast::Number number(const ParserRuleContext& context) const;

    // expressions.cpp
    Expression expression(Grammar::FormulaContext& context) const;
    Expression expression(Grammar::SumContext& context) const;
    Expression expression(Grammar::ProductContext& context) const;
    Expression expression(Grammar::FactorContext& context) const;
    Expression expression(Grammar::PrimaryContext& context) const;
    Expression call(const Token& function, const std::vector<Grammar::FormulaContext*>& arguments,
                    const ParserRuleContext& whole) const;
    Expression variadic(Grammar::VariadicFunctionPrimaryContext& context) const;
    Expression count(Grammar::CountPrimaryContext& context) const;
    static Expression past(ast::Past how, source::Span span, source::Span op,
                           std::vector<Expression> of);
    ast::Bound delay(Grammar::DelayContext& context) const;
    static Expression combined(ast::ExprKind kind, source::Span span, source::Span op,
                               std::vector<Expression> arguments);
    /// Reads operands of one level of precedence, grouped to the left.
    template <class Operand>
    Expression chain(const ParserRuleContext& context) const;
    std::unique_ptr<ast::Distance> distance(Grammar::DistanceContext& context) const;
    ast::Aggregation aggregation(Grammar::AggregationContext& context) const;
    ast::Weights weights(Grammar::WeightsContext& context) const;
    ast::Point point(Grammar::PointContext& context) const;
    ast::Point point(Grammar::LocatedContext& context) const;

    // formulas.cpp
    Formula formula(Grammar::FormulaContext& context) const;
    Formula formula(Grammar::ImplicationContext& context) const;
    Formula formula(Grammar::DisjunctionContext& context) const;
    Formula formula(Grammar::ConjunctionContext& context) const;
    Formula formula(Grammar::BinaryTemporalContext& context) const;
    Formula formula(Grammar::PrefixedContext& context) const;
    Formula formula(Grammar::ComparisonContext& context) const;
    Formula formula(Grammar::UnsignedContext& context) const;
    /// Returns a delay as text, in which a number alone has the unit of steps.
    std::string written_time(Grammar::DelayContext& context) const;
    Formula formula(Grammar::PrimaryContext& context) const;
    template <class Operand>
    Formula n_ary(const ParserRuleContext& context) const;
    static Formula combined(const Token& op, source::Span span, std::vector<Formula> operands);
    static Formula combined(const Token& op, source::Span span, Formula left, Formula right);
    Formula prefix(const Token& op, Grammar::PrefixedContext& operand,
                   const ParserRuleContext& whole) const;
    Formula compared(Grammar::SumContext& left, Grammar::ComparisonContext& context) const;
    Formula of_subtask(Grammar::SumContext& left, Grammar::ComparisonContext& context) const;
    ast::Interval interval(Grammar::IntervalContext& context) const;
    ast::Bound bound(Grammar::BoundContext& context) const;
    std::string unit(Grammar::UnitContext& context) const;
    /// Returns a number of steps, or a duration; the unit is null if not written.
    ast::Bound time(Grammar::AmountContext& amount, Grammar::UnitContext* of) const;
    static ast::Comparison comparison(Grammar::ComparisonOperatorContext& context);

    std::string text(const Token& token) const { return text_of(token, file_); }
    std::string text(const ParserRuleContext& context) const {
        return std::string(file_.text(span_of(context)));
    }

    [[noreturn]] static void fail(diag::Code code, source::Span span, std::string message,
                                  std::string note = {});
    [[noreturn]] static void too_high(source::Span span);

    const source::File& file_;
};

}  // namespace etlc::parse
