#!/usr/bin/env bash
# bounds_test.sh ETLC CXX: the bounds of prefix monitors hold on every continuation, which users of
# final verdicts rely on. At each step lower <= robustness <= upper, and no number of a later step
# leaves [lower, upper]. The test covers every distance, aggregation, type of input and storage of
# targets, with and without declared ranges, in `etlc run` and in generated classes. The points are
# at the extremes of distances: a target, its negative, an orthogonal one, zero, tiny and huge ones.
. "$(dirname "$0")/../box.bash"
etlc=$1 cxx=$2

# The rows of a set are multiples of one vector, so that every aggregation reaches the ends of the
# range; there are 25 of them, since the mean of so many angles pi is rounded above pi. Numbers are
# multiples of 1/4, so a sample may equal a target in every type of input.
awk 'BEGIN {
  print "spec bounds;\ninput z : f32[3];\ninput h : f16[3];\ninput i : i8[3] scale 0.25;"
  print "input w : f32[70];"
  print "input x : f32 in [0, 7.3];\ninput y : f32 in [-2.1, 7.3];\ninput v : f32;"
  printf "target few = ["
  for (k = 1; k <= 25; ++k) printf "%s[%g, %g, %g]", (k > 1 ? ", " : ""), k / 4, -k / 2, 3 * k / 4
  printf "];\ntarget wide = ["
  for (k = 1; k <= 9; ++k) {
    printf "%s[", (k > 1 ? ", " : "")
    for (n = 0; n < 70; ++n) printf "%s%g", n ? ", " : "", k * ((n * 7 + 3) % 11 - 5) / 4
    printf "]"
  }
  print "];"
  split("l2 l2sq l1 linf cosine angular mahalanobis([2,0.5,3]) " \
        "mahalanobis([[2,0.5,0],[0.5,1,0],[0,0,3]])", metrics, " ")
  split("min max mean kth(2)", aggregations, " ")
  for (m = 1; m in metrics; ++m) for (a = 1; a in aggregations; ++a) {
    predicate(aggregations[a] " " metrics[m] "(z, few)", m == 5 ? 1 : m == 6 ? 1.6 : 4)
    if (m >= 5 && m <= 6) {
      predicate(aggregations[a] " " metrics[m] "(h, few)", 1)
      predicate(aggregations[a] " " metrics[m] "(i, few)", 2)
    }
    if (m == 5 || m == 6 || m <= 2)
      predicate(aggregations[a] " " metrics[m] "(w, wide)", m >= 5 ? 1.2 : 30)
    if (a == 1 && m <= 6) predicate("min " metrics[m] "([x, y, v], few)", 1)
  }
  predicate("sqrt(x)", 1.5)
  predicate("sqrt(x * x + y * y) / 3", 1.5)
  predicate("min cosine(z, few) - min angular(z, few)", 0)
  predicate("sqrt(max angular(z, few))", 1)
  predicate("abs(y) / (x + 0.1)", 2)
  predicate("max(x, y) - mean angular(h, few)", 2)
  for (p = 2; p <= n_predicates; p += 3) {
    printf "monitor u%d = p%d U p%d;\nmonitor r%d = p%d R p%d;\n", p, p - 1, p, p, p - 1, p
    if (p % 4 != 0) continue
    printf "monitor n%d = G (p%d -> F[0, 2] p%d);\n", p, p - 1, p
    printf "monitor o%d = F (p%d && G[1, 3] !p%d) || O p%d;\n", p, p - 1, p, p
  }
}
function predicate(of, than) {
  p = ++n_predicates
  printf "predicate p%d = %s %s %g;\n", p, of, p % 2 ? "<=" : ">", than
  printf "monitor g%d = G p%d;\nmonitor f%d = F p%d;\n", p, p, p, p
}' >bounds.etl

# ---- etlc run
trace() {  # SEED: 60 steps
  awk -v seed="$1" 'BEGIN {
    srand(seed)
    for (n = 0; n < 3; ++n) header = header (n ? "," : "") "z[" n "]"
    for (n = 0; n < 3; ++n) header = header ",h[" n "]"
    for (n = 0; n < 3; ++n) header = header ",i[" n "]"
    for (n = 0; n < 70; ++n) header = header ",w[" n "]"
    print header ",x,y,v"
    few[0] = 1; few[1] = -2; few[2] = 3; across[0] = 2; across[1] = 1; across[2] = 0
    for (n = 0; n < 70; ++n) wide[n] = (n * 7 + 3) % 11 - 5
    for (t = 0; t < 60; ++t) {
      line = ""
      for (of = 0; of < 4; ++of) {
        kind = int(9 * rand()); length_of = of == 3 ? 70 : 3
        for (n = 0; n < length_of; ++n) {
          g = of == 3 ? wide[n] : few[n]
          if (kind < 2) q = -g
          else if (kind == 2) q = g
          else if (kind == 3) q = 0
          else if (kind == 4) q = of != 3 ? across[n] : n % 2 ? wide[n - 1] : -wide[n + 1]
          else q = int(25 * rand()) - 12
          if (kind == 8) cell = ""
          else if (of == 2) cell = q
          else if (of != 1 && kind == 6) cell = -g * 1e-22
          else if (of != 1 && kind == 7) cell = -g * 3e37
          else cell = q / 4
          line = line (line == "" && n == 0 ? "" : ",") cell
        }
      }
      x = rand() < 0.3 ? 7.3 : rand() < 0.5 ? 0 : 7.3 * rand()
      y = rand() < 0.3 ? 7.3 : rand() < 0.5 ? -2.1 : rand()
      v = rand() < 0.2 ? "-3e38" : 4 * rand() - 2
      print line "," x "," y "," v
    }
  }'
}
held() {  # TRACE'S VERDICTS
  awk -F, 'function number(text) {
    return text == "inf" ? 1e300 : text == "-inf" ? -1e300 : text + 0
  }
  NR > 1 {
    lower = number($3); robustness = number($4); upper = number($5); ++lines
    if (!($2 in low)) { low[$2] = -1e300; high[$2] = 1e300 }
    if (lower > robustness || robustness > upper || lower < low[$2] || upper > high[$2]) {
      printf "step %s, %s: [%s, %s] with %s, after [%.9g, %.9g]\n", $1, $2, $3, $5, $4, low[$2],
          high[$2]
      bad = 1
      if (++told == 5) exit
    }
    low[$2] = lower; high[$2] = upper
  } END { exit bad || lines < 1000 }' "$1"
}
for seed in 1 2 3 4; do
  trace $seed >trace.csv
  for storage in f32 f16 i8; do
    "$etlc" run bounds.etl --trace trace.csv --targets-as $storage -o verdicts.csv 2>/dev/null
    held verdicts.csv || fail "etlc run, targets as $storage, trace $seed"
  done
