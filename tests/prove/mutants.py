#!/usr/bin/env python3
"""mutants.py ETLC RUNTIME FOLDER COUNT [VALUES]: changes headers; `etlc prove` judges them.

Each of COUNT mutants (times ETLC_EFFORT) differs from a header of specs/ in one place of its
temporal part: an index, a bound, min for max, one end for the other, a reset left out. One that is
refuted has to give, on the input that is shown, other verdicts than the header, whose verdicts are
those of `etlc run`; one that is proved has to give the same verdicts as the header on random
inputs. VALUES: robustness or boolean.
"""
import csv
import os
import pathlib
import random
import re
import subprocess
import sys

STEPS = 24
SWAPS = [("min_of(", "max_of("), ("kTrue", "kFalse"), ("kTop", "kBottom"), (".low", ".high"),
         ("Greatest<", "Least<"), ("Since<", "Trigger<"), ("Until<", "Release<"), (">=", ">"),
         ("<=", "<"), ("kYes", "kNo"), (" && !", " || !"),
         ("AtLeast<", "AllBut<"), ("now.p", "now.q"), ("now.q", "now.p")]


def temporal_part(text):
    """Yields the begin and end of the lines whose changes the proof is about."""
    is_boolean = "Monitor::advance(" in text  # whose step measures before it judges
    judge = text.rindex("etlmon::is_") if is_boolean else text.index("Monitor::judge(")
    reset = text.index("constexpr void reset() noexcept {")
    private = text.index(" private:")
    for begin, end in ((reset, text.index("\n  }\n", reset)),
                       (private, text.index("static_assert(sizeof(Monitor)")),
                       (judge, text.rindex("}  // namespace ETLMON_BUILD"))):
        at = begin
        for line in text[begin:end].splitlines(keepends=True):
            yield at, at + len(line.split("//")[0].rstrip())
            at += len(line)


def changes(text):
    """Lists the changes of a header: begin, end, replacement."""
    found = []
    measured = re.compile(r"float |Hold<|incomplete_|missing|finishes_ !=|_verdict_ =|UINT32_MAX|"
                          r"count")
    for begin, end in temporal_part(text):
        line = text[begin:end]
        if measured.search(line):
            continue
        for one, other in SWAPS:
            for old, new in ((one, other), (other, one)):
                found += [(begin + m.start(), begin + m.end(), new)
                          for m in re.finditer(re.escape(old), line)]
        for m in re.finditer(r"(?<![\w.])\d+(?![\w.])", line):
            for new in (int(m.group()) + 1, int(m.group()) - 1):
                if new >= 0:
                    found.append((begin + m.start(), begin + m.end(), str(new)))
        if re.match(r"\s+\w+_ = .*;$", line) or re.match(r"\s+\w+\.reset\(.*\);$", line):
            found.append((begin, end, ""))
        found += [(begin + m.start(), begin + m.end(), "")
                  for m in re.finditer(r"-(?=unseen_)", line)]
    return sorted(set(found))


PROGRAM = r"""
#include "%(header)s"
#include <stdio.h>
#include <stdlib.h>
#include <string>
#include <vector>
using namespace %(name)s;
static void show(int step, const Verdicts& all) {
  for (const auto& [name, v] : named(all))
    if (v.decided())
      printf("%%d,%%s,%(format)s%%d\n", step, name, %(numbers)s static_cast<int>(v.status));
    else
      printf("%%d,%%s,undecided\n", step, name);
}
static float number(const char*& at) {
  if (*at == ',' || *at == '\n' || *at == '\0') return etlmon::kMissing;
  char* end = nullptr;
  const float x = strtof(at, &end);
  at = end;
  return x;
}
int main(int, char** words) {
  FILE* const file = fopen(words[1], "r");
  const int finishes = atoi(words[2]);
  char line[200];
  Monitor* monitor = new Monitor;
  int step = 0;
  while (fgets(line, sizeof line, file)) {
    if (line[0] == '#') {  // a new trace
      monitor->reset();
      step = 0;
      continue;
    }
    const char* at = line;
    Inputs in;
    in.x = number(at);
    if (*at == ',') ++at;
    in.y = number(at);
    if (*at == ',') ++at;
    const float on = number(at);
    if (on == on) in.on = on > 0;
    show(step++, monitor->step(in));
    if (finishes) {
      Monitor copy = *monitor;
      for (int n = 0; n < finishes; ++n) show(step + n, copy.finish());
    }
  }
}
"""


class Header:
    """A generated header, its mutants, and what they say."""

    def __init__(self, etlc, runtime, spec, folder, values):
        self.etlc, self.runtime, self.spec, self.folder = etlc, runtime, spec, folder
        self.name = spec.stem
        self.options = ["--values", values]
        self.is_boolean = values == "boolean"
        self.path = folder / f"{self.name}_{values}.hpp"
        subprocess.run([etlc, spec, "-o", self.path] + self.options, check=True)
        self.text = self.path.read_text()
        self.program = self.build(self.path)

    def build(self, header):
        source = header.with_suffix(".cpp")
        numbers = "" if self.is_boolean else "v.lower, v.robustness, v.upper,"
        text = PROGRAM % {"header": header.name, "name": self.name, "numbers": numbers,
                          "format": "" if self.is_boolean else "%.9g,%.9g,%.9g,"}
        if "finish()" not in self.text:
            text = text.replace("show(step + n, copy.finish())", "continue")
        source.write_text(text)
        program = header.with_suffix(".out")
        subprocess.run(["c++", "-std=c++17", "-O0", "-w", "-I", self.runtime, source, "-o",
                        program], check=True)
        return program

    def prove(self, header, stem):
        compiler = header.with_suffix(".sh")  # puts the mutant in the place of the class
        compiler.write_text(f'#!/bin/sh\nfor to in */class.hpp; do cp "{header}" "$to"; done\n'
                            'exec c++ "$@"\n')
        compiler.chmod(0o755)
        result = subprocess.run([self.etlc, "prove", self.spec, "--steps",
                                 str(8 if self.is_boolean else STEPS), "--counterexample", stem]
                                + self.options, capture_output=True, text=True, check=False,
                                env={**os.environ, "CXX": str(compiler)})
        if "[E1201]" in result.stderr:
            return "wrong", result.stderr
        if "[E1202]" in result.stderr:
            return "refused", result.stderr
        return ("proved" if result.returncode == 0 else "failed"), result.stderr


