#!/usr/bin/env bash
# packages_test.sh CMAKE_FOLDER: runs install_packages.sh with stubs for every command that could
# change the system; the stubs log their calls.
set -euo pipefail
box=$(mktemp -d)
mkdir -p "$box/top/cmake"
cp "$1/install_packages.sh" "$1/packages.txt" "$box/top/cmake"
script=$box/top/cmake/install_packages.sh
trap 'rm -rf "$box"' EXIT

fail() { echo "FAILED: $*"; exit 1; }
stub() { printf '#!/bin/bash\n%s\n' "$2" >"$box/$1"; chmod +x "$box/$1"; }
for tool in awk bash cat dirname env grep gzip mkdir mktemp mv rm tar uname; do
    ln -s "$(command -v "$tool")" "$box/$tool"
done
stub apt-get 'echo "$*" >>"$BOX/calls"'
stub sudo 'echo "sudo" >>"$BOX/calls"; exec "$@"'
stub id 'echo "$USER_ID"'
stub dpkg-query 'for p in "${@:4}"; do
    case " $ABSENT " in *" $p "*) ;; *) echo "installed $p" ;; esac
done'

# try USER_ID ABSENT [GROUP]: runs the script for the group, by default `build`, and sets $output,
# $status and $calls.
try() {
    rm -f "$box/calls"
    status=0
    output=$(BOX=$box PATH=$box USER_ID=$1 ABSENT=$2 bash "$script" "${3:-build}" 2>&1) || status=$?
    calls=$(cat "$box/calls" 2>/dev/null || true)
}

try 0 ""
[ "$status$output$calls" = 0 ] ||
    fail "says or does something where nothing is missing: $output $calls"

try 0 "libfmt-dev libgtest-dev"
[ "$status" = 0 ] || fail "$output"
[[ $calls == *update*install*libfmt-dev* ]] || fail "does not install what is missing: $calls"
[[ $calls != *sudo* && $calls != *libgtest-dev* && $calls != *antlr4* ]] ||
    fail "does more than it should: $calls"

# A package from npm is fetched once; npm itself is installed if missing; and a failure is not
# fatal.
try 0 "" recordings
[[ $status = 0 && $calls == *install*npm* && $output == *"will not be tested"* ]] ||
    fail "without npm: $output $calls"
stub npm 'echo "npm $*" >>"$BOX/calls"
folder=package/bin/napi-v6/linux/$(uname -m | /bin/sed "s/x86_64/x64/; s/aarch64/arm64/")
mkdir -p "$BOX/$folder" && echo library >"$BOX/$folder/libonnxruntime.so.1"
tar -C "$BOX" -czf "$4/${5/@/-}.tgz" package'
try 0 "" recordings
library=$(echo "$box"/top/build/onnxruntime/libonnxruntime.so.*)
[[ $status = 0 && $calls == "npm pack"* && $(cat "$library") = library ]] ||
    fail "with npm: $output $calls"
try 0 "" recordings
[ "$status$output$calls" = 0 ] || fail "what is there is got again: $output $calls"
try 0 "" test
[[ $status = 0 && $calls == "npm pack"*pyright@* && $output == *"Getting pyright"* ]] ||
    fail "does not get pyright: $output $calls"

try 1000 "antlr4"
[[ $status = 0 && $calls == sudo*install*antlr4* ]] || fail "does not use sudo: $output $calls"

rm "$box/sudo"
try 1000 "antlr4 g++"
[[ $status = 1 && -z $calls && $output == *antlr4* && $output == *g++* ]] ||
    fail "does not name what is missing: $output $calls"
