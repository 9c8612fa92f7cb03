#!/usr/bin/env bash
# consumer_test.sh BUILD_DIR CMAKE CXX GENERATOR: installs etlc under a new prefix. A project
# outside the source tree finds it, builds monitors with it and runs them; so does one for a board
# without dynamic linking. A changed target rebuilds only its own header. What ./demo.sh configures
# is installed once all of it is built, as README.md says, and nothing is before.
set -euo pipefail
build_dir=$1 cmake=$2 cxx=$3 generator=$4
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT

fail() { echo "FAILED: $*"; exit 1; }
expect() { [ "$1" = "$2" ] || fail "expected '$2', found '$1'"; }
compile() { "$cmake" --build "$box/build" >"$box/log" 2>&1 ||
    { cat "$box/log"; fail "the consumer does not build"; }; }
# Make may compare time stamps in whole seconds, so a changed file must be clearly newer than its
# outputs.
change() { sleep 1.1; "$@"; }

"$cmake" --install "$build_dir" --prefix "$box/prefix" >"$box/log" 2>&1 ||
    { cat "$box/log"; fail "cmake --install"; }
# Every link of an installed page leads to an installed file.
pages=$box/prefix/share/doc/etlc
find "$pages" -name '*.md' | while read -r page; do
    sed '/^```/,/^```/d' "$page" | grep -oP '\]\(\K[^)#\s]+|^\[[^]]+\]: \K\S+' | grep -v '://' |
        while read -r link; do
            [ -e "$(dirname "$page")/$link" ] || echo "${page#"$pages"/} links to $link"
        done || true
done >"$box/dead"
[ ! -s "$box/dead" ] || fail "installed pages: $(cat "$box/dead")"

# The Python package under a prefix finds the library and the command of that prefix, and no others.
if /usr/bin/python3 -c 'import numpy' 2>"$box/log"; then
    mv "$box/prefix" "$box/moved"
    said=$(env -u LD_LIBRARY_PATH -u ETLC_LIBRARY -u ETLC_COMMAND PYTHONDONTWRITEBYTECODE=1 \
        PYTHONPATH="$box/moved/lib/python3/dist-packages" /usr/bin/python3 -c 'import etlc
monitor = etlc.Monitor(text="spec t; input x : f32; monitor m = F x > 1;")
print(monitor.monitors, etlc._library.library._name, etlc._process.command_path())')
    expect "$said" "('m',) $(echo "$box"/moved/lib*/libetlc.so.1) $box/moved/bin/etlc"
    expect "$(env -u ETLC_COMMAND PYTHONPATH="$box/moved/lib/python3/dist-packages" \
        PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -m etlc --version)" \
        "$("$box/moved/bin/etlc" --version)"
    mv "$box/moved" "$box/prefix"
fi

cp -r "$here/consumer" "$box/consumer"
cp "$box/consumer/specs/near.npy" "$box/consumer/specs/goal.npy"
odd="an odd (name)+"
cp "$box/consumer/specs/guard.etl" "$box/consumer/specs/$odd.etl"

"$cmake" -S "$box/consumer" -B "$box/build" -G "$generator" -DCMAKE_CXX_COMPILER="$cxx" \
    -DCMAKE_PREFIX_PATH="$box/prefix" \
    -DCMAKE_CXX_FLAGS="-Wall -Wextra -Wconversion -Wshadow -Wdouble-promotion -Wpedantic -Werror" \
        >"$box/log" 2>&1 ||
    { cat "$box/log"; fail "the consumer does not configure"; }
compile
expect "$("$box/build/robot")" "reached 0 limit 0.5"
"$box/build/alone" || fail "the standalone monitor"
expect "$("$box/build/opened" "$box/consumer/specs/reach.etl")" "reach: monitors: 1"
if command -v pkg-config >"$box/log"; then
    export PKG_CONFIG_PATH=$box/prefix/lib/pkgconfig
    # shellcheck disable=SC2046 # several words
    cc -std=c99 "$box/consumer/opened.c" $(pkg-config --cflags --libs etlc) -o "$box/opened"
    expect "$(LD_LIBRARY_PATH=$box/prefix/lib "$box/opened" "$box/consumer/specs/reach.etl")" \
        "reach: monitors: 1"
fi
expect "$("$box/build/stored")" "ready: reached 0"
expect "$("$box/build/moving")" "ready: reached 0"
if grep 'include[ <"]*etlmon/' "$box/build/etlc/alone/guard.hpp"; then fail \
    "a standalone header includes the runtime"; fi

reach=$box/build/etlc/robot/reach.hpp guard=$box/build/etlc/robot/guard.hpp
if grep -F "$box" "$reach"; then fail "the header names a folder of the machine that made it"; fi

stamp() { stat -c %y "$1"; }
[ ! -s "$box/build/etlc/robot/reach.targets.bin" ] || fail "small targets are in a file"
reach_made=$(stamp "$reach") guard_made=$(stamp "$guard")
odd_made=$(stamp "$box/build/etlc/robot/$odd.hpp")
compile
expect "$(stamp "$reach")" "$reach_made"
expect "$(stamp "$box/build/etlc/robot/$odd.hpp")" "$odd_made"

change cp "$box/consumer/specs/far.npy" "$box/consumer/specs/goal.npy"
compile
[ "$(stamp "$reach")" != "$reach_made" ] || fail "the target has changed, the header has not"
expect "$(stamp "$guard")" "$guard_made"
expect "$("$box/build/robot")" "reached -3 limit 0.5"
expect "$("$box/build/stored")" "ready: reached -3"
expect "$("$box/build/moving")" "ready: reached -3"

change sed -i 's/<= 2.5/<= 2.25/' "$box/consumer/specs/guard.etl"
compile
expect "$("$box/build/robot")" "reached -3 limit 0.25"

change sed -i 's/<= 2.25/<= /' "$box/consumer/specs/guard.etl"
if "$cmake" --build "$box/build" >"$box/log" 2>&1; then fail "a spec with an error builds"; fi
grep -q 'guard.etl:4:.*error:' "$box/log" ||
    { cat "$box/log"; fail "the error of the spec is not shown"; }

# A bare-metal program, where CMake warns of every shared library that a package imports.
if command -v arm-none-eabi-g++ >"$box/log"; then
    mkdir "$box/board"
    cp "$here/consumer/specs/guard.etl" "$box/board"
    cat >"$box/board/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.20)
project(board CXX)
find_package(etlc REQUIRED)
add_library(board STATIC board.cpp)
etlc_add_monitor(board SPEC guard.etl)
END
    echo '#include "guard.hpp"
    static guard::Monitor monitor;
    bool alarm(const guard::Inputs& in) { return monitor.step(in).limit.alarm(); }' \
        >"$box/board/board.cpp"
    cat >"$box/board/arm.cmake" <<'END'
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_CXX_FLAGS_INIT "-mcpu=cortex-m4 -mthumb -fno-exceptions -fno-rtti")
END
    "$cmake" -Werror=dev -S "$box/board" -B "$box/board/build" -G "$generator" \
        -DCMAKE_TOOLCHAIN_FILE="$box/board/arm.cmake" -DCMAKE_PREFIX_PATH="$box/prefix" \
        >"$box/log" 2>&1 && ! grep -i warning "$box/log" &&
        "$cmake" --build "$box/board/build" >>"$box/log" 2>&1 ||
        { cat "$box/log"; fail "a bare-metal program"; }
