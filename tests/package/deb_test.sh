#!/usr/bin/env bash
# deb_test.sh BUILD_DIR CPACK VERSION: makes the Debian package, and looks into it.
set -euo pipefail
build_dir=$1 cpack=$2 version=$3
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT

fail() { echo "FAILED: $*"; exit 1; }

(cd "$build_dir" && "$cpack" -G DEB -B "$box") >"$box/log" 2>&1 || { cat "$box/log"; fail "cpack"; }
deb=$(echo "$box"/etlc_"$version"_*.deb)
[ -f "$deb" ] || { ls "$box"; fail "there is no package of version $version"; }

depends=$(dpkg-deb -f "$deb" Depends)
for library in libc6 libstdc++6 libfmt9 libzip4; do
    [[ $depends == *"$library"* ]] || fail "it does not depend on $library: $depends"
done
dpkg-deb -x "$deb" "$box/root"
[[ $("$box/root/usr/bin/etlc" --version) == *"$version"* ]] || fail "etlc --version does not say $version"
for file in include/etlmon/value.hpp share/cmake/etlc/etlcConfig.cmake share/cmake/etlc/EtlAddMonitor.cmake share/doc/etlc/copyright; do
    [ -f "$box/root/usr/$file" ] || fail "it lacks /usr/$file"
done
