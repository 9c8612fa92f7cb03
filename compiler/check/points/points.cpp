#include "check/points/points.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "check/points/project.hpp"

namespace etlc::check {

namespace {

using diag::Code;

/// Returns one input of the point; kNone after an error.
Index element(Context& c, const ast::Point& written, const ast::Name& name) {
    const Index index = resolve(c, name, NameKind::input);
    if (index == kNone) return kNone;
    const Input& input = c.model.inputs[index];
    const bool fits = written.is_vector ? input.type == InputType::scalar : input.is_embedding();
    if (fits) return index;
    const std::string_view found = input.is_embedding()              ? "an embedding"
                                   : input.type == InputType::scalar ? "a scalar"
                                                                     : "a bool";
    auto& error = c.report(Code::point_form, name.span,
                           fmt::format("'{}' is {}; expected {}", name.text, found,
                                       written.is_vector ? "the scalars of a vector"
                                                         : "an embedding, or a vector of scalars"));
    if (input.is_embedding())
        error.note(fmt::format("write an embedding without brackets: {}", name.text));
    if (input.type == InputType::scalar)
        error.note(fmt::format("for a point of one dimension write [{}]", name.text));
    return kNone;
}

Index add(Context& c, Point point) {
    const auto [at, is_new] =
        c.point_of_text.try_emplace(point.text, static_cast<Index>(c.model.points.size()));
    if (is_new) c.model.points.push_back(std::move(point));
    return at->second;
}

Index unprojected(Context& c, const ast::Point& written) {
    Point point;
    point.kind = written.is_vector ? Point::Kind::scalars : Point::Kind::embedding;
    for (const ast::Name& name : written.inputs) point.inputs.push_back(element(c, written, name));
    const auto broken = std::find(point.inputs.begin(), point.inputs.end(), kNone);
    if (point.inputs.empty() || broken != point.inputs.end()) return kNone;
    point.dimension = written.is_vector ? static_cast<std::uint32_t>(point.inputs.size())
                                        : c.model.inputs[point.inputs[0]].dimension;
    for (const Index input : point.inputs)
        point.text += (point.text.empty() ? "" : ", ") + c.model.inputs[input].name;
    if (written.is_vector) point.text = fmt::format("[{}]", point.text);
    return add(c, std::move(point));
}

/// P(POINT)
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
    Point point;
    point.kind = Point::Kind::projected;
    point.inputs = from.inputs;
    point.dimension = projection.rows;
    point.projection = index;
    point.inner = inner;
    point.text = fmt::format("{}({})", name.text, from.text);
    return add(c, std::move(point));
}

/// "the vector", "'z'", "Q(z)"
std::string words_of(const Context& c, const Point& point) {
    if (point.is_projected()) return point.text;
    return point.is_vector() ? "the vector"
                             : fmt::format("'{}'", c.model.inputs[point.inputs[0]].name);
}

void report_wrong_space(Context& c, const Target& target, const Point& point, Span span) {
    const std::string& space = c.model.points[target.space].text;
    c.report(Code::wrong_space, span,
             fmt::format("target '{}' is in the space of {}, but {} is not projected through it",
                         target.name, space, words_of(c, point)))
        .note(target.span, fmt::format("'{}' is declared here", target.name))
        .note(fmt::format("measure from {}, or from a projection of it", space));
}

void report_dimensions(Context& c, const Target& target, const Point& point, const Point& whole,
                       Span span) {
    auto& error =
        c.report(Code::dimension_mismatch, span,
                 fmt::format("{} has dimension {}, target '{}' has dimension {}",
                             words_of(c, point), point.dimension, target.name, target.dimension));
    if (point.kind == Point::Kind::embedding)
        error.note(c.model.inputs[point.inputs[0]].span,
                   fmt::format("{} is declared here", words_of(c, point)));
    error.note(target.span, fmt::format("'{}' has {} of {}", target.name,
                                        diag::counted(target.rows, "row"), target.dimension));
    if (whole.is_projected() && !point.is_projected())
        error.note(fmt::format("if the rows are projected already, write: target {} = ... of {};",
                               target.name, whole.text));
}

}  // namespace

Index check_point(Context& c, const ast::Point& written) {
    Index point = unprojected(c, written);
    for (auto name = written.projections.rbegin(); name != written.projections.rend(); ++name)
        point = projected(c, *name, point, written.span);
    return point;
}

Index target_in_space(Context& c, Index index, Index point, Span span) {
    const Target& target = c.model.targets[index];
    const auto is_there = [&](Index at) {
        return target.space == kNone ? !c.model.points[at].is_projected() : at == target.space;
    };
    Index from = point;
    while (from != kNone && !is_there(from)) from = c.model.points[from].inner;
    if (from == kNone) {
        report_wrong_space(c, target, c.model.points[point], span);
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
