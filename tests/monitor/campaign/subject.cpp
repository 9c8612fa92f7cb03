#include "subject.hpp"

#include <algorithm>

#include "random.hpp"
#include "random_trace.hpp"

namespace etlc::tests {

Subject subject(std::uint64_t campaign, std::uint64_t n, int monitors) {
    Subject result;
    result.seed = campaign * 1'000'000'007 + n;
    result.shape.formulas = n % 4 == 3 ? SpecShape::Formulas::sliding : SpecShape::Formulas::prefix;
    result.shape.monitors = monitors;
    result.shape.window = n / 4 % 2 == 0 ? kLongWindow : kShortWindow;
    if (n / 8 % 2 == 1) result.shape.future = kMostlyFuture;
    result.shape.depth = 1 + static_cast<int>(n / 16 % kDepths);
    result.shape.restarts = 0.4;
    result.shape.missing = 0.2;
    if (n / 16 / kDepths % 4 == 3) result.values = check::Values::boolean;
    return result;
}

reference::Trace subject_trace(const check::Model& model, const Subject& subject, int t,
                               std::size_t longest) {
    Random random(subject.seed * 31 + static_cast<std::uint64_t>(t));
    // Most traces are short: brute force over 200 steps costs 1000 times that over 20.
    const double share = random.uniform();
    TraceShape shape;
    shape.steps = 1 + static_cast<std::size_t>(
                          share * share * share * static_cast<double>(longest - 1) + 0.5);
    if (t % 3 > 0) shape.missing = 0.05 + 0.3 * random.uniform();
    if (t % 3 > 1) shape.invalid = 0.1;
    return random_trace(model, subject.seed * 37 + static_cast<std::uint64_t>(t), shape);
}

reference::Trace continuation(const check::Model& model, const reference::Trace& trace,
                              std::uint64_t seed) {
    Random random(seed);
    const auto cut =
        static_cast<std::size_t>(random.between(0, static_cast<int>(trace.size()) - 1)) + 1;
    TraceShape shape;
    shape.steps = static_cast<std::size_t>(random.between(1, 60));
    shape.extreme = random.uniform();
    if (random.chance(0.3)) shape.missing = 0.2;
    const reference::Trace rest = random_trace(model, seed, shape);
    reference::Trace result(trace.begin(), trace.begin() + static_cast<std::ptrdiff_t>(cut));
    result.insert(result.end(), rest.begin(), rest.end());
    return result;
}

}  // namespace etlc::tests
