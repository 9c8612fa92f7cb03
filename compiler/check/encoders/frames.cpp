// Reads frames of a recording as rows: frames("ep.npz", "z", [120, 180]).
#include "check/encoders/encoded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "check/encoders/encoders.hpp"
#include "check/matrices/matrices.hpp"
#include "check/numbers/decimal.hpp"
#include "data/arrays/array.hpp"
#include "data/files/file.hpp"
#include "data/traces/trace.hpp"

namespace etlc::check {

namespace {

using diag::Code;

/// Steps of a recording are numbered from 0 in 32 bits.
constexpr std::uint64_t kMaxFrame = kMaxBound;
/// Limit on the frames of one declaration.
constexpr std::uint64_t kMaxFrames = 1U << 20U;

std::optional<std::uint64_t> whole(Context& c, const ast::Number& number, std::uint64_t least) {
    const auto value = Decimal::parse(number.text).whole(kMaxFrame);
    if (value && *value >= least) return value;
    return c.no_value(
        Code::frames_form, number.span,
        fmt::format("{}; expected a whole number of at least {}", shown(number), least));
}

const Input* input_of(Context& c, const ast::Frames& written) {
    const ast::Name name{written.key, written.key_span};
    const Index index = resolve(c, name, NameKind::input);
    if (index == kNone) return nullptr;
    const Input& input = c.model.inputs[index];
    if (input.is_embedding()) return &input;
    c.report(Code::frames_form, written.key_span,
             fmt::format("'{}' is not an embedding, but the rows of a target are", written.key));
    return nullptr;
}

/// Converts a sample to float32, scaled if the input is i8; false, with an error, if it is missing.
bool take(Context& c, const ast::Frames& written, const Input& input, std::uint64_t frame,
          const data::Sample& sample, std::vector<float>& row) {
    row.clear();
    for (const double x : sample.values[0])
        row.push_back(static_cast<float>(
            input.type == InputType::i8 ? x * static_cast<double>(input.scale) : x));
    const bool finite =
        std::all_of(row.begin(), row.end(), [](float x) { return std::isfinite(x); });
    if (sample.present[0] && finite) return true;
    return c.refuse(Code::no_such_frame, written.span,
                    fmt::format("{}: '{}' is missing or not finite at step {}", written.path,
                                written.key, frame));
}

void report(Context& c, const ast::Frames& written, const std::string& path,
            const diag::Failure& failure) {
    diag::Diagnostic diagnostic = data::in_file(failure, path);
    diagnostic.span = written.span;
    c.report_data(std::move(diagnostic), !exists(data::trace_file(path)));
}

}  // namespace

std::optional<std::vector<std::uint64_t>> frames_of(Context& c, const ast::Frames& written) {
    std::vector<std::uint64_t> listed;
    for (const ast::Number& number : written.frames) {
        const auto frame = whole(c, number, 0);
        if (!frame) return std::nullopt;
        listed.push_back(*frame);
    }
    if (!written.stride) return listed;
    const auto stride = whole(c, *written.stride, 1);
    if (!stride) return std::nullopt;
    if (listed.size() != 2 || listed[0] > listed[1])
        return c.no_value(Code::frames_form, written.frames_span,
                          "with a stride, expected the first and the last frame: [10, 50]");
    if ((listed[1] - listed[0]) / *stride >= kMaxFrames)
        return c.no_value(Code::frames_form, written.frames_span,
                          fmt::format("more than {} frames", kMaxFrames));
    std::vector<std::uint64_t> frames;
    for (std::uint64_t frame = listed[0]; frame <= listed[1]; frame += *stride)
        frames.push_back(frame);
    return frames;
}

std::optional<Matrix> read_frames(Context& c, const ast::Frames& written) {
    const Input* const input = input_of(c, written);
    const auto frames = frames_of(c, written);
    if (input == nullptr || !frames) return std::nullopt;
    const std::string path = beside_spec(c, written.path);
    c.dependencies.insert(data::trace_file(path));
    const auto trace =
        c.options.open_trace(path, {{input->name, data::Channel::Kind::vector, input->dimension}});
    if (!trace) return report(c, written, path, trace.failure()), std::nullopt;
    if (input->encoder != kNone) {
        const auto marks = embedded::read_marks(path);
        if (!marks) return report(c, written, path, marks.failure()), std::nullopt;
        if (const auto other = other_encoder(c.model, *input, input->name, *marks))
            return report(c, written, path, *other), std::nullopt;
        if (is_unmarked(*input, input->name, *marks))
            explain_unmarked(c.report(
                Code::unmarked_episode, written.span,
                fmt::format("{} does not say which encoder made '{}'", written.path, input->name)));
    }

    Matrix matrix;
    matrix.rows = static_cast<std::uint32_t>(frames->size());
    matrix.columns = input->dimension;
    matrix.values.resize(std::size_t{matrix.rows} * matrix.columns);
    std::multimap<std::uint64_t, std::size_t> rows_of;  // by step
    for (std::size_t i = 0; i < frames->size(); ++i) rows_of.emplace((*frames)[i], i);
    const std::uint64_t last = rows_of.rbegin()->first;
    data::Sample sample;
    std::vector<float> row;
    for (std::uint64_t step = 0; step <= last; ++step) {
        const auto more = (*trace)->next(sample);
        if (!more) return report(c, written, path, more.failure()), std::nullopt;
        if (!*more)
            return c.no_value(Code::no_such_frame, written.frames_span,
                              fmt::format("{} has {}; there is no step {} (from 0)", written.path,
                                          diag::counted(step, "step"), last));
        const auto [first, end] = rows_of.equal_range(step);
        for (auto at = first; at != end; ++at) {
            if (!take(c, written, *input, step, sample, row)) return std::nullopt;
            std::copy(
                row.begin(), row.end(),
                matrix.values.begin() + static_cast<std::ptrdiff_t>(at->second * matrix.columns));
        }
    }
    matrix.origin = fmt::format("{}:{}", written.path, written.key);
    matrix.path = path;
    matrix.hash = data::content_hash({matrix.rows, matrix.columns}, matrix.values);
    return matrix;
}

}  // namespace etlc::check
