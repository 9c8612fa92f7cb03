# For demo.sh and test.sh, which source it from the top folder.

# configure PRESET [ARGUMENT...]: configures build/PRESET; shows the log only if that fails.
configure() {
    local preset=$1 log=build/$1/configure.log
    shift
    mkdir -p "build/$preset"
    if [ ! -e "build/$preset/CMakeCache.txt" ] && command -v ninja >/dev/null; then
        set -- -G Ninja "$@"
    fi
    cmake --preset "$preset" "$@" >"$log" 2>&1 || { cat "$log"; return 1; }
}

# build PRESET TARGET...: shows progress on a terminal; elsewhere it is silent unless it fails.
build() {
    local preset=$1 log=build/$1/build.log
    shift
    if [ -t 1 ]; then
        cmake --build "build/$preset" --parallel "$(nproc)" --target "$@"
    else
        cmake --build "build/$preset" --parallel "$(nproc)" --target "$@" >"$log" 2>&1 ||
            { cat "$log"; return 1; }
    fi
}
