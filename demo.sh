#!/usr/bin/env bash
# ./demo.sh: installs what is missing, builds what the demo needs, then goes from two specs to running monitors.
# What it makes is below build/; nothing of the repository changes.
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
# Up to the private part of the class; of each table of numbers the first line.
awk '/^ private:/ { exit }
     /^  -?[0-9]/ { if (rows++ == 1) print "  ..."; if (rows > 1) next }
     /^}/ { rows = 0 }
     { print }' "$out/dubins.hpp"

title "100 drives past that class: each verdict beside the truth"
show build/release/examples/dubins/dubins "$out"
