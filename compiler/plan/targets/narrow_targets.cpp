#include "plan/targets/narrow_targets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

#include "check/numbers/decimal.hpp"
#include "etlmon/distance/widen.hpp"
#include "plan/targets/kernels.hpp"
#include "plan/targets/stored.hpp"

namespace etlc::plan {

namespace {

using diag::Code;

constexpr double kLargestHalf = 65504;

/// Returns the bits of a double that is a finite float16.
std::uint16_t half_bits(double half) {
    constexpr int kFractionBits = 10;
    constexpr int kLeastExponent = -14;
    const auto sign = static_cast<std::uint16_t>(std::signbit(half) ? 0x8000U : 0U);
    const double magnitude = std::abs(half);
    if (magnitude == 0) return sign;
    const int exponent = std::max(std::ilogb(magnitude), kLeastExponent);
    // Subnormal numbers have no implicit bit: their fraction stays below 2^10 and does not carry
    // into the exponent.
    const auto fraction =
        static_cast<std::uint32_t>(std::ldexp(magnitude, kFractionBits - exponent));
    return static_cast<std::uint16_t>(
        sign + fraction + (static_cast<std::uint32_t>(exponent - kLeastExponent) << kFractionBits));
}

/// The norm of |e_0|, |e_1|, ... in which a row's move changes its distance, as in
/// etlmon::detail::change().
class Norm {
public:
    explicit Norm(const check::Distance& distance) : distance_(distance) {}

    void add(double e, std::size_t i) {
        sum_ += std::abs(e);
        squares_ += e * e * (weighted() ? static_cast<double>(distance_.weights[i]) : 1.0);
        greatest_ = std::max(greatest_, std::abs(e));
    }
    double value() const {
        constexpr double kSlack =
            1 + 1e-9;  // covers the sums here, in double, over up to 2^20 elements
        switch (distance_.metric) {
            case check::Metric::l1: return sum_ * kSlack;
            case check::Metric::linf: return greatest_ * kSlack;
            case check::Metric::l2:
            case check::Metric::l2sq:
            case check::Metric::cosine:
            case check::Metric::angular:
            case check::Metric::mahalanobis: return std::sqrt(squares_) * kSlack;
        }
        return std::numeric_limits<double>::infinity();
    }

private:
    bool weighted() const { return distance_.metric == check::Metric::mahalanobis; }

    const check::Distance& distance_;
    double sum_ = 0;
    double squares_ = 0;
    double greatest_ = 0;
};

/// Fills the rows of one set.
class Narrowing {
public:
    Narrowing(const check::Model& model, NarrowSet& set)
        : distance_(model.distances[set.distance]),
          target_(model.targets[distance_.target]),
          set_(set),
          rows_(prepared_rows(model, distance_)) {}

    /// Narrows all rows. Returns the first row with an element beyond float16, or the number of
    /// rows if there is none.
    std::uint32_t run() {
        set_.rows = target_.rows;
        set_.dimension = target_.dimension;
        return set_.storage == Storage::f16 ? to_halves() : to_bytes();
    }

private:
    std::uint32_t to_halves() {
        std::vector<double> narrow;
        for (const float g : rows_) {
            const double half = to_f16(static_cast<double>(g));
            if (std::abs(half) > kLargestHalf)
                return static_cast<std::uint32_t>(narrow.size() / target_.dimension);
            set_.halves.push_back(half_bits(half));
            narrow.push_back(half);
        }
        set_move(narrow);
        return target_.rows;
    }

    /// Uses one scale for the whole set. Some kernels round scale x integer to float32, others do
    /// not: that rounding counts as a move.
    std::uint32_t to_bytes() {
        constexpr double kLargest = 127;
        float greatest = 0;
        for (const float g : rows_) greatest = std::max(greatest, std::abs(g));
        set_.scale = std::max(check::round_up(static_cast<double>(greatest) / kLargest), FLT_MIN);
        std::vector<double> narrow;
        for (const float g : rows_) {
            const double q =
                std::nearbyint(static_cast<double>(g) / static_cast<double>(set_.scale));
            set_.bytes.push_back(static_cast<std::int8_t>(std::clamp(q, -kLargest, kLargest)));
            narrow.push_back(
                static_cast<double>(set_.scale * static_cast<float>(set_.bytes.back())));
        }
        set_move(narrow);
        return target_.rows;
    }

