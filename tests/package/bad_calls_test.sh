#!/usr/bin/env bash
# bad_calls_test.sh CMAKE_FOLDER CMAKE CXX: checks the errors of etlc_add_monitor for wrong calls,
# and of the runtime for wrong programs.
set -euo pipefail
folder=$1 cmake=$2 cxx=$3
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT
mkdir -p "$box/specs" "$box/other"
touch "$box/main.cpp" "$box/specs/a.etl" "$box/other/a.etl"

cat >"$box/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.20)
project(calls LANGUAGES CXX)
include($folder/EtlAddMonitor.cmake)
add_executable(etlc::etlc IMPORTED)
set_target_properties(etlc::etlc PROPERTIES IMPORTED_LOCATION $cmake)
add_library(etlmon::etlmon INTERFACE IMPORTED)
add_executable(robot main.cpp)
add_library(headers INTERFACE)
include(\${CALL})
END

failures=0
# refused WORDS CALL: configuring with CALL must fail and print WORDS (ignoring line breaks and
# indentation).
refused() {
    echo "$2" >"$box/call.cmake"
    if "$cmake" -S "$box" -B "$box/build" -DCMAKE_CXX_COMPILER="$cxx" -DCALL="$box/call.cmake" \
        >"$box/log" 2>&1; then
        echo "FAILED: accepted: $2"; failures=1
    elif ! tr -s ' \n' ' ' <"$box/log" | grep -qF -- "$1"; then
        echo "FAILED: $2: does not say '$1':"; cat "$box/log"; failures=1
    fi
}

refused "there is no target robto" "etlc_add_monitor(robto SPEC specs/a.etl)"
refused "neither an executable nor a library" "etlc_add_monitor(headers SPEC specs/a.etl)"
refused "neither an executable nor a library" "etlc_add_monitor(etlc::etlc SPEC specs/a.etl)"
refused "SPEC is missing" "etlc_add_monitor(robot)"
refused "unknown arguments: specs/a.etl" "etlc_add_monitor(robot specs/a.etl)"
refused "unknown arguments: TRESHOLDS t.json" \
    "etlc_add_monitor(robot SPEC specs/a.etl TRESHOLDS t.json)"
refused "no value after: THRESHOLDS" "etlc_add_monitor(robot SPEC specs/a.etl THRESHOLDS)"
refused "SPEC specs/b.etl: there is no such file: $box/specs/b.etl" \
    "etlc_add_monitor(robot SPEC specs/b.etl)"
refused "SPEC specs: there is no such file" "etlc_add_monitor(robot SPEC specs)"
refused "THRESHOLDS t.json: there is no such file" \
    "etlc_add_monitor(robot SPEC specs/a.etl THRESHOLDS t.json)"
refused "EMBEDDED e.npz: there is no such file" \
    "etlc_add_monitor(robot SPEC specs/a.etl EMBEDDED e.npz)"
refused "NAMESPACE a-b is not a C++ namespace" \
    "etlc_add_monitor(robot SPEC specs/a.etl NAMESPACE a-b)"
refused "INLINE_TARGETS 1k: expected a number of bytes" \
    "etlc_add_monitor(robot SPEC specs/a.etl INLINE_TARGETS 1k)"
refused "RETARGETABLE goes without EXPLAIN, RECORDER, INLINE_TARGETS and VALUES boolean" \
    "etlc_add_monitor(robot SPEC specs/a.etl RETARGETABLE EXPLAIN)"
refused "there is a monitor a.hpp already" "etlc_add_monitor(robot SPEC specs/a.etl)
etlc_add_monitor(robot SPEC other/a.etl)"

# For every file, names that Make, Ninja and CMake read differently are refused.
for sign in ';' "\\" "'" '"' '&' '#' '$' '%' '*' '<' '|' ':' '=' '[' ']' '?' '^' '`'; do
    touch "$box/specs/a${sign}b.etl"
    case $sign in
        ';' | "\\" | '"' | '$') written="\\$sign" ;;
        *) written=$sign ;;
    esac
    refused "a name with $sign in it, which not all build tools read alike: rename the file" \
        "etlc_add_monitor(robot SPEC \"specs/a${written}b.etl\")"
    [ "$sign" = % ] || refused "THRESHOLDS th${sign}.json: a name with $sign in it" \
        "etlc_add_monitor(robot SPEC specs/a.etl THRESHOLDS \"th${written}.json\")"
done

# accepted CALL
accepted() {
    echo "$1" >"$box/call.cmake"
    if ! "$cmake" -S "$box" -B "$box/build" -DCMAKE_CXX_COMPILER="$cxx" \
        -DCALL="$box/call.cmake" >"$box/log" 2>&1; then
        echo "FAILED: refused a right call:"; cat "$box/log"; failures=1
    fi
}
accepted "etlc_add_monitor(robot SPEC specs/a.etl NAMESPACE a::b STANDALONE)"
touch "$box/specs/a b,(1)+@!~{ä}.etl"
accepted "etlc_add_monitor(robot SPEC \"specs/a b,(1)+@!~{ä}.etl\")"

# not_compiled WORDS ERRORS FLAG... : the program on standard input must not compile; the errors
# contain these words, and their number is ERRORS if that is a number.
runtime=$folder/../runtime/include
not_compiled() {
    local words=$1 errors=$2 compiler
    shift 2
    cat >"$box/wrong.cpp"
    for compiler in "$cxx" g++ clang++; do
        command -v "$compiler" >/dev/null || continue
        if "$compiler" "$@" -fsyntax-only -I "$runtime" "$box/wrong.cpp" 2>"$box/log"; then
            echo "FAILED: $compiler $* accepts:"; cat "$box/wrong.cpp"; failures=1
        elif ! grep -qF -- "$words" "$box/log" ||
            { [ "$errors" != any ] && [ "$(grep -c 'error:' "$box/log")" -ne "$errors" ]; }; then
            echo "FAILED: $compiler $*: expected '$words'"; cat "$box/log"; failures=1
        fi
    done
}
headers="views distance/layout distance/kernel temporal/machine temporal/window vectors/pack"
for header in $headers; do
    echo "#include \"etlmon/$header.hpp\"" |
        not_compiled "etlmon needs C++17: compile with -std=c++17 or later" 1 -std=c++14
done
for given in "std::vector<float>& z" "std::array<float, 4>& z"; do
    not_compiled "not Dim elements by its type: Vector::unchecked(x.data())" any -std=c++17 <<END
#include <array>
#include <vector>

#include "etlmon/views.hpp"
void give(etlmon::Vector<float, 3>& to, const $given) { to = z; }
END
done
not_compiled "not Dim elements" any -std=c++17 <<END
#include "etlmon/views.hpp"
void give(etlmon::Vector<float, 3>& to, const float (&z)[4]) { to = z; }
END
exit $failures
