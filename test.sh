#!/usr/bin/env bash
# ./test.sh [PRESET...]: installs what is missing, then builds and tests each preset of
# CMakePresets.json named (default: release, which has all tests). The last line counts the tests.
# With CI=true in the environment the default is all presets, warnings are errors, and a missing
# tool is a failure.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

presets=("$@")
if [ ${#presets[@]} -eq 0 ]; then
    presets=(release)
    [ "${CI:-}" != true ] || presets+=(sanitized)
fi
for preset in "${presets[@]}"; do
    if [[ ! " release sanitized " = *" $preset "* ]]; then
        echo "test.sh: there is no preset $preset, only: release sanitized" >&2
        exit 2
    fi
done

cmake/install_packages.sh build fleet recordings test
. cmake/build.sh
options=(-DETLC_BUILD_TESTS=ON)
[ "${CI:-}" != true ] || options+=(-DETLC_WERROR=ON -DETLC_REQUIRE_TOOLS=ON)

passed=0
failed=0
# run_tests PRESET: adds its tests to the counts. All run at once, so that the longest start first.
run_tests() {
    local log=build/$1/ctest.log total bad
    ctest --test-dir "build/$1" --parallel "$(nproc)" --output-on-failure \
        --no-tests=error --timeout 1200 >"$log" 2>&1 || cat "$log"
    read -r bad total < <(
        sed -nE 's/.*tests passed, ([0-9]+) tests failed out of ([0-9]+)/\1 \2/p' "$log"
    ) || { bad=1 total=1; }
    failed=$((failed + bad)) passed=$((passed + total - bad))
    printf '%-9s %5d passed %5d failed  %4d s\n' "$1" $((total - bad)) "$bad" $((SECONDS - start))
}

for preset in "${presets[@]}"; do
    start=$SECONDS
    configure "$preset" "${options[@]}"
    build "$preset" "$([ "$preset" = sanitized ] && echo all_tests || echo all)"
    printf '%-9s built %23d s\n' "$preset" $((SECONDS - start))
    start=$SECONDS
    run_tests "$preset"
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
