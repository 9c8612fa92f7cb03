#include <fmt/format.h>

#include "parse/build.hpp"
#include "parse/parse.hpp"

namespace etlc::parse {

namespace {

/// Returns the span of a declaration without its ';'.
source::Span span_of_declaration(const Grammar::DeclarationContext& context, source::Span last) {
    return source::join(span_of(*context.start), last);
}

/// Returns the span of the last part before the closing ';'.
source::Span last_part(const Grammar::DeclarationContext& context) {
    auto* const part = context.children[context.children.size() - 2];
    if (auto* const terminal = dynamic_cast<antlr4::tree::TerminalNode*>(part))
        return span_of(*terminal->getSymbol());
    return span_of(dynamic_cast<const ParserRuleContext&>(*part));
}

}  // namespace

std::variant<ast::Name, ast::Declaration> Builder::declaration(
    Grammar::DeclarationContext& context) const {
    if (auto* const d = dynamic_cast<Grammar::SpecDeclarationContext*>(&context))
        return name(*d->name());
    return built(context);
}

ast::Declaration Builder::built(Grammar::DeclarationContext& context) const {
    const source::Span span = span_of_declaration(context, last_part(context));
    if (auto* const d = dynamic_cast<Grammar::RateDeclarationContext*>(&context))
        return ast::Rate{number(*d->amount()), false, "Hz", rounding(d->rounding()), span};
    if (auto* const d = dynamic_cast<Grammar::PeriodDeclarationContext*>(&context))
        return period(*d, span);
    if (auto* const d = dynamic_cast<Grammar::ConstDeclarationContext*>(&context))
        return constant(*d, span);
    if (auto* const d = dynamic_cast<Grammar::EncoderDeclarationContext*>(&context))
        return encoder(*d, span);
    if (auto* const d = dynamic_cast<Grammar::InputDeclarationContext*>(&context))
        return input(*d, span);
    if (auto* const d = dynamic_cast<Grammar::ProjectionDeclarationContext*>(&context))
        return projection(*d, span);
    if (auto* const d = dynamic_cast<Grammar::TargetDeclarationContext*>(&context))
        return target(*d, span);
    if (auto* const d = dynamic_cast<Grammar::PredicateDeclarationContext*>(&context))
        return predicate(*d, span);
    if (auto* const d = dynamic_cast<Grammar::TruthDeclarationContext*>(&context))
        return ast::Truth{name(*d->name()), formula(*d->formula()).root, span};
    if (auto* const d = dynamic_cast<Grammar::LetDeclarationContext*>(&context))
        return ast::Let{name(*d->name()), formula(*d->formula()).root, span};
    if (auto* const d = dynamic_cast<Grammar::DriftDeclarationContext*>(&context))
        return ast::Drift{name(*d->name(0)), name(*d->name(1)), arguments(d->argument()), span};
    return monitor(dynamic_cast<Grammar::MonitorDeclarationContext&>(context), span);
}

ast::Rounding Builder::rounding(Grammar::RoundingContext* context) {
    if (context == nullptr) return ast::Rounding::exact;
    const std::size_t word = context->op->getType();
    return word == Grammar::UP     ? ast::Rounding::up
           : word == Grammar::DOWN ? ast::Rounding::down
                                   : ast::Rounding::nearest;
}

ast::Rate Builder::period(Grammar::PeriodDeclarationContext& context, source::Span span) const {
    auto* const unit = context.timeUnit();
    return {
        number(context.name() != nullptr ? *context.name()->start : *context.NUMBER()->getSymbol()),
        true, unit != nullptr ? text(*unit) : "", rounding(context.rounding()), span};
}

ast::Constant Builder::constant(Grammar::ConstDeclarationContext& context,
                                source::Span span) const {
    ast::Constant result{name(*context.name()), number(*context.NUMBER()->getSymbol()), "", span};
    if (context.MINUS() != nullptr) {
        result.value.text.insert(0, "-");
        result.value.span.begin = span_of(*context.MINUS()->getSymbol()).begin;
    }
    if (context.unit() != nullptr) result.unit = unit(*context.unit());
    return result;
}

ast::Encoder Builder::encoder(Grammar::EncoderDeclarationContext& context,
                              source::Span span) const {
    ast::Encoder result;
    result.name = name(*context.name());
    result.model = load(*context.load());
    result.span = span;
    for (Grammar::SettingContext* const setting : context.setting()) {
        ast::Encoder::Setting& added = result.settings.emplace_back();
        added.key = {text(*setting->op), span_of(*setting->op)};
        if (setting->name() != nullptr) added.word = name(*setting->name());
        if (antlr4::tree::TerminalNode* const quoted = setting->STRING()) {
            added.word = {content(*quoted->getSymbol()), span_of(*quoted->getSymbol())};
            added.is_quoted = true;
        }
        if (setting->load() != nullptr) added.file = load(*setting->load());
        if (setting->row() != nullptr)
            for (Grammar::NumberContext* const value : setting->row()->number())
                added.values.push_back(number(*value));
        added.span = span_of(*setting);
    }
    return result;
}

std::optional<ast::Name> Builder::encoded_by(Grammar::EncodedByContext* context) const {
    if (context == nullptr) return std::nullopt;
    return name(*context->name());
}

ast::Bound Builder::time(Grammar::AmountContext& amount, Grammar::UnitContext* of) const {
    ast::Bound result{number(amount), "", span_of(amount)};
    if (of == nullptr) return result;
    result.unit = unit(*of);
    result.span = source::join(result.span, span_of(*of));
    return result;
}

ast::Input Builder::input(Grammar::InputDeclarationContext& context, source::Span span) const {
    ast::Input result;
    for (const Grammar::NameContext* const n : context.name()) result.names.push_back(name(*n));
    result.type = type(*context.type());
    result.encoder = encoded_by(context.encodedBy());
    if (auto* const limits = context.range()) result.range = range(*limits);
    if (auto* const hold = context.hold()) result.hold = time(*hold->amount(), hold->unit());
    result.missing = missing(context.missing());
    if (auto* const stale = context.stale()) result.stale = time(*stale->amount(), stale->unit());
    result.span = span;
    return result;
}

ast::Type Builder::type(Grammar::TypeContext& context) const {
    ast::Type result;
    result.span = span_of(context);
    Grammar::DimensionContext* dimension = nullptr;
    if (auto* const t = dynamic_cast<Grammar::Float32TypeContext*>(&context)) {
        dimension = t->dimension();
    } else if (auto* const half = dynamic_cast<Grammar::Float16TypeContext*>(&context)) {
        result.kind = ast::Type::Kind::f16;
        dimension = half->dimension();
    } else if (auto* const bytes = dynamic_cast<Grammar::Int8TypeContext*>(&context)) {
        result.kind = ast::Type::Kind::i8;
        dimension = bytes->dimension();
        if (auto* const scale = bytes->number()) result.scale = number(*scale);
    } else {
        result.kind = ast::Type::Kind::boolean;
    }
    if (dimension != nullptr) result.dimension = number(*dimension->amount());
    return result;
}

ast::Range Builder::range(Grammar::RangeContext& context) const {
    return {number(*context.limit(0)), number(*context.limit(1)), span_of(context)};
}

ast::Projection Builder::projection(Grammar::ProjectionDeclarationContext& context,
                                    source::Span span) const {
    ast::Projection result;
    result.name = name(*context.name(0));
    result.span = span;
    if (context.IN() != nullptr) result.space = name(*context.name(1));
    if (auto* const fit = context.fitted()) {
        result.matrix = fitted(*fit);
        return result;
    }
    std::visit([&result](auto&& v) { result.matrix = std::move(v); }, numbers(*context.numbers(0)));
    if (context.OFFSET() != nullptr) result.offset = numbers(*context.numbers(1));
    return result;
}

ast::Target Builder::target(Grammar::TargetDeclarationContext& context, source::Span span) const {
    ast::Target result;
    result.name = name(*context.name());
    result.span = span;
    if (auto* const fit = context.fitted()) result.sources.emplace_back(fitted(*fit));
    for (Grammar::SourceContext* const one : context.source())
        result.sources.push_back(target_source(*one));
    result.encoder = encoded_by(context.encodedBy());
    if (auto* const space = context.point()) result.space = point(*space);
    return result;
}

ast::Target::Source Builder::target_source(Grammar::SourceContext& context) const {
    if (auto* const loaded = context.load()) return load(*loaded);
    if (auto* const taken = context.frames()) return frames(*taken);
    if (auto* const shown = context.images())
        return ast::Images{content(*shown->path), span_of(*shown->path), span_of(*shown)};
    return std::visit([](auto&& v) -> ast::Target::Source { return std::move(v); },
                      literal(*context.literal()));
}

ast::Predicate Builder::predicate(Grammar::PredicateDeclarationContext& context,
                                  source::Span span) const {
    ast::Predicate result;
    result.name = name(*context.name());
    result.expression = expression(*context.sum()).root;
    result.comparison = comparison(*context.comparisonOperator());
    if (auto* const calibration =
            dynamic_cast<Grammar::CalibratedThresholdContext*>(context.threshold()))
        result.threshold = calibrated(*calibration->calibrated());
    else
        result.threshold =
            expression(*dynamic_cast<Grammar::GivenThresholdContext&>(*context.threshold()).sum())
                .root;
    result.missing = missing(context.missing());
    result.span = span;
    return result;
}

std::optional<bool> Builder::missing(Grammar::MissingContext* context) {
    if (context == nullptr) return std::nullopt;
    return context->op->getType() == Grammar::TRUE;
}

namespace {

ast::Monitor::Kind monitor_kind(const Token* word) {
    using Kind = ast::Monitor::Kind;
    if (word == nullptr) return Kind::prefix;
    return word->getType() == Grammar::SLIDING       ? Kind::sliding
           : word->getType() == Grammar::RESTARTABLE ? Kind::restartable
                                                     : Kind::repeating;
}

}  // namespace

ast::Monitor Builder::monitor(Grammar::MonitorDeclarationContext& context,
                              source::Span span) const {
    ast::Monitor result;
    result.name = name(*context.name());
    result.formula = formula(*context.formula()).root;
    result.kind = monitor_kind(context.kind);
    if (auto* const calibration = context.calibrated())
        result.calibrated = calibrated(*calibration);
    result.span = span;
    return result;
}

ast::Calibrated Builder::calibrated(Grammar::CalibratedContext& context) const {
    ast::Calibrated result;
    result.method = name(*context.name());
    result.arguments = arguments(context.argument());
    result.span = span_of(context);
    return result;
}

std::vector<ast::Calibrated::Argument> Builder::arguments(
    const std::vector<Grammar::ArgumentContext*>& contexts) const {
    std::vector<ast::Calibrated::Argument> result;
    for (Grammar::ArgumentContext* const argument : contexts) {
        ast::Calibrated::Argument& added = result.emplace_back();
        added.key = name(*argument->name());
        ast::Bound value{number(*argument->number()), "", span_of(*argument->number())};
        if (argument->unit() != nullptr) {
            value.unit = unit(*argument->unit());
            value.span = source::join(value.span, span_of(*argument->unit()));
        }
        if (value.unit.empty() && value.number.text == value.number.constant)
            added.value = ast::Name{value.number.text, value.span};  // a word, or a constant
        else
            added.value = std::move(value);
    }
    return result;
}

template <class Named, class Context>
void Builder::set_file(Named& to, const Context& context) const {
    to.span = span_of(context);
    to.path = content(*context.path);
    to.path_span = span_of(*context.path);
    if (context.key == nullptr) return;
    to.key = content(*context.key);
    to.key_span = span_of(*context.key);
}

std::string Builder::content(const Token& string) const {
    const source::Span span = span_of(string);
    return std::string(file_.text({span.begin + 1, span.end - 1}));
}

ast::Load Builder::load(Grammar::LoadContext& context) const {
    ast::Load result;
    set_file(result, context);
    return result;
}

ast::Frames Builder::frames(Grammar::FramesContext& context) const {
    ast::Frames result;
    set_file(result, context);
    result.frames_span = source::join(span_of(*context.LBRACKET()->getSymbol()),
                                      span_of(*context.RBRACKET()->getSymbol()));
    for (Grammar::AmountContext* const frame : context.amount())
        result.frames.push_back(number(*frame));
    if (auto* const stride = context.stride()) result.stride = number(*stride->amount());
    return result;
}

ast::Fitted Builder::fitted(Grammar::FittedContext& context) const {
    ast::Fitted result;
    result.method = name(*context.name());
    result.span = span_of(context);
    for (Grammar::FittedArgumentContext* const argument : context.fittedArgument()) {
        ast::Fitted::Argument& added = result.arguments.emplace_back();
        added.key = {text(*argument->start), span_of(*argument->start)};
        if (auto* const of = dynamic_cast<Grammar::PointArgumentContext*>(argument))
            added.value = point(*of->point());
        else if (auto* const where = dynamic_cast<Grammar::FormulaArgumentContext*>(argument))
            added.value = formula(*where->formula()).root;
        else
            added.value =
                number(*dynamic_cast<Grammar::NumberArgumentContext&>(*argument).amount());
    }
    return result;
}

ast::Projection::Numbers Builder::numbers(Grammar::NumbersContext& context) const {
    if (auto* const loaded = context.load()) return load(*loaded);
    return std::visit([](auto&& v) -> ast::Projection::Numbers { return std::move(v); },
                      literal(*context.literal()));
}

std::variant<ast::MatrixLiteral, ast::VectorLiteral> Builder::literal(
    Grammar::LiteralContext& context) const {
    const auto numbers = [this](const std::vector<Grammar::NumberContext*>& contexts) {
        std::vector<ast::Number> result;
        result.reserve(contexts.size());
        for (Grammar::NumberContext* const n : contexts) result.push_back(number(*n));
        return result;
    };
    if (auto* const vector = dynamic_cast<Grammar::VectorLiteralContext*>(&context))
        return ast::VectorLiteral{numbers(vector->number()), span_of(context)};
    ast::MatrixLiteral matrix;
    matrix.span = span_of(context);
    for (Grammar::RowContext* const row :
         dynamic_cast<Grammar::MatrixLiteralContext&>(context).row())
        matrix.rows.push_back(numbers(row->number()));
    return matrix;
}

ast::Name Builder::name(const Grammar::NameContext& context) const {
    return {text(*context.start), span_of(context)};
}

ast::Number Builder::number(const Token& token) const {
    return {text(token), span_of(token), is_name(token) ? text(token) : ""};
}

ast::Number Builder::number(const ParserRuleContext& context) const {
    ast::Number result = number(*context.stop);
    result.span = span_of(context);
    if (context.start != context.stop) result.text.insert(0, "-");
    return result;
}

void Builder::fail(diag::Code code, source::Span span, std::string message, std::string note) {
    diag::Diagnostic diagnostic{code, std::move(message), span};
    if (!note.empty()) diagnostic.note(std::move(note));
    throw SyntaxError{std::move(diagnostic)};
}

void Builder::too_high(source::Span span) {
    fail(diag::Code::nesting_too_deep, span,
         fmt::format("more than {} operators are nested here", kMaxHeight),
         "name parts of it with 'let', or load a matrix of numbers as a target");
}

}  // namespace etlc::parse
