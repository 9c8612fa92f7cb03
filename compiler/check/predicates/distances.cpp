// AGG DIST(point, target).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "check/numbers/decimal.hpp"
#include "check/points/points.hpp"
#include "check/predicates/expressions.hpp"
#include "check/predicates/weights.hpp"

namespace etlc::check {

namespace {

using diag::Code;

struct MetricName {
    std::string_view text;
    Metric metric;
};

constexpr std::array kMetrics = std::to_array<MetricName>({
#define DISTANCE(id, Type, prepared, zero_is_unknown) {#id, Metric::id},
#define DISTANCE_BY_WEIGHTS(...)
#include "etlmon/distance/distances.def"
#undef DISTANCE
});

std::string_view word(Aggregation aggregation) {
    switch (aggregation) {
        case Aggregation::min: return "min";
        case Aggregation::max: return "max";
        case Aggregation::mean: return "mean";
        case Aggregation::kth: return "kth";
    }
    return "";
}

class DistanceCheck {
public:
    DistanceCheck(Context& context, const ast::Distance& written)
        : c_(context), written_(written) {}

    Index run() {
        set_metric();
        distance_.point = check_point(c_, written_.point);
        distance_.target = resolve(c_, written_.target, NameKind::target);
        const bool point = distance_.point != kNone;
        const bool target = distance_.target != kNone;
        bool fits = point && target && set_space();
        if (target) fits = set_aggregation() && fits;
        if (target) fits = rows_have_directions() && fits;
        if (point) fits = set_weights() && fits;
        return fits ? add() : kNone;
    }

private:
    void set_metric() {
        const auto named = [&](const MetricName& row) { return row.text == written_.metric.text; };
        const auto found = std::find_if(kMetrics.begin(), kMetrics.end(), named);
        assert(found != kMetrics.end());  // the grammar has no other
        distance_.metric = found->metric;
    }

    std::uint32_t dimension() const { return c_.model.points[distance_.point].dimension; }

    const Target& target() const { return c_.model.targets[distance_.target]; }

    /// Takes the target's rows where the point is.
    bool set_space() {
        const Index there =
            target_in_space(c_, distance_.target, distance_.point,
                            source::join(written_.point.span, written_.target.span));
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
        using Kind = ast::Aggregation::Kind;
        switch (written_.aggregation->kind) {
            case Kind::min: distance_.aggregation = Aggregation::min; return true;
            case Kind::max: distance_.aggregation = Aggregation::max; return true;
            case Kind::mean: distance_.aggregation = Aggregation::mean; return true;
            case Kind::kth: distance_.aggregation = Aggregation::kth; return set_kth();
        }
        return true;
    }

    bool set_kth() {
        const ast::Number& rank = *written_.aggregation->n;
        const auto n = Decimal::parse(rank.text).whole(target().rows);
        if (n && *n > 0) {
            distance_.kth = static_cast<std::uint32_t>(*n);
            return true;
        }
        c_.report(Code::kth_out_of_range, written_.aggregation->span,
                  fmt::format("kth({}) of target '{}'; expected a whole number from 1 to its {}",
                              shown(rank), target().name, diag::counted(target().rows, "row")));
        return false;
    }

    /// cosine and angular compare directions, and a zero vector has none.
    bool rows_have_directions() {
        if (!is_of_directions(distance_.metric) || target().values.empty()) return true;
        const std::size_t columns = target().dimension;
        for (std::size_t row = 0; row < target().rows; ++row) {
            const auto begin = target().values.begin() + static_cast<std::ptrdiff_t>(row * columns);
            if (!std::all_of(begin, begin + static_cast<std::ptrdiff_t>(columns),
                             [](float x) { return x == 0; }))
                continue;
            c_.report(
                  Code::zero_row, written_.target.span,
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

    /// Over one row every aggregation is the distance itself, so none is written then.
    std::string canonical_text() {
        std::string text;
        if (target().rows == 1) {
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
        return text + fmt::format("({}, {})", c_.model.points[distance_.point].text, target().name);
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
