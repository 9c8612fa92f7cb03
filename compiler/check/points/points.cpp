#include "check/points/points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "check/numbers/range.hpp"
#include "check/time/time.hpp"

namespace etlc::check {

namespace {

using diag::Code;

Index add(Context& c, Point point) {
    const auto [at, is_new] =
        c.point_of_text.try_emplace(point.text, static_cast<Index>(c.model.points.size()));
    if (is_new) c.model.points.push_back(std::move(point));
    return at->second;
}

/// Returns the input of that name; kNone after an error. `in_brackets`: a scalar is expected too.
Index input_of(Context& c, const ast::Name& name, bool in_brackets) {
    const Index index = resolve(c, name, NameKind::input);
    if (index == kNone) return kNone;
    const Input& input = c.model.inputs[index];
    const bool is_scalar = input.type == InputType::scalar;
    if (input.is_embedding() || (in_brackets && is_scalar)) return index;
    auto& error = c.report(
        Code::point_form, name.span,
        fmt::format(
            "'{}' is {}; expected {}", name.text, is_scalar ? "a scalar" : "a bool",
            in_brackets ? "a scalar or an embedding" : "an embedding, or a vector of scalars"));
    if (is_scalar) error.note(fmt::format("for a point of one dimension write [{}]", name.text));
    return kNone;
}

Index embedding(Context& c, Index input) {
    Point point;
    point.kind = Point::Kind::embedding;
    point.inputs = {input};
    point.dimension = c.model.inputs[input].dimension;
    point.text = c.model.inputs[input].name;
    return add(c, std::move(point));
}

Index vector(Context& c, const std::vector<Index>& scalars) {
    Point point;
    point.kind = Point::Kind::scalars;
    point.inputs = scalars;
    point.dimension = static_cast<std::uint32_t>(scalars.size());
    for (const Index input : scalars)
        point.text += (point.text.empty() ? "" : ", ") + c.model.inputs[input].name;
    point.text = fmt::format("[{}]", point.text);
    return add(c, std::move(point));
}

/// Returns several points as one, without nested ones; kNone if there is none.
Index joined(Context& c, const std::vector<Index>& parts) {
    Point point;
    point.kind = Point::Kind::joined;
    for (const Index part : parts) {
        if (part == kNone) return kNone;
        const Point& one = c.model.points[part];
        point.inputs.insert(point.inputs.end(), one.inputs.begin(), one.inputs.end());
        point.dimension += one.dimension;
        if (one.is_joined())
            point.parts.insert(point.parts.end(), one.parts.begin(), one.parts.end());
        else
            point.parts.push_back(part);
    }
    for (const Index part : point.parts)
        point.text += (point.text.empty() ? "" : ", ") + c.model.points[part].text;
    point.text = fmt::format("[{}]", point.text);
    return add(c, std::move(point));
}

/// Returns the sum with other parts. A single point is itself.
Index summed(Context& c, const Point& like, const std::vector<Index>& parts) {
    if (parts.size() == 1 && like.factors[0] == 1) return parts[0];
    Point sum;
    sum.kind = Point::Kind::sum;
    sum.parts = parts;
    sum.factors = like.factors;
    sum.dimension = c.model.points[parts[0]].dimension;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Point& part = c.model.points[parts[i]];
        sum.inputs.insert(sum.inputs.end(), part.inputs.begin(), part.inputs.end());
        const bool negative = std::signbit(sum.factors[i]);
        const float size = std::abs(sum.factors[i]);
        sum.text += i == 0 ? (negative ? "-" : "") : (negative ? " - " : " + ");
        if (size != 1) sum.text += fmt::format("{} * ", size);
        sum.text += part.is_sum() ? fmt::format("({})", part.text) : part.text;
    }
    return add(c, std::move(sum));
}

/// Returns points put together, or their sum, with other parts.
Index of_parts(Context& c, const Point& like, const std::vector<Index>& parts) {
    return like.is_sum() ? summed(c, like, parts) : joined(c, parts);
}

/// Returns the point as it was `steps` ago. A delay goes inside of what is put together or added,
/// and is added to another one.
Index ago(Context& c, Index index, std::uint32_t steps) {
    if (index == kNone || steps == 0) return index;
    const Point inner = c.model.points[index];  // a copy: `points` grows
    if (!inner.parts.empty()) {
        std::vector<Index> parts;
        for (const Index part : inner.parts) parts.push_back(ago(c, part, steps));
        return of_parts(c, inner, parts);
    }
    if (inner.is_delayed()) return ago(c, inner.inner, inner.steps + steps);
    Point point;
    point.kind = Point::Kind::delayed;
    point.inputs = inner.inputs;
    point.dimension = inner.dimension;
    point.inner = index;
    point.steps = steps;
    point.text = fmt::format("{}@{}", inner.text, steps);
    return add(c, std::move(point));
}

/// P(POINT). Of P(z@3), P(z) becomes a point, too: calibration compares rows with it.
Index through(Context& c, Index projection, Index inner) {
    const Index now = as_of_now(c.model, inner);
    if (now != kNone && now != inner) through(c, projection, now);
    const Projection& map = c.model.projections[projection];
    Point point;
    point.kind = Point::Kind::projected;
    point.inputs = c.model.points[inner].inputs;
    point.dimension = map.rows;
    point.projection = projection;
    point.inner = inner;
    point.text = fmt::format("{}({})", map.name, c.model.points[inner].text);
    return add(c, std::move(point));
}

Index projected(Context& c, const ast::Name& name, Index inner, Span span) {
    const Index index = resolve(c, name, NameKind::projection);
    if (index == kNone || inner == kNone) return kNone;
    if (index >= c.model.projections.size()) {
        c.report(Code::projection_order, name.span,
                 fmt::format(
                     "'{}' is declared later; a projection can be fitted only through earlier ones",
                     name.text))
            .note(c.scope.entity(NameKind::projection, index).span,
                  fmt::format("'{}' is declared here", name.text));
        return kNone;
    }
    const Projection& projection = c.model.projections[index];
    const Point& from = c.model.points[inner];
    if (projection.dimension != from.dimension) {
        c.report(Code::dimension_mismatch, span,
                 fmt::format("{} has dimension {}, projection '{}' takes points of dimension {}",
                             from.text, from.dimension, name.text, projection.dimension))
            .note(projection.span,
                  fmt::format("'{}' is {} x {}", name.text, projection.rows, projection.dimension));
        return kNone;
    }
    return through(c, index, inner);
}

/// Returns what a scalar in brackets was, some steps ago, or a point.
struct Element {
    Index scalar = kNone;
    Index point = kNone;
    std::uint32_t steps = 0;
};

/// Returns the sum of the delays; nothing after an error.
std::optional<std::uint32_t> sum_of(Context& c, const std::vector<ast::Bound>& delays) {
    std::uint64_t sum = 0;
    for (const ast::Bound& delay : delays) {
        const auto steps = steps_ago(c, delay);
        if (!steps) return std::nullopt;
        sum += *steps;
    }
    if (sum <= kMaxPast) return static_cast<std::uint32_t>(sum);
    return c.no_value(Code::bound_too_large, delays.back().span,
                      fmt::format("{} steps ago; the longest time is {} steps", sum, kMaxPast));
}

/// Returns the point as it was `steps` ago, or kNone after reporting that this is too long ago.
Index limited_ago(Context& c, Index index, std::uint32_t steps, Span span) {
    const Index point = ago(c, index, steps);
    const std::uint32_t longest = point == kNone ? 0 : longest_delay(c.model, point);
    if (longest <= kMaxPast) return point;
    c.report(Code::bound_too_large, span,
             fmt::format("{} steps ago; the longest time is {} steps", longest, kMaxPast));
    return kNone;
}

/// Returns z - 2 * w; kNone after an error.
Index sum_of(Context& c, const ast::Point& written) {
    Point sum;
    std::vector<Index> parts;
    const std::size_t errors = c.sink.errors();
    for (std::size_t i = 0; i < written.parts.size(); ++i) {
        parts.push_back(check_point(c, written.parts[i]));
        sum.factors.push_back(number32(c, written.factors[i]));
        if (i > 0 && parts[0] != kNone && parts[i] != kNone)
            check_same_space(c, parts[0], parts[i], written.span);
    }
    const bool good = c.sink.errors() == errors && !std::count(parts.begin(), parts.end(), kNone);
    return good ? summed(c, sum, parts) : kNone;
}

/// Returns the elements of [a, b@3, z]; nothing after an error.
std::optional<std::vector<Element>> elements_of(Context& c, const ast::Point& vector) {
    std::vector<Element> elements;
    bool good = true;
    for (const ast::Point& part : vector.parts) {
        Element element;
        const bool is_input = !part.is_vector && part.parts.empty();
        const Index input = is_input ? input_of(c, part.name, true) : kNone;
        if (input != kNone && c.model.inputs[input].type == InputType::scalar) {
            const auto steps = sum_of(c, part.delays);
            if (steps) element = {input, kNone, *steps};
        } else if (input != kNone || !is_input) {
            element.point = check_point(c, part);
        }
        good = good && (element.scalar != kNone || element.point != kNone);
        elements.push_back(element);
    }
    return good ? std::optional(std::move(elements)) : std::nullopt;
}

/// Returns the point, or kNone after reporting that its dimension is too large.
Index limited(Context& c, Index index, Span span) {
    const Point& point = c.model.points[index];
    if (point.dimension <= kMaxDimension) return index;
    c.report(Code::dimension_out_of_range, span,
             fmt::format("{} has dimension {}, the largest is {}", point.text, point.dimension,
                         kMaxDimension));
    return kNone;
}

/// Scalars of the same time that follow each other are one vector.
Index in_brackets(Context& c, const ast::Point& written) {
    const auto elements = elements_of(c, written);
    if (!elements) return kNone;
    std::vector<Index> parts;
    for (std::size_t i = 0; i < elements->size();) {
        const Element& first = (*elements)[i];
        std::vector<Index> scalars;
        for (; i < elements->size() && (*elements)[i].scalar != kNone &&
               (*elements)[i].steps == first.steps;
             ++i)
            scalars.push_back((*elements)[i].scalar);
        if (!scalars.empty()) {
            parts.push_back(ago(c, vector(c, scalars), first.steps));
            continue;
        }
        parts.push_back(first.point);
        ++i;
    }
    if (parts.size() > 1) return limited(c, joined(c, parts), written.span);
    const Point& only = c.model.points[parts[0]];
    if (only.kind != Point::Kind::embedding) return parts[0];
    c.report(Code::point_form, written.span,
             fmt::format("'{}' is an embedding; expected the scalars of a vector", only.text))
        .note(fmt::format("write an embedding without brackets: {}", only.text));
    return kNone;
}

/// "the vector", "'z'", "Q(z)"
std::string words_of(const Point& point) {
    if (point.is_projected()) return point.text;
    if (point.is_vector() || point.is_joined()) return "the vector";
    if (point.is_sum()) return point.text;
    return fmt::format("'{}'", point.text);
}

/// `there`: the space of the point.
void report_wrong_space(Context& c, const Target& target, Index of, const Point& point,
                        const Point& there, Span span) {
    if (of == kNone) {
        c.report(Code::wrong_space, span,
                 fmt::format("target '{}' is in the space of the inputs, but {} is in that of {}",
                             target.name, words_of(point), there.text))
            .note(fmt::format("if its rows are in the space of {}, write: target {} = ... of {};",
                              there.text, target.name, there.text));
        return;
    }
    const std::string& space = c.model.points[of].text;
    c.report(Code::wrong_space, span,
             fmt::format("target '{}' is in the space of {}, but {} is not", target.name, space,
                         words_of(point)))
        .note(target.span, fmt::format("'{}' is declared here", target.name))
        .note(fmt::format("measure from {}, or from a projection of it", space));
}

void report_dimensions(Context& c, const Target& target, const Point& point, const Point& whole,
                       Span span) {
    auto& error =
        c.report(Code::dimension_mismatch, span,
                 fmt::format("{} has dimension {}, target '{}' has dimension {}", words_of(point),
                             point.dimension, target.name, target.dimension));
    if (point.kind == Point::Kind::embedding)
        error.note(c.model.inputs[point.inputs[0]].span,
                   fmt::format("{} is declared here", words_of(point)));
    error.note(target.span, fmt::format("'{}' has {} of {}", target.name,
                                        diag::counted(target.rows, "row"), target.dimension));
    if (whole.is_projected() && !point.is_projected())
        error.note(fmt::format("if the rows are projected already, write: target {} = ... of {};",
                               target.name, whole.text));
}

/// Returns the shortest delay of the inputs that a point is made of.
std::uint32_t shortest_delay(const Model& model, Index index) {
    const Point& point = model.points[index];
    if (point.is_projected()) return shortest_delay(model, point.inner);
    if (point.is_delayed()) return point.steps + shortest_delay(model, point.inner);
    std::uint32_t shortest = point.parts.empty() ? 0 : kMaxBound;
    for (const Index part : point.parts) shortest = std::min(shortest, shortest_delay(model, part));
    return shortest;
}

/// Returns what will be the point `steps` later, at most its shortest delay.
Index later(Context& c, Index index, std::uint32_t steps) {
    if (steps == 0) return index;
    const Point point = c.model.points[index];  // a copy: `points` grows
    if (point.is_projected()) return through(c, point.projection, later(c, point.inner, steps));
    if (point.is_delayed()) {
        const std::uint32_t own = std::min(steps, point.steps);
        return ago(c, later(c, point.inner, steps - own), point.steps - own);
    }
    std::vector<Index> parts;
    for (const Index part : point.parts) parts.push_back(later(c, part, steps));
    return of_parts(c, point, parts);
}

/// Returns the point with the first of its parts in place of each sum, no later than the sum.
Index without_sums(Context& c, Index index) {
    const Point point = c.model.points[index];  // a copy: `points` grows
    if (point.is_sum()) return ago(c, space_of(c, point.parts[0]), shortest_delay(c.model, index));
    if (point.is_projected()) return through(c, point.projection, without_sums(c, point.inner));
    if (point.is_delayed()) return ago(c, without_sums(c, point.inner), point.steps);
    if (point.parts.empty()) return index;
    std::vector<Index> parts;
    for (const Index part : point.parts) parts.push_back(without_sums(c, part));
    return joined(c, parts);
}

/// Whether both are declared to be in one space.
bool is_declared_same(const Model& model, const Point& a, const Point& b) {
    if (!a.is_projected() || !b.is_projected()) return false;
    const std::string& space = model.projections[a.projection].space;
    return !space.empty() && space == model.projections[b.projection].space;
}

/// Returns the inputs that a point is made of, in the order of its elements; of a sum those of its
/// first part.
std::vector<Index> inputs_of(const Model& model, Index index) {
    const Point& point = model.points[index];
    if (point.inner != kNone) return inputs_of(model, point.inner);
    if (point.is_sum()) return inputs_of(model, point.parts[0]);
    std::vector<Index> all = point.is_joined() ? std::vector<Index>{} : point.inputs;
    for (const Index part : point.parts)
        for (const Index input : inputs_of(model, part)) all.push_back(input);
    return all;
}

}  // namespace

