#include "check/numbers/range.hpp"

#include <algorithm>
#include <cmath>

#include "check/numbers/decimal.hpp"

namespace etlc::check {

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A real number as a double and the sign of its rounding error.
struct Exact {
    double value;
    double rest = 0;
};

float down(Exact x) {
    const float rounded = round_down(x.value);
    const bool above = static_cast<double>(rounded) == x.value && x.rest < 0;
    return above ? std::nextafter(rounded, -kInfinity) : rounded;
}

float up(Exact x) {
    return -down({-x.value, -x.rest});
}

/// Knuth's TwoSum, which also returns the rounding error.
Exact sum(float a, float b) {
    const double x = a, y = b, s = x + y;
    if (std::isinf(s)) return {s};
    const double y_part = s - x;
    return {s, (x - (s - y_part)) + (y - y_part)};
}

/// The product is exact in double. Infinite ends stand for unbounded finite values, so 0 x inf is
/// 0.
Exact product(float a, float b) {
    if (a == 0 || b == 0) return {0};
    return {static_cast<double>(a) * static_cast<double>(b)};
}

/// b is not 0. inf / inf stands for a quotient of finite numbers, which the other corners bound.
Exact exact_quotient(float a, float b) {
    if (std::isinf(b)) return {0};
    const double x = a, y = b, q = x / y;
    if (std::isinf(q)) return {q};
    const double remainder = std::fma(-q, y, x);
    return {q, y > 0 ? remainder : -remainder};
}

template <class Operation>
Range hull_of_corners(const Range& a, const Range& b, Operation operation) {
    Range result{kInfinity, -kInfinity};
    for (const float x : {a.low, a.high}) {
        for (const float y : {b.low, b.high}) {
            const Exact corner = operation(x, y);
            result.low = std::min(result.low, down(corner));
            result.high = std::max(result.high, up(corner));
        }
    }
    return result;
}

/// The error of the root has the sign of x - root^2, which fma computes exactly.
Exact exact_root(float a) {
    const double x = a, root = std::sqrt(x);
    return {root, std::fma(-root, root, x)};
}

}  // namespace

Range negate(const Range& a) {
    return {0.0F - a.high, 0.0F - a.low};  // 0 rather than -0
}

Range add(const Range& a, const Range& b) {
    return {down(sum(a.low, b.low)), up(sum(a.high, b.high))};
}

Range subtract(const Range& a, const Range& b) {
    return add(a, negate(b));
}

Range multiply(const Range& a, const Range& b) {
    return hull_of_corners(a, b, product);
}

Range divide(const Range& a, const Range& b) {
    if (b.contains(0.0F)) return kEverything;
    return hull_of_corners(a, b, exact_quotient);
}

Range abs(const Range& a) {
    if (a.low >= 0) return a;
    if (a.high <= 0) return negate(a);
    return {0.0F, std::max(-a.low, a.high)};
}

Range sqrt(const Range& a) {
    if (a.high < 0) return kEverything;
    return {down(exact_root(std::max(a.low, 0.0F))), up(exact_root(a.high))};
}

Range min(const std::vector<Range>& ranges) {
    Range result = ranges.front();
    for (const Range& range : ranges)
        result = {std::min(result.low, range.low), std::min(result.high, range.high)};
    return result;
}

Range max(const std::vector<Range>& ranges) {
    Range result = ranges.front();
    for (const Range& range : ranges)
        result = {std::max(result.low, range.low), std::max(result.high, range.high)};
    return result;
}

}  // namespace etlc::check
