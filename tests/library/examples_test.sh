#!/usr/bin/env bash
# examples_test.sh MONITOR FLEET SPEC: the examples in C and C++ print the expected output.
set -euo pipefail
monitor=$1 fleet=$2 spec=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
{ "$monitor" "$spec"; "$fleet" "$spec"; "$monitor" /no/such.etl 2>&1 || echo "exit status $?"; } |
    diff -u "$here/examples.expected" -
