#!/usr/bin/env bash
# ./demo.sh: runs a generated monitor, installs what is missing, builds etlc, then goes from a spec
# and recorded drives to a class, a page and thresholds with a guarantee. All it writes is below
# build/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

cmake/install_packages.sh build
. cmake/build.sh
PATH=$PWD/build/release:$PATH
out=build/demo
mkdir -p "$out"

bold='' plain=''
if [ -t 1 ] && [ -z "${NO_COLOR:-}" ]; then
    bold=$'\e[1m' plain=$'\e[0m'
fi
title() { printf '\n%s== %s ==%s\n\n' "$bold" "$1" "$plain"; }
# Shows a command, then runs it.
show() { printf '%s$ %s%s\n' "$bold" "$*" "$plain"; "$@"; }
# show_into FILE COMMAND...: the same, with the output in a file.
show_into() { printf '%s$ %s >%s%s\n' "$bold" "${*:2}" "$1" "$plain"; "${@:2}" >"$1"; }

title "A monitor: Example 2 of the paper"
show tail -n +2 examples/paper_example/example.etl
echo
echo "etlc makes one C++ class of it, generated/example.hpp, which needs only runtime/include:"
show "${CXX:-c++}" -std=c++17 -O2 -I runtime/include -I generated examples/paper_example/main.cpp \
    -o "$out/example"
show "$out/example"

title "The compiler"
if [ ! -e build/release/build.ninja ] && [ ! -e build/release/Makefile ]; then
    echo "Building etlc, which takes 4 minutes on two cores the first time."
    configure release -DETLC_BUILD_TESTS=OFF
fi
build release demo
show etlc examples/paper_example/example.etl -o "$out/example.hpp"
show cmp "$out/example.hpp" generated/example.hpp

title "A car seen by a camera: visit A, then B, stay clear of C"
show grep -E '^(input z|predicate|monitor)' examples/dubins/dubins.etl
echo
show etlc examples/dubins/dubins.etl -o "$out/dubins.hpp"
echo "The head of $out/dubins.hpp says what the class costs:"
sed -n '/monitor  *about/,/all together/p' "$out/dubins.hpp"
echo
drives=$out/hundred_drives
echo "That class over 100 drives:"
show_into "$out/drives.txt" build/release/examples/dubins/dubins "$drives"
sed -n '1,3p;/^monitor /,/^sequential/p' "$out/drives.txt"
echo
show etlc report examples/dubins/dubins.etl --data "$drives" --frames camera -o "$out/dubins.html"
echo "Open $out/dubins.html in a browser: every drive, the worst first, with distances and reasons."

title "Thresholds with a guarantee, from 120 labelled drives"
show grep -E '^(predicate|monitor)' examples/dubins/union.etl
echo
build/release/examples/dubins/dubins_record "$out/drives" 1
show etlc calibrate examples/dubins/union.etl --data "$out/drives/1/calibration" \
    -o "$out/union.thresholds.json"
echo
echo "How good they are on 180 other drives, in part:"
show_into "$out/evaluation.txt" etlc evaluate examples/dubins/union.etl \
    --thresholds "$out/union.thresholds.json" --data "$out/drives/1/test"
sed -n '/always false/d;/^predicate, by/,/^$/p;/^monitor, by episodes/,/^$/p' "$out/evaluation.txt"

title "What to do next"
cat <<'EOF'
  docs/tutorial.md            from an idea to a monitor of your own, in ten minutes
  docs/recordings.md          from images and videos to verdicts
  examples/dubins/README.md   this car, and the paper's experiment over five seeds
  build/release/etlc --help   the commands; docs/README.md lists all pages
EOF
