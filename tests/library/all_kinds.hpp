// A spec with what random specs lack.
#pragma once

namespace etlc::tests {

/// Has projections, weights, narrow embeddings, lets, and a nesting
/// that is evaluated again at every step.
inline constexpr const char* kAllKinds = R"(spec kinds;
input z : f32[3] hold 2;
input h : f16[2];
input b : i8[2] scale 0.25;
input x : f32 in [0, 9];
input f : bool;
projection P = [[1, 0, 0], [0, 1, 1]];
target t = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
target u = [[0, 1], [1, 1], [2, 0]];
target w = [[0, 0], [1, 1]] of P(z);
predicate weighed = min mahalanobis([[2, 0.5, 0], [0.5, 1, 0], [0, 0, 1]])(z, t) <= 1;
predicate mapped = min l2(P(z), w) <= 1;
predicate third = kth(2) cosine(h, u) <= 0.5;
predicate apart = min l2(z, t) - max l1(z, t) <= 0.5;
predicate bytes = mean linf(b, u) <= 1;
let both = mapped && third;
repeating monitor a = F (weighed && F[0, 3] (both U[0, 2] f));
monitor c = G (bytes -> (F[0, 4] (apart && F[1, 3] f)));
restartable monitor d = G (F[0, 6] (weighed && G[0, 4] (x > 1 -> F[0, 3] both)));
sliding monitor e = G[0, 5] (third || O[0, 7] bytes);
)";

}  // namespace etlc::tests
