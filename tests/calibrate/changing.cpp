#include "changing.hpp"

#include <cmath>

namespace etlc::tests {

namespace {

using check::Index;
using check::kNone;

void change(std::string& text) {
    text += '1';  // replaces numbers and names
}
void change(bool& value) {
    value = !value;
}
void change(float& value) {
    value = std::isfinite(value) ? value + 1 : 0;
}
void change(double& value) {
    value = std::isfinite(value) ? value + 1 : 0;
}
void change(std::uint32_t& value) {
    ++value;
}
void change(std::uint64_t& value) {
    ++value;
}
void change(source::Span& span) {
    ++span.begin;
}
void change(check::Range& range) {
    change(range.low);
}
template <class T>
void change(std::optional<T>& value) {
    if (value)
        value.reset();
    else
        value.emplace();
}
void change(std::vector<float>& values) {
    if (values.empty())
        values.push_back(1);
    else
        ++values[0];
}
template <class T>
void change(std::vector<T>& values) {
    if (!values.empty()) values.pop_back();
}
template <class Key, class Value>
void change(std::map<Key, Value>& values) {
    values.emplace();
}
void change(std::vector<check::Expr>& arguments) {
    if (arguments.size() == 2) std::swap(arguments[0], arguments[1]);
}
/// Calls it only if the number of arguments matches.
void change(check::Expr::Kind& kind) {
    using enum ast::ExprKind;
    switch (kind) {
        case subtract: kind = divide; break;
        case multiply: kind = add; break;
        case abs: kind = sqrt; break;
        case min: kind = max; break;
        default: break;
    }
}
void change(check::Formula::Kind& kind) {
    using enum check::Formula::Kind;
    kind = kind == constant_true ? constant_false : constant_true;
}
template <class Enum, class = std::enable_if_t<std::is_enum_v<Enum>>>
void change(Enum& value) {
    value = static_cast<Enum>(static_cast<int>(value) == 0 ? 1 : 0);
}

/// Changes an index into a list to that of another element.
struct Place {
    Index& index;
    std::size_t size;
};
void change_place(Place place) {
    if (place.index == kNone)
        place.index = 0;
    else
        place.index = place.index + 1 < place.size ? place.index + 1 : place.index - 1;
}

template <class T>
void field(Changing& changing, const std::string& name, T& value) {
    const T before = value;
    change(value);
    changing.note(name);
    value = before;
}

void field(Changing& changing, const std::string& name, Place place) {
    const Index before = place.index;
    change_place(place);
    changing.note(name);
    place.index = before;
}

void visit(check::Model&, check::Encoder& of, Changing& changing) {
    changing.of("Encoder");
    auto& [name, model, preprocessor, image, mean, deviation, filter, resize, flip, channels,
           margins, output, pool, declaration, dimension, fingerprint, references, otherwise,
           span] = of;
    field(changing, "name", name);
    field(changing, "model", model);
    field(changing, "preprocessor", preprocessor);
    field(changing, "image", image);
    field(changing, "mean", mean);
    field(changing, "deviation", deviation);
    field(changing, "filter", filter);
    field(changing, "resize", resize);
    field(changing, "flip", flip);
    field(changing, "channels", channels);
    field(changing, "margins", margins);
    field(changing, "output", output);
    field(changing, "pool", pool);
    field(changing, "declaration", declaration);
    field(changing, "dimension", dimension);
    field(changing, "fingerprint", fingerprint);
    field(changing, "references", references);
    field(changing, "otherwise", otherwise);
    field(changing, "span", span);
}

void visit(check::Model&, check::Projection& of, Changing& changing) {
    changing.of("Projection");
    auto& [name, rows, dimension, matrix, offset, origin, path, hash, fitted, space, span] = of;
    field(changing, "name", name);
    field(changing, "rows", rows);
    field(changing, "dimension", dimension);
    field(changing, "matrix", matrix);
    field(changing, "offset", offset);
    field(changing, "origin", origin);
    field(changing, "path", path);
    field(changing, "hash", hash);
    field(changing, "fitted", fitted);
    field(changing, "space", space);
    field(changing, "span", span);
}

void visit(check::Model& model, check::Point& of, Changing& changing) {
    changing.of("Point");
    auto& [kind, inputs, dimension, projection, inner, steps, parts, factors, text] = of;
    field(changing, "kind", kind);
    field(changing, "inputs", inputs);
    field(changing, "dimension", dimension);
    if (projection != kNone)
        field(changing, "projection", Place{projection, model.projections.size()});
    field(changing, "steps", steps);
    field(changing, "parts", parts);
    field(changing, "factors", factors);
    field(changing, "text", text);
    // Only to earlier ones.
    if (inner != kNone) field(changing, "inner", Place{inner, inner + 1});
    field(changing, "steps", steps);
    for (Index& part : parts) field(changing, "parts", Place{part, part + 1});
}

void visit(check::Model& model, check::Target& of, Changing& changing) {
    changing.of("Target");
    auto& [name, rows, dimension, values, origin, path, hash, encoded, space, source, fitted,
           span] = of;
    field(changing, "name", name);
    field(changing, "rows", rows);
    field(changing, "dimension", dimension);
    field(changing, "values", values);
    field(changing, "origin", origin);
    field(changing, "path", path);
    field(changing, "hash", hash);
    field(changing, "encoded", encoded);
    field(changing, "space", Place{space, model.points.size()});
    if (source != kNone) field(changing, "source", Place{source, source + 1});
    field(changing, "fitted", fitted);
    field(changing, "span", span);
}

void visit(check::Model& model, check::Expr& of, Changing& changing) {
    changing.of("Expr");
    auto& [kind, text, number, number32, index, arguments, span] = of;
    field(changing, "kind", kind);
    field(changing, "text", text);
    field(changing, "number", number);
    field(changing, "number32", number32);
    if (kind == check::Expr::Kind::scalar)
        field(changing, "index", Place{index, model.inputs.size()});
    if (kind == check::Expr::Kind::past) field(changing, "index", Place{index, model.pasts.size()});
    field(changing, "arguments", arguments);
    field(changing, "span", span);
    for (check::Expr& argument : arguments) visit(model, argument, changing);
}

void visit(check::Model& model, check::Past& of, Changing& changing) {
    changing.of("Past");
    auto& [kind, expression, steps, text, range, span] = of;
    field(changing, "kind", kind);
    field(changing, "steps", steps);
    field(changing, "text", text);
    field(changing, "range", range);
    field(changing, "span", span);
    visit(model, expression, changing);
}

void visit(check::Model&, check::Threshold& of, Changing& changing) {
    changing.of("Threshold");
    auto& [origin, text, alpha, beta, against, within, value64, value, inner, n, k, inner_n,
           inner_k, by_group, adaptation, span] = of;
    field(changing, "origin", origin);
    field(changing, "text", text);
    field(changing, "alpha", alpha);
    field(changing, "value64", value64);
    field(changing, "value", value);
    field(changing, "n", n);
    field(changing, "k", k);
    field(changing, "by_group", by_group);
    field(changing, "adaptation", adaptation);
    field(changing, "span", span);
}

void visit(check::Model& model, check::Formula& of, Changing& changing) {
    changing.of("Formula");
    auto& [kind, index, each_step, operands, low, high, time, span] = of;
    field(changing, "kind", kind);
    if (kind == check::Formula::Kind::predicate)
        field(changing, "index", Place{index, model.predicates.size()});
    if (kind == check::Formula::Kind::boolean_input)
        field(changing, "index", Place{index, model.inputs.size()});
    if (kind == check::Formula::Kind::count) {
        field(changing, "number", index);
        field(changing, "each_step", each_step);
    }
    field(changing, "operands", operands);
    field(changing, "low", low);
    field(changing, "high", high);
    field(changing, "time", time);
    field(changing, "span", span);
}

void visit(check::Model& model, check::Fitted& of, Changing& changing) {
    changing.of("Fitted");
    auto& [name, declaration, method, rows, columns, away, point, where, slot, index, filled,
           span] = of;
    field(changing, "name", name);
    field(changing, "declaration", declaration);
    field(changing, "method", method);
    field(changing, "rows", rows);
    field(changing, "columns", columns);
    field(changing, "away", away);
    field(changing, "point", Place{point, model.points.size()});
    field(changing, "where", Place{where, model.formulas.size()});
    field(changing, "slot", slot);
    field(changing, "index", index);
    field(changing, "filled", filled);
    field(changing, "span", span);
}

void visit(check::Model& model, check::Monitor& of, Changing& changing) {
    changing.of("Monitor");
    // A duration is read in the formula: Formula.time.
    auto& [name, formula, sliding, restarts, horizon, ahead, calibration, duration, span, truth] =
        of;
    field(changing, "name", name);
    field(changing, "formula", Place{formula, model.formulas.size()});
    field(changing, "sliding", sliding);
    field(changing, "restarts", restarts);
    of.sliding = true;  // others have no horizon
    field(changing, "horizon", horizon);
    of.sliding = false;
    field(changing, "calibration", calibration);
    field(changing, "span", span);
    field(changing, "truth", Place{truth, model.formulas.size()});
}

void visit(check::Model&, check::Let& of, Changing& changing) {
    changing.of("Let");
    auto& [name, formula, span, telemetry, truth] = of;
    field(changing, "name", name);
    field(changing, "formula", formula);
    field(changing, "telemetry", telemetry);
    field(changing, "span", span);
    field(changing, "truth", truth);
}

template <class T>
void visit_all(check::Model& model, std::vector<T>& list, Changing& changing) {
    for (T& one : list) visit(model, one, changing);
}

}  // namespace

void Changing::of(std::string name) {
    struct_ = std::move(name);
    some_ = false;
}

void Changing::note(const std::string& name) {
    const std::string field = struct_ + "." + name;
    all.insert(field);
    if (!is_read_()) return;
    read.insert(field);
    some_ = true;
}

void visit(check::Model& model, check::Input& of, Changing& changing) {
    changing.of("Input");
    auto& [name, type, dimension, scale, range, has_range, hold, missing, stale_after, encoder,
           span] = of;
    field(changing, "name", name);
    field(changing, "type", type);
    field(changing, "dimension", dimension);
    field(changing, "scale", scale);
    field(changing, "range", range);
    field(changing, "has_range", has_range);
    field(changing, "hold", hold);
    field(changing, "missing", missing);
    field(changing, "stale_after", stale_after);
    field(changing, "encoder", Place{encoder, model.encoders.size()});
    field(changing, "span", span);
}

void visit(check::Model& model, check::Distance& of, Changing& changing) {
    changing.of("Distance");
    auto& [point, target, other, metric, aggregation, kth, weights, weights_diagonal,
           weights_fitted, weights_path, text, span] = of;
    field(changing, "point", Place{point, model.points.size()});
    if (target != kNone) field(changing, "target", Place{target, model.targets.size()});
    if (other != kNone) field(changing, "other", Place{other, model.points.size()});
    field(changing, "metric", metric);
    field(changing, "aggregation", aggregation);
    field(changing, "kth", kth);
    field(changing, "weights", weights);
    field(changing, "weights_diagonal", weights_diagonal);
    field(changing, "weights_fitted", weights_fitted);
    field(changing, "weights_path", weights_path);
    field(changing, "text", text);
    field(changing, "span", span);
}

void visit(check::Model& model, check::Predicate& of, Changing& changing) {
    changing.of("Predicate");
    auto& [name, text, expression, comparison, threshold, delta, robustness, missing, inputs,
           span] = of;
    field(changing, "name", name);
    field(changing, "text", text);
    field(changing, "comparison", comparison);
    field(changing, "delta", delta);
    field(changing, "robustness", robustness);
    field(changing, "missing", missing);
    field(changing, "inputs", inputs);
    field(changing, "span", span);
    visit(model, expression, changing);
    visit(model, threshold, changing);
}

void visit(check::Model& model, check::Truth& of, Changing& changing) {
    changing.of("Truth");
    auto& [predicate, formula, span] = of;
    field(changing, "predicate", Place{predicate, model.predicates.size()});
    field(changing, "formula", Place{formula, model.formulas.size()});
    field(changing, "span", span);
}

void visit(check::Model& model, check::Drift& of, Changing& changing) {
    changing.of("Drift");
    auto& [name, predicate, monitor, level, cells, span] = of;
    field(changing, "name", name);
    field(changing, "predicate", Place{predicate, model.predicates.size()});
    field(changing, "monitor", Place{monitor, model.monitors.size()});
    field(changing, "level", level);
    field(changing, "cells", cells.id);
    field(changing, "span", span);
}

void visit(check::Model& of, Changing& changing) {
    auto& [name, retargetable, constants, file, step_seconds, rounded, rounding, encoders, encoded,
           inputs, projections, points, targets, fitted, distances, pasts, predicates, formulas,
           lets, truths, monitors, drifts, dependencies, reservations] = of;
    visit_all(of, encoders, changing);
    visit_all(of, inputs, changing);
    visit_all(of, projections, changing);
    visit_all(of, points, changing);
    visit_all(of, targets, changing);
    visit_all(of, fitted, changing);
    visit_all(of, distances, changing);
    visit_all(of, pasts, changing);
    visit_all(of, predicates, changing);
    visit_all(of, formulas, changing);
    visit_all(of, lets, changing);
    visit_all(of, truths, changing);
    visit_all(of, monitors, changing);
    visit_all(of, drifts, changing);
    changing.of("Model");
    field(changing, "name", name);
    field(changing, "retargetable", retargetable);
    field(changing, "constants", constants);
    field(changing, "step_seconds", step_seconds);
    field(changing, "rounded", rounded);
    field(changing, "rounding", rounding);
    field(changing, "encoded", encoded);
    field(changing, "dependencies", dependencies);
    field(changing, "reservations", reservations);
}

}  // namespace etlc::tests
