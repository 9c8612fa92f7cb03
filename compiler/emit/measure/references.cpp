// Prints what tells whether a machine has the encoders that calibration had.
#include <array>
#include <cmath>

#include "artifacts/embedded.hpp"
#include "emit/context.hpp"
#include "etlmon/reference.hpp"

namespace etlc::emit {

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