std::optional<std::uint32_t> steps_ago(Context& c, const ast::Bound& time) {
    const auto steps = bound_steps(c, time);
    if (!steps) return std::nullopt;
    if (*steps > 0 && *steps != kUnbounded) return steps;
    const std::string written{c.file.text(time.span)};
    c.report(Code::past_form, time.span,
             fmt::format("{} is no time ago; expected at least one step, as in '@1' or '@0.5 s'",
                         written.empty() ? shown(time.number) : written));
    return std::nullopt;
}

Index check_point(Context& c, const ast::Point& written) {
    Index point = kNone;
    if (written.is_vector) {
        point = in_brackets(c, written);
    } else if (!written.factors.empty()) {
        point = sum_of(c, written);
    } else if (!written.parts.empty()) {
        point = projected(c, written.name, check_point(c, written.parts[0]), written.span);
    } else {
        const Index input = input_of(c, written.name, false);
        if (input != kNone) point = embedding(c, input);
    }
    const auto steps = sum_of(c, written.delays);
    return steps ? limited_ago(c, point, *steps, written.span) : kNone;
}

Index without_delay(Context& c, Index point) {
    return later(c, point, shortest_delay(c.model, point));
}

Index space_of(Context& c, Index point) {
    return without_delay(c, without_sums(c, point));
}

