// Checks inputs: types, ranges, hold, staleness.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "check/context/context.hpp"
#include "check/numbers/decimal.hpp"
#include "check/time/time.hpp"
#include "data/text/subtask_name.hpp"

namespace etlc::check {

namespace {

using diag::Code;

/// Limit on the steps for which a sample may replace later ones.
constexpr std::uint32_t kMaxHold = kMaxBound;
/// Limit on the equal samples in a row that may count.
constexpr std::uint32_t kMaxRepeats = kMaxBound;

/// Checks one declaration, whose names differ in nothing else.
class InputCheck {
public:
    InputCheck(Context& context, const ast::Input& declaration)
        : c_(context), declaration_(declaration) {}

    Input run() {
        Input input;
        input.type = type();
        input.dimension = dimension();
        input.scale = scale();
        set_range(input);
        input.hold = hold();
        input.encoder = encoder(input);
        input.missing = missing(input.type);
        input.stale_after = stale_after(input.type);
        return input;
    }

    bool broken() const { return broken_; }

private:
    diag::Diagnostic& report(Code code, Span span, std::string message) {
        broken_ = true;
        return c_.report(code, span, std::move(message));
    }

    bool is_embedding() const { return declaration_.type.dimension.has_value(); }

    InputType type() const {
        switch (declaration_.type.kind) {
            case ast::Type::Kind::f32: return is_embedding() ? InputType::f32 : InputType::scalar;
            case ast::Type::Kind::f16: return InputType::f16;
            case ast::Type::Kind::i8: return InputType::i8;
            case ast::Type::Kind::boolean: return InputType::boolean;
        }
        return InputType::scalar;
    }

    std::uint32_t dimension() {
        if (!is_embedding()) return 1;
        const ast::Number& number = *declaration_.type.dimension;
        const auto value = Decimal::parse(number.text).whole(kMaxDimension);
        if (value && *value > 0) return static_cast<std::uint32_t>(*value);
        report(Code::dimension_out_of_range, number.span,
               fmt::format("the dimension {} is not a whole number from 1 to {}", shown(number),
                           kMaxDimension));
        return 1;
    }

    float scale() {
        const ast::Type& type = declaration_.type;
        if (type.scale) return positive_scale(*type.scale);
        if (type.kind == ast::Type::Kind::i8)
            report(Code::scale_form, type.span,
                   "an i8 embedding without a scale; expected i8[D] scale S, where value = S x "
                   "integer");
        return 1.0F;
    }

    float positive_scale(const ast::Number& number) {
        if (!Decimal::parse(number.text).is_positive()) {
            report(Code::scale_form, number.span,
                   fmt::format("the scale is {}; expected a positive number", shown(number)));
            return 1.0F;
        }
        const std::size_t errors = c_.sink.errors();
        const float value = number32(c_, number);
        if (c_.sink.errors() > errors) broken_ = true;
        if (std::isfinite(value * 128.0F)) return value;
        report(Code::scale_form, number.span,
               fmt::format("128 times the scale {} exceeds float32", shown(number)));
        return 1.0F;
    }

    void set_range(Input& input) {
        if (!declaration_.range) return;
        const ast::Range& range = *declaration_.range;
        if (input.type != InputType::scalar) {
            report(Code::range_form, range.span,
                   fmt::format("only f32 scalars have a range; this input is {}",
                               input.type == InputType::boolean ? "a bool" : "an embedding"));
            return;
        }
        input.has_range = true;
        const bool low_is_infinite = range.low.text == "inf" || range.low.text == "-inf";
        const bool high_is_infinite = range.high.text == "inf" || range.high.text == "-inf";
        const bool reversed = range.low.text == "inf" || range.high.text == "-inf" ||
                              (!low_is_infinite && !high_is_infinite &&
                               Decimal::parse(range.low.text) > Decimal::parse(range.high.text));
        if (reversed) {
            report(Code::range_form, range.span,
                   fmt::format("the range [{}, {}] contains no number", shown(range.low),
                               shown(range.high)));
            return;
        }
        if (!low_is_infinite) check_size(range.low);
        if (!high_is_infinite) check_size(range.high);
        input.range = {round_down(range.low.text), round_up(range.high.text)};
    }

    void check_size(const ast::Number& number) {
        float value = 0;
        if (to_float(number.text, value) != Fit::overflow) return;
        report(Code::number_overflow, number.span,
               fmt::format("{} exceeds the largest float32; write {}inf for an open end",
                           shown(number), number.text.starts_with('-') ? "-" : ""));
    }

