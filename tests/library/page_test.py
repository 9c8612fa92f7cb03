#!/usr/bin/python3
"""The examples of a page print the output shown below them.

page_test.py PAGE c CC FLAG... | page_test.py PAGE python
With ETLC_UPDATE in the environment the page is updated with their output.
"""

import contextlib
import io
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

BLOCK = re.compile(r"^```(c|python)\n(.*?)^```\n(?:```text\n(.*?)^```\n)?", re.M | re.S)
END = "\x1e"  # separates the output of two examples


def run_c(blocks, words):
    """The first block is at file scope, the others are in main()."""
    source = blocks[0] + "int main(void) {\n"
    source += "".join(f'{block}\nprintf("%s", "\\x1e");\n' for block in blocks[1:]) + "}\n"
    Path("page.c").write_text(source)
    subprocess.run([words[0], "-std=c99", "-Wall", "-Wextra", "-Werror", "page.c", "-o", "page",
                    *words[1:]], check=True)  # fmt: skip
    ran = subprocess.run(["./page"], capture_output=True, text=True)
    if ran.returncode != 0:
        sys.exit(f"the examples end with {ran.returncode}: {ran.stderr}")
    return [""] + ran.stdout.split(END)[:-1]


def run_python(blocks, _):
    names, printed = {}, []
    for block in blocks:
        text = io.StringIO()
        with contextlib.redirect_stdout(text):
            exec(block, names)
        printed.append(text.getvalue())
    return printed


def main(page, kind, *words):
    path = Path(page).resolve()
    text = path.read_text()
    examples = [match for match in BLOCK.finditer(text) if match[1] == kind]
    with tempfile.TemporaryDirectory() as box:
        os.chdir(box)
        run = {"c": run_c, "python": run_python}[kind]
        printed = run([match[2] for match in examples], words)
        os.chdir("/")
    if len(printed) != len(examples) or not examples:
        sys.exit(f"{len(examples)} examples, {len(printed)} of them ran")
    new = text
    for match, found in reversed(list(zip(examples, printed))):
        if found == (match[3] or ""):
            continue
        if "ETLC_UPDATE" not in os.environ or match[3] is None:
            sys.exit(f"{page}: this example\n{match[2]}prints\n{found}not\n{match[3]}")
        new = new[: match.start(3)] + found + new[match.end(3) :]
    if new != text:
        path.write_text(new)
    print(f"{len(examples)} examples")


if __name__ == "__main__":
    main(*sys.argv[1:])