bool is_same_space(const Model& model, Index a, Index b) {
    for (Index* at : {&a, &b})
        while (model.points[*at].is_delayed() || model.points[*at].is_sum())
            *at = model.points[*at].is_sum() ? model.points[*at].parts[0] : model.points[*at].inner;
    const Point& left = model.points[a];
    const Point& right = model.points[b];
    if (is_declared_same(model, left, right)) return true;
    if (left.dimension != right.dimension || left.projection != right.projection) return false;
    if (left.is_projected()) return is_same_space(model, left.inner, right.inner);
    if (!left.is_joined() && !right.is_joined()) return true;
    return std::equal(left.parts.begin(), left.parts.end(), right.parts.begin(), right.parts.end(),
                      [&](Index one, Index other) { return is_same_space(model, one, other); });
}

bool is_by(Context& c, const Input& one, Index encoder, const std::string& other, Span span) {
    if (one.encoder == encoder || one.encoder == kNone) return true;
    return c.refuse(
        Code::wrong_space, span,
        fmt::format("'{}' is by {} and '{}' is by {}; a distance compares embeddings by one "
                    "encoder",
                    one.name, c.model.encoders[one.encoder].name, other,
                    c.model.encoders[encoder].name));
}

bool encoders_fit(Context& c, Index point, Index other, Span span) {
    const std::vector<Index> left = inputs_of(c.model, point);
    const std::vector<Index> right = inputs_of(c.model, other);
    std::uint64_t at_left = 0;
    std::uint64_t at_right = 0;
    for (std::size_t i = 0, j = 0; i < left.size() && j < right.size();) {
        const Input& one = c.model.inputs[left[i]];
        const Input& two = c.model.inputs[right[j]];
        if (at_left == at_right && two.encoder != kNone &&
            !is_by(c, one, two.encoder, two.name, span))
            return false;
        const std::uint64_t end = std::min(at_left + one.dimension, at_right + two.dimension);
        const bool left_ends = at_left + one.dimension == end;
        const bool right_ends = at_right + two.dimension == end;
        if (left_ends) at_left = end;
        if (right_ends) at_right = end;
        i += left_ends ? 1 : 0;
        j += right_ends ? 1 : 0;
    }
    return true;
}

