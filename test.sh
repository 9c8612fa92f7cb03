#!/usr/bin/env bash
# ./test.sh [PRESET...]: installs what is missing, then builds and tests each preset of
# CMakePresets.json named (default: all). The last line counts the tests. With CI=true in the
# environment warnings are errors, and a missing tool is a failure.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

# The folders of tests/ that a preset builds and runs. The release build runs all at once, so that
# the longest start first. The tests of the runtime and of generated code compile what they test
# themselves, with g++, clang++ and sanitizers, so the sanitized build runs only those of etlc.
declare -A folders=(
    [release]="."
    [sanitized]="unit spec calibrate fuzz"
)
presets=("$@")
[ ${#presets[@]} -gt 0 ] || presets=(release sanitized)
for preset in "${presets[@]}"; do
    if [ -z "${folders[$preset]:-}" ]; then
        echo "test.sh: there is no preset $preset, only: ${!folders[*]}" >&2
        exit 2
    fi
done

cmake/install_packages.sh build test
. cmake/build.sh
options=(-DETLC_BUILD_TESTS=ON)
[ "${CI:-}" != true ] || options+=(-DETLC_WERROR=ON -DETLC_REQUIRE_TOOLS=ON)

passed=0
failed=0
# run_folder PRESET FOLDER: adds its tests to the counts.
run_folder() {
    local log=build/$1/tests/$2/ctest.log total bad
    ctest --test-dir "build/$1/tests/$2" --parallel "$(nproc)" --output-on-failure \
        --no-tests=error --timeout 300 >"$log" 2>&1 || cat "$log"
    read -r bad total < <(
        sed -nE 's/.*tests passed, ([0-9]+) tests failed out of ([0-9]+)/\1 \2/p' "$log"
    ) || { bad=1 total=1; }
    failed=$((failed + bad)) passed=$((passed + total - bad))
    printf '%-9s %-9s %5d passed %5d failed  %4d s\n' \
        "$1" "${2/#./all}" $((total - bad)) "$bad" $((SECONDS - start))
}

for preset in "${presets[@]}"; do
    start=$SECONDS
    configure "$preset" "${options[@]}"
    targets=()
    for folder in ${folders[$preset]}; do
        [ "$folder" = . ] && targets+=(all) || targets+=("tests_$folder")
    done
    build "$preset" "${targets[@]}"
    printf '%-9s %-9s %33d s\n' "$preset" built $((SECONDS - start))
    for folder in ${folders[$preset]}; do
        start=$SECONDS
        run_folder "$preset" "$folder"
    done
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
