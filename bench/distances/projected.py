#!/usr/bin/python3
"""Compares full mahalanobis with the same metric as a projection and l2, in generated code.

projected.py ETLC RUNTIME [ELEMENTS [TARGETS]]: M = A^T A, so mahalanobis(M)(z, t) is
l2(A(z), A t). Prints microseconds per step of both classes, the minimum of nine rounds in turns,
and the difference of their distances.
"""

import pathlib
import subprocess
import sys
import tempfile

import numpy as np

HEAD = 'spec {0}; input z : f32[{1}]; target t = load("t.npy"); monitor m = F {2};\n'
MAIN = """
#include <cmath>
#include <cstdio>
#include <ctime>
#include <random>
#include <vector>
#include "full.hpp"
#include "projected.hpp"
constexpr int kSteps = 200;
constexpr std::size_t kElements = ELEMENTS;
template <class Inputs, class Monitor>
double step(Monitor& monitor, const std::vector<float>& z, std::vector<float>& distances) {
  const std::clock_t begin = std::clock();
  for (int i = 0; i < kSteps; ++i) {
    Inputs in;
    in.z = decltype(in.z)::unchecked(&z[kElements * static_cast<std::size_t>(i)]);
    monitor.step(in);
    distances.push_back(monitor.distance_p());
  }
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / kSteps * 1e6;
}
int main() {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::vector<float> z(kElements * kSteps);
  for (float& x : z) x = normal(random);
  static full::Monitor one;
  static projected::Monitor two;
  double least_one = 1e9, least_two = 1e9, apart = 0;
  for (int round = 0; round < 9; ++round) {
    std::vector<float> a, b;
    least_one = std::fmin(least_one, step<full::Inputs>(one, z, a));
    least_two = std::fmin(least_two, step<projected::Inputs>(two, z, b));
    for (std::size_t i = 0; i < a.size(); ++i)
      apart = std::fmax(apart, std::fabs(a[i] - b[i]) / b[i]);
  }
  std::printf("full %.2f us, projection and l2 %.2f us: %.0f times; at most %.1g apart\\n",
              least_one, least_two, least_one / least_two, apart);
}
"""


def main(etlc, runtime, elements=128, targets=240):
    elements, targets = int(elements), int(targets)
    random = np.random.default_rng(0)
    a = random.normal(size=(elements, elements)).astype(np.float32) / np.float32(elements**0.5)
    metric = a.T.astype(float) @ a.astype(float)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        np.save(folder / "a.npy", a)
        np.save(folder / "m.npy", ((metric + metric.T) / 2).astype(np.float32))
        np.save(folder / "t.npy", random.normal(size=(targets, elements)).astype(np.float32))
        distance = 'min mahalanobis(load("m.npy"))(z, t)'
        for spec, declared, distance in (
            ("full", "", distance),
            ("projected", 'projection A = load("a.npy");\n', "min l2(A(z), t)"),
        ):
            text = HEAD.format(spec, elements, "p") + declared + f"predicate p = {distance} <= 5;\n"
            (folder / f"{spec}.etl").write_text(text)
            limits = ["--inline-targets", "1000000000", "--max-code", "100000000"]
            call = [etlc, f"{spec}.etl", "-o", f"{spec}.hpp", *limits]
            subprocess.run(call, cwd=folder, check=True)
        (folder / "main.cpp").write_text(MAIN.replace("ELEMENTS", str(elements)))
        build = ["g++", "-std=c++17", "-O2", "-I", runtime, "main.cpp", "-o", "main"]
        subprocess.run(build, cwd=folder, check=True)
        subprocess.run([folder / "main"], check=True)


main(*sys.argv[1:])
