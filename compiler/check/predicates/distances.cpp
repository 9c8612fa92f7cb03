// Checks AGG DIST(point, target).
#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "check/numbers/decimal.hpp"
#include "check/points/points.hpp"
#include "check/predicates/predicates.hpp"
#include "check/predicates/weights.hpp"

namespace etlc::check {

namespace {

using diag::Code;

class DistanceCheck {
public:
    DistanceCheck(Context& context, const ast::Distance& written)
        : c_(context), written_(written) {}

    Index run() {
        set_metric();
        distance_.point = check_point(c_, written_.point);
        if (!is_to_target()) return between_points();
        distance_.target = resolve(c_, written_.other.name, NameKind::target);
        const bool point = distance_.point != kNone;
        const bool target = distance_.target != kNone;
        bool fits = point && target && set_space();
        if (target) fits = set_aggregation() && fits;
        if (target) fits = rows_have_directions() && fits;
        if (point) fits = set_weights() && fits;
        return fits ? add() : kNone;
    }

private:
    /// A name is that of a target unless it is an input.
    bool is_to_target() const {
        if (!written_.other.is_name()) return false;
        const Reference* const meant = c_.scope.find(written_.other.name.text);
        return meant == nullptr || meant->kind != NameKind::input;
    }

    Index between_points() {
        distance_.other = check_point(c_, written_.other);
        if (distance_.point == kNone || distance_.other == kNone) return kNone;
        const bool fits = has_no_aggregation() && points_fit() &&
                          encoders_fit(distance_.point, distance_.other) && set_weights();
        return fits ? add() : kNone;
    }

    bool has_no_aggregation() {
        if (!written_.aggregation) return true;
        return c_.refuse(Code::point_form, written_.aggregation->span,
                         fmt::format("the distance between two points is one number; expected {} "
                                     "without {}, or a target",
                                     written_.metric.text, word(written_.aggregation->kind)));
    }

    bool points_fit() {
        const Point& one = c_.model.points[distance_.point];
        const Point& other = c_.model.points[distance_.other];
        if (one.dimension != other.dimension)
            return c_.refuse(Code::dimension_mismatch, both_points(),
                             fmt::format("{} has dimension {}, {} has dimension {}", one.text,
                                         one.dimension, other.text, other.dimension));
        if (is_same_space(c_.model, distance_.point, distance_.other)) return true;
        return c_.refuse(Code::wrong_space, both_points(),
                         fmt::format("{} and {} are in different spaces; expected two inputs, or "
                                     "two points through the same projections",
                                     one.text, other.text));
    }

