"""keystrokes.py ETLC [LINES]: the waiting time of a user of `etlc lsp` on a spec of LINES lines
(1000).

A script types a formula letter by letter, and waits for the diagnostics after each; then it
requests hovers, definitions and completions. Prints milliseconds; processor time is the
server's own, which other programs hardly affect.
"""
import os
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "tests/lsp"))
from client import Client  # noqa: E402


def spec_of(lines):
    """Inputs, targets, predicates, lets and monitors in the proportions of a large spec."""
    text = ["spec large;", "rate 20 Hz;", "const limit = 0.25;"]
    for i in range(20):
        text.append(f"input z{i} : f32[8] hold 3;  // camera {i}")
        text.append(f"target t{i} = [[{', '.join(str((i + j) % 7) + '.5' for j in range(8))}]];")
    i = 0
    while len(text) < lines - 1:
        text += [f"input x{i} : f32 in [0, 1];",
                 f"predicate near{i} = min cosine(z{i % 20}, t{i % 20}) <= limit;",
                 f"predicate high{i} = 2 * x{i} + x{i // 2} >= 0.7{i};",
                 f"// what the arm does in phase {i}",
                 f"let busy{i} = near{i} && !high{i // 2} || high{i} S[0, 2 s] near{i // 3};",
                 f"let calm{i} = busy{i} -> near{i // 2} U[0, 10] high{i};"]
        if i % 4 == 0:
            text.append(f"sliding monitor steady{i} = G[0, 0.5 s] (calm{i} || F[0, 3] near{i});")
        i += 1
    return "\n".join(text[:lines - 1]) + "\n"


def row(name, seconds):
    seconds = sorted(1000 * s for s in seconds)
    p95 = seconds[min(len(seconds) - 1, int(0.95 * len(seconds)))]
    print(f"{name:12} n = {len(seconds):4}  median {seconds[len(seconds) // 2]:6.1f}  "
          f"p95 {p95:6.1f}  largest {seconds[-1]:6.1f}")


def processor_seconds(client):
    fields = pathlib.Path(f"/proc/{client.process.pid}/stat").read_text().rsplit(")")[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main():
    lines = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    client = Client(sys.argv[1])
    spec = spec_of(lines)
    start = time.perf_counter()
    text = client.open(spec)
    found = client.diagnostics()
    print(f"{spec.count(chr(10)) + 1} lines, {len(spec)} bytes, {len(found)} findings; "
          f"opened in {1000 * (time.perf_counter() - start):.1f} ms")

    line, waits = spec.count("\n"), []
    typed = "monitor typed = G (near1 -> F[0, 0.5 s] (high2 && busy3)) && min l2(z1, t1) < limit;"
    before = processor_seconds(client)
    for _ in range(3):
        for column, letter in enumerate(typed):
            start = time.perf_counter()
            at = {"line": line, "character": column}
            text.change([{"range": {"start": at, "end": at}, "text": letter}])
            client.diagnostics()
            waits.append(time.perf_counter() - start)
        text.change([{"range": {"start": {"line": line, "character": 0},
                                "end": {"line": line + 1, "character": 0}}, "text": ""}])
        client.diagnostics()
    row("key stroke", waits)
    print(f"{1000 * (processor_seconds(client) - before) / len(waits):.1f} of the processor each")

    for method, words in [("hover", "near30 ="), ("definition", "near1 "),
                          ("completion", "U[0, 10] high2")]:
        waits = []
        for _ in range(50):
            start = time.perf_counter()
            text.ask(method, words, 2)
            waits.append(time.perf_counter() - start)
        row(method, waits)
    client.end()


main()