bool check_same_space(Context& c, Index a, Index b, Span span) {
    const Point& one = c.model.points[a];
    const Point& other = c.model.points[b];
    if (one.dimension != other.dimension)
        return c.refuse(Code::dimension_mismatch, span,
                        fmt::format("{} has dimension {}, {} has dimension {}", one.text,
                                    one.dimension, other.text, other.dimension));
    if (is_same_space(c.model, a, b))
        return is_declared_same(c.model, one, other) || encoders_fit(c, a, b, span);
    auto& error = c.report(
        Code::wrong_space, span,
        fmt::format("{} and {} are in different spaces; expected two inputs, or two points "
                    "through the same projections",
                    one.text, other.text));
    if (!one.is_vector() && !other.is_vector())
        error.note(
            "if both spaces are one, end the declaration of each projection with "
            "'in NAME', the same name; an input needs a projection of its own");
    return false;
}

Index target_in_space(Context& c, Index index, Index measured, Span span) {
    Index point = space_of(c, measured);
    const Target& target = c.model.targets[index];
    const auto is_there = [&](Index at) {
        if (target.space == kNone) return !c.model.points[at].is_projected();
        const Point& space = c.model.points[target.space];
        return at == target.space ||
               (at == point && is_declared_same(c.model, c.model.points[at], space));
    };
    // Rows are not projected into the space of a sum: its projections may differ. Any part may be
    // the one that they are declared `of`.
    const bool is_sum = c.model.points[measured].is_sum();
    if (is_sum)
        for (const Index part : std::vector<Index>(c.model.points[measured].parts))
            if (space_of(c, part) == target.space) point = target.space;
    Index from = point;
    while (from != kNone && !is_there(from)) from = is_sum ? kNone : c.model.points[from].inner;
    const auto of = c.point_of_target.find(index);
    const bool is_elsewhere = target.space == kNone && of != c.point_of_target.end() &&
                              from != kNone && !is_same_space(c.model, from, of->second) &&
                              c.model.points[from].dimension == target.dimension;
    if (from == kNone || is_elsewhere) {
        report_wrong_space(c, target, is_elsewhere ? of->second : target.space,
                           c.model.points[is_sum ? measured : point], c.model.points[point], span);
        return kNone;
    }
    if (c.model.points[from].dimension != target.dimension) {
        report_dimensions(c, target, c.model.points[from], c.model.points[point], span);
        return kNone;
    }
    if (from == point) return index;
    const auto [at, is_new] =
        c.projected_targets.try_emplace({index, point}, static_cast<Index>(c.model.targets.size()));
    if (!is_new) return at->second;
    Target projected = target;
    projected.source = index;
    projected.space = point;
    projected.dimension = c.model.points[point].dimension;
    projected.values.clear();
    c.model.targets.push_back(std::move(projected));
    if (const auto row = project_target(c.model, at->second)) {
        at->second = kNone;
        c.report(Code::projected_not_finite, span,
                 fmt::format("row {} (from 0) of target '{}' exceeds float32 when projected into "
                             "the space of {}",
                             *row, c.model.targets[index].name, c.model.points[point].text));
    }
    return at->second;
}

}  // namespace etlc::check