    void set_move(const std::vector<double>& narrow) {
        const bool lossless =
            std::equal(narrow.begin(), narrow.end(), rows_.begin(),
                       [](double a, float b) { return a == static_cast<double>(b); });
        const double rounding = set_.storage == Storage::i8 ? 0x1p-24 : 0;
        double moved = 0;
        for (std::size_t row = 0; row < target_.rows; ++row) {
            const std::vector<double> exact = exact_row(row);
            Norm norm(distance_);
            for (std::size_t i = 0; i < exact.size(); ++i) {
                const double there = narrow[row * exact.size() + i];
                norm.add(std::abs(there - exact[i]) + std::abs(there) * rounding, i);
            }
            moved = std::max(moved, norm.value());
        }
        set_.lossless = lossless;
        set_.moved = check::round_up(moved);
    }

    /// Returns the row that defines the distance: normalised in double for cosine and angular.
    std::vector<double> exact_row(std::size_t row) const {
        const auto* begin = target_.values.data() + row * target_.dimension;
        std::vector<double> exact(begin, begin + target_.dimension);
        if (rows_as_given(distance_)) return exact;
        double square = 0;
        for (const double x : exact) square += x * x;
        for (double& x : exact) x /= std::sqrt(square);
        return exact;
    }

    const check::Distance& distance_;
    const check::Target& target_;
    NarrowSet& set_;
    std::vector<float> rows_;
};

/// Adds the points at which the robustness of a predicate changes its sign or passes the shift of a
/// monitor calibrated as a whole, negated or not: only there status and finality change. Around a
/// shift the float32 subtractions leave a few roundings open.
void add_cuts(const Plan& plan, const check::Predicate& predicate, std::vector<Cut>& cuts) {
    const auto add = [&](Cut cut) {
        const auto same = [&](const Cut& c) { return c.low == cut.low && c.high == cut.high; };
        if (std::none_of(cuts.begin(), cuts.end(), same)) cuts.push_back(cut);
    };
    const auto add_shifted = [&](float epsilon, float of) {
        if (std::isinf(of)) return;
        const double slack =
            (std::abs(static_cast<double>(of)) + std::abs(static_cast<double>(epsilon))) * 4 *
                static_cast<double>(FLT_EPSILON) +
            4 * static_cast<double>(FLT_MIN);
        for (const float shift : {of, -of}) {
            const double at = static_cast<double>(epsilon) + static_cast<double>(shift);
            add({-check::round_up(-(at - slack)), check::round_up(at + slack)});
        }
    };
    for (const float epsilon : {predicate.threshold.value, predicate.threshold.low()}) {
        if (std::isinf(epsilon)) continue;
        add({epsilon, epsilon});
        for (const Monitor& monitor : plan.monitors) {
            if (!monitor.shifted) continue;
            add_shifted(epsilon, monitor.shift);
            if (monitor.inner_shift) add_shifted(epsilon, *monitor.inner_shift);
        }
    }
}

bool reads(const check::Expr& e, Index distance) {
    bool found = false;
    check::for_each_distance(e, [&](Index d) { found = found || d == distance; });
    return found;
}

bool is_adaptive(const check::Predicate& predicate) {
    return predicate.threshold.origin == check::ThresholdOrigin::adaptive;
}

/// Returns whether all predicates that read the distance compare it, or its difference from
/// another, with a constant.
bool can_be_enclosed(const Plan& plan, Index distance) {
    return std::none_of(plan.predicates.begin(), plan.predicates.end(), [&](Index p) {
        const check::Predicate& predicate = plan.model->predicates[p];
        const bool plain = predicate.plain_distance() && !is_adaptive(predicate);
        return !plain && !contrast(predicate) && reads(predicate.expression, distance);
    });
}

/// Returns why a distance is measured on float32 in any case; empty if it is not.
std::string why_float32(const Plan& plan, Index d) {
    const check::Distance& distance = plan.model->distances[d];
    if (distance.is_between_points()) return "the distance between two points has no target";
    const check::Target& target = plan.model->targets[distance.target];
    if (stored_set(plan, d) != nullptr)
        return fmt::format(
            "'{}' lies in a file beside the header, which keeps float32; --inline-targets {} has "
            "it in the header",
            target.name, target.values.size() * sizeof(float));
    if (distance.full_weights()) return "mahalanobis with full weights is measured on float32";
    if (!can_be_enclosed(plan, d))
        return "an expression or an adaptive threshold takes this distance as a float32";
    return "";
}

void refuse_unchanged(const Plan& plan, Storage storage, diag::Sink& sink) {
    constexpr std::size_t kMostNotes = 8;
    const auto span = [&](Index d) { return plan.model->distances[d].span; };
    const bool measures = !plan.distances.empty();
    auto& error =
        sink.report(Code::targets_not_narrow, measures ? span(plan.distances[0]) : source::Span{},
                    fmt::format("--targets-as {} changes nothing: {}", word(storage),
                                measures ? why_float32(plan, plan.distances[0])
                                         : "no monitor measures a distance"));
    for (std::size_t i = 1; i < std::min(plan.distances.size(), kMostNotes); ++i)
        error.note(span(plan.distances[i]), why_float32(plan, plan.distances[i]));
}

void refuse_row(const Plan& plan, const NarrowSet& set, std::uint32_t row, diag::Sink& sink) {
    const check::Target& target = plan.model->targets[plan.model->distances[set.distance].target];
    sink.report(Code::targets_not_narrow, target.span,
                fmt::format(
                    "row {} (from 0) of target '{}' has an element beyond {}, the largest float16",
                    row, target.name, kLargestHalf))
        .note("leave --targets-as out, or use --targets-as i8, which has a scale for each set");
}

}  // namespace

double to_f16(double x) {
    if (!std::isfinite(x) || x == 0) return x;
    constexpr int kFractionBits = 10;
    constexpr int kLeastExponent = -14;
    const double quantum = std::ldexp(1.0, std::max(std::ilogb(x), kLeastExponent) - kFractionBits);
    const double rounded = std::nearbyint(x / quantum) * quantum;
    return std::abs(rounded) > kLargestHalf ? std::copysign(HUGE_VAL, x) : rounded;
}

void narrow_targets(Plan& plan, Storage storage, diag::Sink& sink) {
    if (storage == Storage::f32) return;
    for (const Index d : plan.distances) {
        if (!why_float32(plan, d).empty()) continue;
        NarrowSet set{.distance = d, .storage = storage};
        if (const std::uint32_t row = Narrowing(*plan.model, set).run(); row < set.rows) {
            refuse_row(plan, set, row, sink);
            continue;
        }
        for (const Index p : plan.predicates) {
            const check::Predicate& predicate = plan.model->predicates[p];
            if (predicate.plain_distance() && predicate.expression.index == d)
                add_cuts(plan, predicate, set.cuts);
        }
        plan.narrow.push_back(std::move(set));
    }
    if (plan.narrow.empty() && !sink.has_errors()) refuse_unchanged(plan, storage, sink);
}

std::optional<std::pair<Index, Index>> contrast(const check::Predicate& predicate) {
    const check::Expr& e = predicate.expression;
    const auto is_distance = [](const check::Expr& operand) {
        return operand.kind == check::Expr::Kind::distance;
    };
    const bool is_contrast = e.kind == check::Expr::Kind::subtract && !predicate.name.empty() &&
                             !is_adaptive(predicate) &&
                             std::all_of(e.arguments.begin(), e.arguments.end(), is_distance);
    if (!is_contrast) return std::nullopt;
    return std::pair(e.arguments[0].index, e.arguments[1].index);
}

std::vector<Cut> contrast_cuts(const Plan& plan, const check::Predicate& predicate) {
    std::vector<Cut> cuts;
    const auto both = contrast(predicate);
    const auto is_open = [&](Index d) {
        const NarrowSet* set = narrow_set(plan, d);
        return set != nullptr && !set->lossless;
    };
    if (both && (is_open(both->first) || is_open(both->second))) add_cuts(plan, predicate, cuts);
    return cuts;
}

const NarrowSet* narrow_set(const Plan& plan, Index distance) {
    const auto found = std::find_if(plan.narrow.begin(), plan.narrow.end(),
                                    [&](const NarrowSet& set) { return set.distance == distance; });
    return found == plan.narrow.end() ? nullptr : &*found;
}

std::vector<float> widened_rows(const NarrowSet& set) {
    std::vector<float> rows(std::size_t{set.rows} * set.dimension);
    const auto count = static_cast<std::uint32_t>(rows.size());
    if (set.storage == Storage::f16)
        etlmon::widen_f16(set.halves.data(), rows.data(), count);
    else
        etlmon::widen_i8(set.bytes.data(), set.scale, rows.data(), count);
    return rows;
}

std::uint64_t bytes_of(const NarrowSet& set) {
    return set.halves.size() * sizeof(std::uint16_t) + set.bytes.size();
}

const char* word(Storage storage) {
    return storage == Storage::f16 ? "f16" : storage == Storage::i8 ? "i8" : "f32";
}

}  // namespace etlc::plan