def inputs_of(path):
    """Returns the rows of a counterexample without their head: the inputs x, y and on."""
    with open(path, encoding="utf-8") as file:
        rows = list(csv.reader(file))
    columns = [rows[0].index(name) if name in rows[0] else None
               for name in ("distance_p", "distance_q", "on")]
    return "".join(",".join("" if c is None else row[c] for c in columns) + "\n"
                   for row in rows[1:])


def random_inputs(seed):
    chosen = random.Random(seed)
    rows = ""
    for _ in range(60):
        rows += "#\n"
        for _ in range(STEPS):
            cells = [str(chosen.randint(-4, 4) / 4), str(chosen.randint(-4, 4) / 4),
                     str(chosen.randint(0, 1))]
            rows += ",".join(c if chosen.random() < 0.9 else "" for c in cells) + "\n"
    return rows


def say(program, rows, finishes):
    path = program.with_suffix(".rows")
    path.write_text(rows)
    return subprocess.run([program, path, str(finishes)], capture_output=True, text=True,
                          check=False).stdout


def run_of(header, stem):
    """Returns the verdicts that `etlc run` gives for a counterexample, by step and monitor."""
    result = subprocess.run([header.etlc, "run", f"{stem}.etl", "--trace", f"{stem}.csv",
                             "--finish"] + header.options,
                            capture_output=True, text=True, check=True)
    statuses = {"satisfied": 1, "violated": 2, "unknown": 0}
    return {(row["step"], row["monitor"]):
            [statuses[row["status"]] + 4 + 8 * int(row["final"])] if header.is_boolean
            else [float(row[name]) for name in ("lower", "robustness", "upper")]
            for row in csv.DictReader(result.stdout.splitlines())
            if row["status"] != "undecided"}


def agrees(said, ran, finishes):
    """Whether a program and `etlc run` say the same at and after the last step."""
    rows = [line.split(",") for line in said.splitlines()]
    monitors = len({row[1] for row in rows})
    rows = rows[-monitors * (1 + finishes):]
    return all(ran.get((row[0], row[1])) == [float(x) for x in row[2:5]]
               for row in rows if row[2] != "undecided")


def judge(header, change, number, folder):
    begin, end, new = change
    text = header.text[:begin] + new + header.text[end:]
    line = header.text.count("\n", 0, begin) + 1
    path = folder / f"mutant{number}.hpp"
    path.write_text(text)
    what = f"{header.path.stem}:{line}: '{header.text[begin:end].strip()}' becomes '{new}'"
    stem = folder / f"mutant{number}"
    verdict, message = header.prove(path, stem)
    if verdict == "refused" and "does not compile" in message:
        return "no class", what
    if verdict == "failed":
        raise SystemExit(f"FAILED: {what}: {message}")
    if verdict == "refused":
        return "refused", what + ": " + message.splitlines()[0]
    mutant = header.build(path)
    if verdict == "proved":
        rows = random_inputs(number)
        if say(mutant, rows, 3) != say(header.program, rows, 3):
            raise SystemExit(f"FAILED: {what}: proved, but its verdicts differ")
        return "harmless", what
    if not pathlib.Path(f"{stem}.csv").exists():
        return "wrong", what
    rows = inputs_of(f"{stem}.csv")
    found = re.search(r"(\d+) calls? of finish", message)
    finishes = int(found.group(1)) if found else 0
    later = random_inputs(number) + "#\n" + rows  # what reset() leaves out shows after a reset
    if all(say(mutant, given, finishes) == say(header.program, given, finishes)
           for given in (rows, later)):
        raise SystemExit(f"FAILED: {what}: the input shows no difference: {message}")
    if not agrees(say(header.program, rows, finishes), run_of(header, stem), finishes):
        raise SystemExit(f"FAILED: {what}: etlc run differs from the header")
    return "wrong", what


def main():
    etlc, runtime, folder, count = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]), sys.argv[4]
    count = int(count) * max(1, int(os.environ.get("ETLC_EFFORT", "1")))
    folder.mkdir(parents=True, exist_ok=True)
    specs = sorted((pathlib.Path(__file__).parent / "specs").glob("*.etl"))
    headers = [Header(etlc, runtime, spec, folder, values) for spec in specs
               for values in sys.argv[5:] or ["robustness"]]
    chosen = random.Random(1)
    candidates = [(header, change) for header in headers for change in changes(header.text)]
    chosen.shuffle(candidates)
    counts = {}
    for number, (header, change) in enumerate(candidates):
        if sum(n for kind, n in counts.items() if kind != "no class") >= count:
            break
        kind, what = judge(header, change, number, folder)
        counts[kind] = counts.get(kind, 0) + 1
        print(f"{kind:9} {what}", flush=True)
    print(f"of {sum(counts.values())} changes of {len(candidates)}: "
          + ", ".join(f"{n} {kind}" for kind, n in sorted(counts.items())))
    if counts.get("wrong", 0) == 0:
        raise SystemExit("FAILED: no fault was found")


if __name__ == "__main__":
    os.environ["LC_ALL"] = "C"
    main()