    /// Only bools have a value for missing samples; comparisons of numbers may have one.
    std::optional<bool> missing(InputType type) {
        if (declaration_.missing && type != InputType::boolean)
            report(Code::missing_form, declaration_.span,
                   "only a bool can have a value for missing samples")
                .note("give it in the predicate instead: predicate ... missing false;");
        return declaration_.missing;
    }

    std::uint32_t hold() {
        if (!declaration_.hold) return 0;
        const ast::Bound& hold = *declaration_.hold;
        if (!is_duration(hold)) {
            // A number without a unit has always meant steps here, never seconds.
            const auto steps = Decimal::parse(hold.number.text).whole(kMaxHold);
            if (!steps)
                report(Code::hold_out_of_range, hold.span,
                       fmt::format("hold {} is not a whole number of steps from 0 to {}",
                                   shown(hold.number), kMaxHold));
            if (hold.unit == ast::kStepsUnit) c_.steps_on_purpose = true;
            return static_cast<std::uint32_t>(steps.value_or(0));
        }
        const auto steps = bound_steps(c_, hold);
        if (!steps) broken_ = true;
        return steps.value_or(0);
    }

    /// A bool may well stay as it is for hours, so it has no such limit.
    std::uint32_t stale_after(InputType type) {
        if (!declaration_.stale) return 0;
        const ast::Bound& most = *declaration_.stale;
        if (type == InputType::boolean) {
            report(Code::stale_form, most.span,
                   "only an embedding or a scalar can be stale; this input is a bool");
            return 0;
        }
        if (is_duration(most)) {
            const auto steps = bound_steps(c_, most);
            if (!steps) broken_ = true;
            if (steps == 0U) report_stale(most);
            return steps.value_or(0);
        }
        const auto steps = Decimal::parse(most.number.text).whole(kMaxRepeats);
        if (!steps || *steps == 0) report_stale(most);
        if (most.unit == ast::kStepsUnit) c_.steps_on_purpose = true;
        return static_cast<std::uint32_t>(steps.value_or(0));
    }

    void report_stale(const ast::Bound& most) {
        report(Code::stale_form, most.span,
               fmt::format("stale after {} is not a whole number of steps from 1 to {}",
                           with_unit(shown(most.number), most.unit), kMaxRepeats));
    }

    /// All inputs of an encoder have the dimension of its embeddings.
    Index encoder(const Input& input) {
        if (!declaration_.encoder) return kNone;
        const Index index = resolve(c_, *declaration_.encoder, NameKind::encoder);
        if (index == kNone) return kNone;
        if (input.type != InputType::f32) {
            report(Code::encoder_use, declaration_.encoder->span,
                   fmt::format(
                       "an encoder gives embeddings in float32; expected an input f32[D], found {}",
                       c_.file.text(declaration_.type.span)));
            return kNone;
        }
        Encoder& encoder = c_.model.encoders[index];
        if (encoder.dimension != 0 && encoder.dimension != input.dimension)
            report(Code::embedding_dimension, declaration_.type.span,
                   fmt::format("this input has dimension {}, another input by '{}' has {}",
                               input.dimension, encoder.name, encoder.dimension));
        encoder.dimension = input.dimension;
        return index;
    }

    Context& c_;
    const ast::Input& declaration_;
    bool broken_ = false;
};

/// Adds the bool inputs by which truths ask for subtasks: recordings have them.
void add_subtasks(Context& c) {
    std::vector<const ast::Formula*> pending;
    for_each_declaration<ast::Truth>(
        c.spec, [&](const ast::Truth& truth, Index) { pending.push_back(truth.formula.get()); });
    while (!pending.empty()) {
        const ast::Formula& next = *pending.back();
        pending.pop_back();
        for (const ast::FormulaPtr& operand : next.operands) pending.push_back(operand.get());
        for (const ast::ExprPtr* side : {&next.left, &next.right})
            if (*side && (*side)->past && (*side)->past->formula)
                pending.push_back((*side)->past->formula.get());
        if (!data::subtask_name(next.name) || c.scope.find(next.name) != nullptr) continue;
        c.scope.declare(NameKind::input, {next.name, next.span});
        Input added;
        added.name = next.name;
        added.span = next.span;
        added.type = InputType::boolean;
        c.model.inputs.push_back(std::move(added));
    }
}

}  // namespace

void check_inputs(Context& c) {
    for_each_declaration<ast::Input>(c.spec, [&](const ast::Input& declaration, Index) {
        InputCheck check(c, declaration);
        Input input = check.run();
        for (const ast::Name& name : declaration.names) {
            input.name = name.text;
            input.span = name.span;
            c.scope.entity(NameKind::input, static_cast<Index>(c.model.inputs.size())).broken =
                check.broken();
            c.model.inputs.push_back(input);
        }
    });
    add_subtasks(c);
}

}  // namespace etlc::check
