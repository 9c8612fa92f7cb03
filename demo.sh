#!/usr/bin/env bash
# ./demo.sh: installs what is missing, builds what the demo needs, then goes from two specs to
# running monitors. All its output is below build/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

cmake/install_packages.sh build
. cmake/build.sh
if [ ! -e build/release/build.ninja ] && [ ! -e build/release/Makefile ]; then
    echo "Configuring and building etlc and its examples (the first time takes some minutes)"
    configure release -DETLC_BUILD_TESTS=OFF
fi
build release demo

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

title "The paper's Example 2: from four lines of specification to a monitor"
show cat examples/paper_example/example.etl
echo
show etlc examples/paper_example/example.etl -o "$out/example.hpp"
show build/release/examples/paper_example/paper_example

title "A Dubins car seen by a camera: visit A, then B, stay clear of C"
show cat examples/dubins/dubins.etl
echo
show etlc examples/dubins/dubins.etl -o "$out/dubins.hpp"
echo
echo "The head of $out/dubins.hpp, without most of the numbers:"
echo
# Up to the private part of the class, with the first line of each table of numbers.
awk '/^ private:/ { exit }
     /^  -?[0-9]/ { if (rows++ == 1) print "  ..."; if (rows > 1) next }
     /^}/ { rows = 0 }
     { print }' "$out/dubins.hpp"

title "100 drives past that class: each verdict beside the truth"
show build/release/examples/dubins/dubins "$out/hundred_drives"

title "The same drives as a page to look at, the worst first"
show etlc report examples/dubins/dubins.etl --data "$out/hundred_drives" --frames camera \
    -o "$out/dubins.html"
echo "Open $out/dubins.html in a browser."

title "The paper's experiment: thresholds from labelled drives, by both of its methods"
drives=$out/drives
record=build/release/examples/dubins/dubins_record
show grep -E '^(predicate|truth|monitor|sliding)' examples/dubins/paper.etl
echo
show "$record" "$drives" 1
show etlc calibrate examples/dubins/paper.etl --data "$drives/1/calibration" \
    -o "$out/paper.thresholds.json"
echo
show etlc examples/dubins/paper.etl --thresholds "$out/paper.thresholds.json" -o "$out/paper.hpp"
show "${CXX:-c++}" -std=c++17 -O2 -I runtime/include -I "$out" examples/dubins/watch.cpp \
    -o "$out/watch"
echo
echo "The compiled class, on the 180 drives that the thresholds have not seen:"
show "$out/watch" "$drives/1/test"
echo
show etlc evaluate examples/dubins/paper.etl --thresholds "$out/paper.thresholds.json" \
    --data "$drives/1/test"

title "The same over five seeds, beside the paper's table"
show examples/dubins/experiment.sh build/release/etlc "$record" "$drives"

title "A camera whose mount gives way: a threshold that stays, and one that follows labels"
show grep -E '^predicate' examples/dubins/drift.etl
echo
show examples/dubins/drift.sh build/release/etlc "$record" "$drives"
