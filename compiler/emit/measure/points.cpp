// Prints what distances are measured from where that is no sample of the step: projected points,
// points of earlier steps, points put together, and sums.

#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "artifacts/embedded.hpp"
#include "emit/context.hpp"
#include "emit/measure/measurements.hpp"
#include "etlmon/reference.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/stored.hpp"

namespace etlc::emit {

using check::Index;
using check::InputType;

std::string scalars_of(const Context& context, const check::Point& point) {
    std::string text;
    for (Index i : point.inputs) text += (text.empty() ? "" : ", ") + sample(context, i);
    return text;
}

std::string elements_of(const Context& context, Index index) {
    const check::Point& point = context.model.points[index];
    if (point.kind == check::Point::Kind::embedding) return sample(context, point.inputs[0]);
    return context.names.point_local.at(index) + (context.on_demand ? "()" : "");
}

namespace {

/// Returns the matrix, and the offset if there is one.
std::string numbers_of(const Context& context, Index projection, bool stored) {
    const auto offset = context.names.offset_array.find(projection);
    const bool has_offset = offset != context.names.offset_array.end();
    if (context.retargetable())
        return context.parameter(plan::Parameter::Kind::matrix, projection) +
               (has_offset ? ", " + context.parameter(plan::Parameter::Kind::offset, projection)
                           : "");
    return fmt::format("{}projections::{}{}", stored ? "rows_ + " : "",
                       context.names.matrix_array.at(projection),
                       has_offset ? ", projections::" + offset->second : "");
}

/// Declares the pointer to the elements of a point.
void print_pointer(Printer& out, const Context& context, Index index, const std::string& elements) {
    const std::string& local = context.names.point_local.at(index);
    print_wrapped(out, context.on_demand
                           ? fmt::format("const etlmon::Lazy {}([&]() noexcept {{ return {}; }});",
                                         local, elements)
                           : fmt::format("const float* const {} = {};", local, elements));
}

/// Prints P(POINT).
void print_projected(Printer& out, const Context& context, Index index) {
    const check::Point& point = context.model.points[index];
    const check::Point& inner = context.model.points[point.inner];
    const check::Projection& map = context.model.projections[point.projection];
    const std::string& buffer = context.names.point_buffer.at(index);
    const bool stored = plan::stored_projection(context.plan, point.projection) != nullptr;
    const std::string numbers = numbers_of(context, point.projection, stored);
    const std::string z = inner.is_vector()
                              ? fmt::format("etlmon::Point<{}>{{{{{}}}}}", inner.dimension,
                                            scalars_of(context, inner))
                              : elements_of(context, point.inner);
    const std::string call =
        fmt::format("{}etlmon::project<{}, {}>({}, {}, {}){}", stored ? "ready() ? " : "", map.rows,
                    map.dimension, z, numbers, buffer, stored ? " : nullptr" : "");
    out.line("float {}[{}];", buffer, point.dimension);
    print_pointer(out, context, index, call);
}

/// Returns the input of an embedding whose samples are kept as float16 or int8; else null.
const check::Input* narrow_input(const Context& context, Index point) {
    if (plan::earlier_element_bytes(context.model, point) == sizeof(float)) return nullptr;
    return &context.model.inputs[context.model.points[point].inputs[0]];
}

/// Prints POINT@n.
void print_delayed(Printer& out, const Context& context, Index index) {
    const check::Point& point = context.model.points[index];
    const std::string at =
        fmt::format("{}.at({})", context.names.earlier_member.at(point.inner), point.steps);
    const check::Input* const narrow = narrow_input(context, point.inner);
    if (narrow == nullptr) return print_pointer(out, context, index, at);
    const std::string& buffer = context.names.point_buffer.at(index);
    const std::string scale =
        narrow->type == InputType::i8 ? float_literal(narrow->scale) + ", " : "";
    out.line("float {}[{}];", buffer, point.dimension);
    print_pointer(out, context, index, fmt::format("etlmon::widened({}, {}{})", at, scale, buffer));
}

/// Prints z - 2 * w.
void print_sum(Printer& out, const Context& context, Index index) {
    const check::Point& point = context.model.points[index];
    const std::string& buffer = context.names.point_buffer.at(index);
    std::string terms;
    for (std::size_t i = 0; i < point.parts.size(); ++i)
        terms += fmt::format("{}{{{}, {}}}", i > 0 ? ", " : "", float_literal(point.factors[i]),
                             elements_of(context, point.parts[i]));
    out.line("float {}[{}];", buffer, point.dimension);
    print_pointer(out, context, index, fmt::format("etlmon::summed({}, {{{}}})", buffer, terms));
}

/// Prints [px, py] as a pointer, and several points as one.
void print_gathered(Printer& out, const Context& context, Index index) {
    const check::Point& point = context.model.points[index];
    const std::string& buffer = context.names.point_buffer.at(index);
    out.line("float {}[{}];", buffer, point.dimension);
    if (point.is_vector())
        return print_pointer(
            out, context, index,
            fmt::format("etlmon::gathered({}, {})", buffer, scalars_of(context, point)));
    std::vector<std::string> parts;
    for (const Index part : point.parts)
        parts.push_back(fmt::format("etlmon::Part<{}>{{{}}}", context.model.points[part].dimension,
                                    elements_of(context, part)));
    print_pointer(out, context, index,
                  fmt::format("etlmon::joined({}, {})", buffer, fmt::join(parts, ", ")));
}

}  // namespace

void print_point(Printer& out, const Context& context, Index index) {
    const check::Point& point = context.model.points[index];
    out.gap();
    const char* const shared = point.is_projected() ? ", shared by all distances from it" : "";
    print_comment(out, "//", point.text + shared, 4);
    if (point.is_projected()) return print_projected(out, context, index);
    if (point.is_delayed()) return print_delayed(out, context, index);
    if (point.is_sum()) return print_sum(out, context, index);
    print_gathered(out, context, index);
}

void print_kept_points(Printer& out, const Context& context) {
    if (context.names.earlier_member.empty()) return;
    out.gap();
    // Outer points first: on demand, one may be computed here from what an inner one has kept.
    const auto& kept = context.names.earlier_member;
    for (auto member = kept.rbegin(); member != kept.rend(); ++member) {
        const auto& [point, name] = *member;
        const std::string elements = elements_of(context, point);
        const check::Input* const narrow = narrow_input(context, point);
        if (narrow == nullptr) {
            out.line("{}.push({});", name, elements);
            continue;
        }
        const std::string sample = fmt::format("in.{}.data()", narrow->name);
        const std::string& fresh =
            context.names.input_buffer.at(context.model.points[point].inputs[0]);
        print_wrapped(
            out, narrow->hold == 0
                     ? fmt::format("{}.push({} != nullptr ? {} : nullptr);", name, elements, sample)
                     : fmt::format("{}.push({} == {} ? {} : nullptr, {} != nullptr);", name,
                                   elements, fresh, sample, elements));
    }
    out.gap();
}

std::vector<Member> earlier_members(const Context& context) {
    std::vector<Member> result;
    for (const plan::EarlierPoint& earlier :
         plan::earlier_points(context.model, context.plan.distances)) {
        const check::Point& point = context.model.points[earlier.point];
        const check::Input* const narrow = narrow_input(context, earlier.point);
        const char* const type = narrow == nullptr               ? "float"
                                 : narrow->type == InputType::i8 ? "int8_t"
                                                                 : "uint16_t";
        const std::string& name = context.names.earlier_member.at(earlier.point);
        result.push_back(
            {fmt::format("etlmon::Earlier<{}, {}, {}>", type, point.dimension, earlier.steps), name,
             fmt::format("{} of the last {}", point.text,
                         earlier.steps == 1 ? "step" : fmt::format("{} steps", earlier.steps)),
             name + ".reset();", ""});
    }
    return result;
}

// Prints what tells whether a machine has the encoders that calibration had.

namespace {

using check::Encoder;

std::size_t dimension_of(const Encoder& encoder) {
    return encoder.references.size() / embedded::kReferenceFrames;
}

/// Prints "{length, {sums}},", an etlmon::Reference.
void print_sketch(Printer& out, const float* embedding, std::size_t dimension) {
    double squares = 0;
    std::array<double, 16> sums{};
    for (std::uint32_t j = 0; j < dimension; ++j) {
        const double element = embedding[j];
        const std::uint32_t signs = etlmon::detail::signs_of(j);
        squares += element * element;
        for (std::uint32_t k = 0; k < sums.size(); ++k)
            sums[k] += (signs >> k & 1U) != 0 ? -element : element;
    }
    const auto length = static_cast<float>(std::sqrt(squares));
    std::string line = fmt::format("{{{},", float_literal(length > 0 ? length : 1));
    for (std::size_t k = 0; k < sums.size(); ++k) {
        const bool is_last = k + 1 == sums.size();
        const std::string number = (k == 0 ? "{" : "") +
                                   float_literal(static_cast<float>(sums[k])) +
                                   (is_last ? "}}," : ",");
        if (out.column() + line.size() + 1 + number.size() > kLineWidth) {
            out.line(line);
            line = " ";
        }
        line += " " + number;
    }
    out.line(line);
}

/// Returns "encoder_agrees", with the name of the encoder where there are several.
std::string function_of(const Context& context, const Encoder& encoder, std::string_view what) {
    const bool is_only = context.model.encoders.size() == 1;
    return fmt::format("encoder_{}{}{}", what, is_only ? "" : "_", is_only ? "" : encoder.name);
}

}  // namespace

bool has_references(const Context& context) {
    for (const Encoder& encoder : context.model.encoders)
        if (!encoder.references.empty()) return context.with_references;
    return false;
}

void print_references(Printer& out, const Context& context) {
    if (!has_references(context)) return;
    print_doc(out,
              "Sketches of what each encoder made of the reference frames when it was run for "
              "calibration: the length of the embedding, and 16 sums of its elements.");
    out.line("namespace references {");
    for (const Encoder& encoder : context.model.encoders) {
        if (encoder.references.empty()) continue;
        out.open(fmt::format("inline constexpr etlmon::Reference {}[{}] = {{", encoder.name,
                             embedded::kReferenceFrames));
        const std::size_t dimension = dimension_of(encoder);
        for (std::uint32_t frame = 0; frame < embedded::kReferenceFrames; ++frame)
            print_sketch(out, &encoder.references[frame * dimension], dimension);
        out.close("};");
    }
    out.line("}  // namespace references");
    out.line();
}

void print_reference_interface(Printer& out, const Context& context) {
    if (!has_references(context)) return;
    print_doc(out, "The frames that 'etlc embed --write-reference FOLDER' writes.");
    out.line("static constexpr uint32_t kReferenceFrames = {};", embedded::kReferenceFrames);
    for (const Encoder& encoder : context.model.encoders) {
        if (encoder.references.empty()) continue;
        const std::string difference = function_of(context, encoder, "difference");
        const std::string vector = fmt::format("etlmon::Vector<float, {}>", dimension_of(encoder));
        print_doc(out, fmt::format("Estimates how far `z`, the embedding of reference frame "
                                   "`frame`, is from the one that '{}' made for calibration, "
                                   "relative to its length; FLT_MAX where that cannot be said.",
                                   encoder.name));
        out.open(fmt::format("static float {}(uint32_t frame, const {}& z) noexcept {{", difference,
                             vector));
        out.line("if (frame >= kReferenceFrames) return etlmon::kNoReference;");
        out.line("return etlmon::difference_from(references::{}[frame], z);", encoder.name);
        out.close();
        print_doc(out,
                  "Returns whether they are the same but for the rounding of float32. Ask for each "
                  "frame before the first step: verdicts mean nothing with another encoder.");
        print_wrapped(out, fmt::format("static bool {}(uint32_t frame, const {}& z, "
                                       "float tolerance = 1e-3f) noexcept {{",
                                       function_of(context, encoder, "agrees"), vector));
        out.indent();
        out.line("return {}(frame, z) <= tolerance;", difference);
        out.close();
    }
    out.line();
}

}  // namespace etlc::emit