fi

# README.md: ./demo.sh, cmake --build, cmake --install. Every file that the last one copies from the
# build folder is there after the first, or made by the second.
[ "$generator" = Ninja ] || exit 0
top=$here/../..
[ "$(sed -n '/^## Install/,/^## /p' "$top/README.md" |
    grep -oE '^    (\./demo\.sh|cmake --(build|install) build/release)' | tr -d '\n')" = \
    "    ./demo.sh    cmake --build build/release    cmake --install build/release" ] ||
    fail "README.md on how to install etlc"
demo=$box/demo
words=$(grep -oE '^ *configure release .*' "$top/demo.sh" | sed 's/.*configure release //')
# shellcheck disable=SC2086 # several words
(cd "$top" && "$cmake" --preset release -B "$demo" -G Ninja -DCMAKE_CXX_COMPILER="$cxx" $words) \
    >"$box/log" 2>&1 || { cat "$box/log"; fail "what ./demo.sh configures"; }
if "$cmake" --install "$demo" --prefix "$box/early" >"$box/log" 2>&1; then
    fail "what is not built is installed"
fi
grep -q "^ *cmake --build $demo" "$box/log" && [ ! -e "$box/early" ] ||
    { cat "$box/log"; fail "installed before it was built: $(ls "$box")"; }
/usr/bin/python3 - "$demo" <<'END' >"$box/missing" || \
    fail "what is installed: $(cat "$box/missing")"
import pathlib, re, sys

folder = pathlib.Path(sys.argv[1])
made_of = {}
for line in re.findall(r"^build (.*)$", (folder / "build.ninja").read_text(), re.M):
    outputs, inputs = line.split(": ", 1)
    made_of.update(dict.fromkeys(outputs.split(), outputs.split() + inputs.split()))
made, open_ = set(), ["all"]
while open_:
    file = open_.pop()
    if file not in made:
        made.add(file)
        open_ += made_of.get(file, [])
scripts = "\n".join(script.read_text() for script in folder.rglob("cmake_install.cmake"))
installed = set(re.findall(rf'"{folder}/([^"$]+)"', scripts))
missing = [x for x in installed if x not in made and not (folder / x).exists()]
print(*(missing or installed))
sys.exit(bool(missing) or not {"etlc", "libetlc.so", "libetlc.so.1"} <= installed)
END