    /// Embeddings by two encoders have nothing to do with each other. Inputs that begin at the same
    /// element are compared: [x, y] may stand for one of two.
    bool encoders_fit(Index point, Index other) {
        const std::vector<Index>& left = c_.model.points[point].inputs;
        const std::vector<Index>& right = c_.model.points[other].inputs;
        std::uint64_t at_left = 0;
        std::uint64_t at_right = 0;
        for (std::size_t i = 0, j = 0; i < left.size() && j < right.size();) {
            const Input& one = c_.model.inputs[left[i]];
            const Input& two = c_.model.inputs[right[j]];
            if (at_left == at_right && two.encoder != kNone && !is_by(one, two.encoder, two.name))
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

    /// Whether an input may be by the encoder that `other` is by.
    bool is_by(const Input& one, Index encoder, const std::string& other) {
        if (one.encoder == encoder || one.encoder == kNone) return true;
        return c_.refuse(
            Code::wrong_space, both_points(),
            fmt::format("'{}' is by {} and '{}' is by {}; a distance compares embeddings by one "
                        "encoder",
                        one.name, c_.model.encoders[one.encoder].name, other,
                        c_.model.encoders[encoder].name));
    }

    bool encoders_of_rows_fit() {
        const std::vector<Index>& inputs = c_.model.points[distance_.point].inputs;
        const auto rows = c_.encoder_of_target.find(distance_.target);
        if (rows != c_.encoder_of_target.end() && inputs.size() == 1 &&
            !is_by(c_.model.inputs[inputs[0]], rows->second, target().name))
            return false;
        const auto of = c_.point_of_target.find(distance_.target);
        return of == c_.point_of_target.end() || encoders_fit(distance_.point, of->second);
    }

    Span both_points() const { return source::join(written_.point.span, written_.other.span); }

    void set_metric() {
        const auto* const found =
            std::find_if(kMetrics.begin(), kMetrics.end(),
                         [&](const MetricRow& row) { return row.word == written_.metric.text; });
        assert(found != kMetrics.end());  // the grammar has no other
        distance_.metric = static_cast<Metric>(found - kMetrics.begin());
    }

    std::uint32_t dimension() const { return c_.model.points[distance_.point].dimension; }

    const Target& target() const { return c_.model.targets[distance_.target]; }

    /// Uses the target's rows in the space of the point.
    bool set_space() {
        if (!encoders_of_rows_fit()) return false;
        const Index there = target_in_space(c_, distance_.target, distance_.point, both_points());
        if (there != kNone) distance_.target = there;
        return there != kNone;
    }

    bool set_aggregation() {
        if (!written_.aggregation) {
            if (target().rows == 1) return true;
            c_.report(Code::aggregation_missing, written_.metric.span,
                      fmt::format(
                          "target '{}' has {} rows; expected min, max, mean or kth(n) before {}",
                          target().name, target().rows, written_.metric.text))
                .note(fmt::format("the distance to the nearest row is 'min {}(...)'",
                                  written_.metric.text));
            return false;
        }
        distance_.aggregation = written_.aggregation->kind;
        return distance_.aggregation != Aggregation::kth || set_kth();
    }

    bool set_kth() {
        const ast::Number& rank = *written_.aggregation->n;
        const auto n = Decimal::parse(rank.text).whole(target().rows);
        if (n && *n > 0) {
            distance_.kth = static_cast<std::uint32_t>(*n);
            return true;
        }
        return c_.refuse(
            Code::kth_out_of_range, written_.aggregation->span,
            fmt::format("kth({}) of target '{}'; expected a whole number from 1 to its {}",
                        shown(rank), target().name, diag::counted(target().rows, "row")));
    }

    /// cosine and angular compare directions, which a zero vector lacks.
    bool rows_have_directions() {
        if (!is_of_directions(distance_.metric) || target().values.empty()) return true;
        const std::size_t columns = target().dimension;
        for (std::size_t row = 0; row < target().rows; ++row) {
            const auto begin = target().values.begin() + static_cast<std::ptrdiff_t>(row * columns);
            if (!std::all_of(begin, begin + static_cast<std::ptrdiff_t>(columns),
                             [](float x) { return x == 0; }))
                continue;
            c_.report(
                  Code::zero_row, written_.other.span,
                  fmt::format("row {} (from 0) of target '{}' is zero, and {} needs a direction",
                              row, target().name, written_.metric.text))
                .note(target().span, fmt::format("'{}' is declared here", target().name));
            return false;
        }
        return true;
    }

    bool set_weights() {
        if (!written_.weights) return true;
        auto weights = check_weights(c_, *written_.weights, distance_.point, written_.metric.span);
        if (!weights) return false;
        distance_.weights = std::move(weights->values);
        distance_.weights_diagonal = weights->diagonal;
        distance_.weights_path = std::move(weights->path);
        distance_.weights_fitted = weights->fitted;
        weights_text_ = std::move(weights->text);
        return true;
    }

    /// With a single row every aggregation is the distance itself, so the text has none.
    std::string canonical_text() {
        std::string text;
        if (distance_.is_between_points() || target().rows == 1) {
            distance_.aggregation = Aggregation::min;
            distance_.kth = 1;
        } else {
            text = word(distance_.aggregation);
            if (distance_.aggregation == Aggregation::kth)
                text += fmt::format("({})", distance_.kth);
            text += ' ';
        }
        text += written_.metric.text;
        if (written_.weights) text += fmt::format("({})", weights_text_);
        const std::string& other =
            distance_.is_between_points() ? c_.model.points[distance_.other].text : target().name;
        return text + fmt::format("({}, {})", c_.model.points[distance_.point].text, other);
    }

    Index add() {
        distance_.text = canonical_text();
        distance_.span = written_.span;
        const auto [at, is_new] = c_.distance_of_text.try_emplace(
            distance_.text, static_cast<Index>(c_.model.distances.size()));
        if (is_new) c_.model.distances.push_back(std::move(distance_));
        return at->second;
    }

    Context& c_;
    const ast::Distance& written_;
    Distance distance_;
    std::string weights_text_;
};

}  // namespace

Index check_distance(Context& context, const ast::Distance& distance) {
    return DistanceCheck(context, distance).run();
}

}  // namespace etlc::check