done

# ---- generated classes
cat >main.cpp <<'END'
#include <cstdio>
#include <cstring>
#include <random>

#include "bounds.hpp"

namespace {

std::mt19937 source(1);
int below(int n) {
    return static_cast<int>(source() % static_cast<unsigned>(n));
}

/// A float16 that is a multiple of 1/4 below 64.
uint16_t half(float x) {
    const uint32_t bits = etlmon::bits_of(x);
    if (bits << 1 == 0) return 0;
    return static_cast<uint16_t>((bits >> 16 & 0x8000u) | ((bits >> 13 & 0x3ffffu) - (112u << 10)));
}

/// In quarters; false: missing.
template <int N>
bool point(float (&to)[N], const float (&g)[N], bool wide) {
    const int kind = below(9);
    for (int n = 0; n < N; ++n) {
        to[n] = kind < 2    ? -g[n]
                : kind == 2 ? g[n]
                : kind == 3 ? 0.0f
                            : static_cast<float>(below(25) - 12);
        if (kind == 4) to[n] = n % 2 == 1 ? g[n - 1] : n + 1 < N ? -g[n + 1] : 0.0f;
        if (wide && kind == 6) to[n] = -g[n] * 1e-22f;
        if (wide && kind == 7) to[n] = -g[n] * 3e37f;
        to[n] /= 4.0f;
    }
    return kind != 8;
}

float scalar(float low, float high) {
    const int kind = below(4);
    return kind == 0   ? low
           : kind == 1 ? high
                       : low + (high - low) * static_cast<float>(below(1000)) / 999.0f;
}

constexpr std::size_t kMonitors = sizeof(bounds::Verdicts) / sizeof(etlmon::Verdict);

}  // namespace

int main() {
    const float few[3] = {1.0f, -2.0f, 3.0f};
    float wide[70];
    for (int n = 0; n < 70; ++n) wide[n] = static_cast<float>((n * 7 + 3) % 11 - 5);
    int bad = 0;
    for (int episode = 0; episode < 40; ++episode) {
        bounds::Monitor monitor;
        etlmon::Key low[kMonitors], high[kMonitors];
        for (std::size_t m = 0; m < kMonitors; ++m)
            low[m] = etlmon::kBottom, high[m] = etlmon::kTop;
        for (int step = 0; step < 20; ++step) {
            bounds::Inputs in;
            float z[3], h[3], i[3], w[70];
            uint16_t halves[3];
            int8_t bytes[3];
            if (point(z, few, true)) in.z = z;
            if (point(h, few, false)) in.h = halves;
            if (point(i, few, false)) in.i = bytes;
            if (point(w, wide, true)) in.w = w;
            for (int n = 0; n < 3; ++n)
                halves[n] = half(h[n]), bytes[n] = static_cast<int8_t>(4.0f * i[n]);
            in.x = scalar(0.0f, 7.3f), in.y = scalar(-2.1f, 7.3f),
            in.v = below(4) == 0 ? -3e38f : scalar(-2.0f, 2.0f);
            const bounds::Verdicts verdicts = monitor.step(in);
            etlmon::Verdict all[kMonitors];
            std::memcpy(static_cast<void*>(all), &verdicts, sizeof all);
            for (std::size_t m = 0; m < kMonitors; ++m) {
                const etlmon::Key lower = etlmon::key_of(all[m].lower),
                                  rho = etlmon::key_of(all[m].robustness),
                                  upper = etlmon::key_of(all[m].upper);
                if ((lower > rho || rho > upper || lower < low[m] || upper > high[m]) && bad++ < 5)
                    std::printf(
                        "episode %d, step %d, monitor %d: [%.9g, %.9g] with %.9g, after [%.9g, "
                        "%.9g]\n",
                        episode, step, static_cast<int>(m), double(all[m].lower),
                        double(all[m].upper), double(all[m].robustness),
                        double(etlmon::float_of(low[m])), double(etlmon::float_of(high[m])));
                low[m] = lower, high[m] = upper;
            }
        }
    }
    return bad == 0 ? 0 : 1;
}
END
while read -r storage flags; do
  "$etlc" bounds.etl --targets-as $storage -o bounds.hpp 2>/dev/null
  # shellcheck disable=SC2086
  "$cxx" -std=c++17 $flags -DETLMON_NO_DISPATCH -I "$runtime" -I . main.cpp -o compiled
  ./compiled || fail "generated code, targets as $storage, $flags"
done <<'END'
f32 -O1 -ffast-math
f16 -O1
i8 -O1 -ffast-math
END
