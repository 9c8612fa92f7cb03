#!/usr/bin/python3
"""Makes the wheel: the package, libetlc, the command, and the libraries that these load.

make_wheel.py PYPROJECT LIBRARY COMMAND PROGRAM... FOLDER: the wheel goes into FOLDER.
Needs setuptools and wheel, patchelf, which makes each file look for libraries beside it, and
binutils, whose objdump tells which machines the wheel is for.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

# Present on every Linux that Python runs on: glibc, and the libraries of its compiler.
THERE = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|resolv|gcc_s|stdc\+\+))\.so[.\d]*$")


def output_of(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True).stdout


def libraries_of(program):
    """Returns the libraries that a file loads, as paths by name."""
    lines = (line.split() for line in output_of("ldd", program).splitlines())
    found = {words[0]: words[2] for words in lines if len(words) > 2 and words[1] == "=>"}
    lost = [name for name, path in found.items() if not path.startswith("/")]
    if lost:
        sys.exit(f"{program} needs {', '.join(lost)}, which is not there")
    return {name: path for name, path in found.items() if not THERE.match(name)}


def stage(folder, library, command, programs):
    """Copies the native files below `folder`, with paths that hold wherever it is unpacked."""
    places = {
        library: (folder / "lib" / "libetlc.so.1", "$ORIGIN"),
        command: (folder / "bin" / "etlc", "$ORIGIN/../lib"),
    }
    for program in programs:
        places[program] = (folder / "libexec" / "etlc" / Path(program).name, "$ORIGIN/../../lib")
    for program in list(places):
        for name, path in libraries_of(program).items():
            places[path] = (folder / "lib" / name, "$ORIGIN")
    for path, (place, run_path) in places.items():
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(path, place)
        place.chmod(0o755)
        subprocess.run(["strip", "--strip-unneeded", place], check=True)
        subprocess.run(["patchelf", "--set-rpath", run_path, place], check=True)


# A C++ library, and the C library of the oldest distribution that has it (as auditwheel has them).
CXX = {28: 31, 29: 34, 30: 35, 31: 37, 32: 38, 33: 40}


def platform(folder):
    """Returns the tag (PEP 600) of the machines that these files run on, by their symbols."""
    files = [file for file in folder.rglob("*") if file.is_file()]
    symbols = output_of("objdump", "-T", *files)
    c = max(int(minor) for minor in re.findall(r"\bGLIBC_2\.(\d+)", symbols))
    cxx = max(int(patch) for patch in re.findall(r"\bGLIBCXX_3\.4\.(\d+)", symbols))
    if cxx > max(CXX):
        sys.exit(f"GLIBCXX_3.4.{cxx} is needed: which C library comes with it?")
    oldest = max(c, CXX[max(cxx, min(CXX))])
    return f"manylinux_2_{oldest}_{os.uname().machine}"


def main(pyproject, library, command, *programs, folder):
    here = Path(__file__).parent
    with tempfile.TemporaryDirectory() as box:
        source = Path(box)
        shutil.copytree(here / "etlc", source / "etlc", ignore=shutil.ignore_patterns("__pyc*"))
        shutil.copytree(here / "bin", source / "bin")
        stage(source / "etlc" / "_native", library, command, programs)
        shutil.copy(pyproject, source)
        shutil.copy(here / "setup.py", source)
        dist = Path(folder)
        for old in dist.glob("etlc-*.whl"):
            old.unlink()
        environment = {"SOURCE_DATE_EPOCH": "315619200", **os.environ}  # the same bytes each time
        subprocess.run(
            [sys.executable, "setup.py", "--quiet", "bdist_wheel", "--dist-dir", dist.absolute(),
             "--plat-name", platform(source / "etlc" / "_native")],
            check=True, cwd=source, env=environment,
        )  # fmt: skip
        print(*dist.glob("etlc-*.whl"))


if __name__ == "__main__":
    main(*sys.argv[1:-1], folder=sys.argv[-1])
