#!/usr/bin/env bash
# format.sh CLANG_FORMAT SOURCE_DIR: fails for every C++ file that clang-format would change.
set -euo pipefail
cd "$2"
find base compiler workbench runtime examples tests bench -name '*.[ch]pp' -print0 |
    xargs -0 "$1" --dry-run --Werror
