#!/usr/bin/env python3
"""phases.py ETLC RUNTIME [PHASES...]: prints what chains of so many phases cost, as tables.

RUNTIME is the folder runtime/include. Times are the least of three runs, in seconds.
"""
import pathlib
import subprocess
import sys
import tempfile
import time

KINDS = {
    "F (a && F (b && ...))": ("F ({} && {})", "F {}"),
    "a U (b U (c U ...))": ("({} U {})", "{}"),
}
USER = '''#include "chain.hpp"
auto step(chain::Monitor& m, const chain::Inputs& in) { return m.step(in); }
'''


def spec(link, end, phases):
    inputs = "".join(
        f"input x{n} : f32 in [-10, 10];\npredicate p{n} = x{n} >= 0;\n" for n in range(phases)
    )
    formula = end.format(f"p{phases - 1}")
    for n in reversed(range(phases - 1)):
        formula = link.format(f"p{n}", formula)
    return f"spec chain;\n{inputs}monitor m = {formula};\n"


def timed(command):
    times = []
    for _ in range(3):
        begin = time.perf_counter()
        subprocess.run(command, check=True, capture_output=True)
        times.append(time.perf_counter() - begin)
    return min(times)


def row(etlc, runtime, folder, text):
    file, header, user = (folder / name for name in ("chain.etl", "chain.hpp", "user.cpp"))
    file.write_text(text)
    user.write_text(USER)
    etlc_time = timed([etlc, file, "-o", header])
    compiler = ["g++", "-std=c++17", "-O2", "-I", runtime, "-c", user, "-o", folder / "user.o"]
    gcc_time = timed(compiler)
    report = subprocess.run(
        [etlc, file, "--emit", "report"], check=True, capture_output=True, text=True
    ).stdout
    part = next(line for line in report.splitlines() if line.split()[:1] == ["m"])
    state, _, operations, _ = part.split()[-4:]
    lines = len(header.read_text().splitlines())
    return f"{operations} | {state} | {lines} | {etlc_time:.2f} | {gcc_time:.2f}"


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    etlc, runtime = sys.argv[1:3]
    counts = [int(text) for text in sys.argv[3:]] or [1, 2, 4, 8, 16, 17, 32, 64, 128, 256]
    for kind, (link, end) in KINDS.items():
        print(f"\n| `{kind}` | operations | state, bytes | lines of the header | etlc | g++ -O2 |")
        print("| --- | --- | --- | --- | --- | --- |")
        for phases in counts:
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder)
                try:
                    cells = row(etlc, runtime, path, spec(link, end, phases))
                except subprocess.CalledProcessError:
                    cells = "refused | | | |"
                print(f"| {phases} | {cells} |", flush=True)


main()
