#!/usr/bin/env bash
# release.sh [FOLDER]: makes a release of the commit that is checked out: the wheel, the Debian
# packages, the source archive, sbom.spdx.json, CHANGELOG.md and SHA256SUMS go into FOLDER (default:
# build/etlc-VERSION). Needs Debian 12, where it installs missing packages; the same commit gives
# the same bytes. Finally a new user's first commands run in an empty system with what was made.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
fail() { echo "release.sh: $*" >&2; exit 1; }

version=$(awk '/define ETLMON_VERSION_/ { printf "%s%s", dot, $3; dot = "." }' \
    runtime/include/etlmon/version.hpp)
[ -z "$(git status --porcelain)" ] || fail "there are changes that are not committed"
[ "$(grep -m1 '^## ' CHANGELOG.md)" = "## $version" ] ||
    fail "CHANGELOG.md begins with '$(grep -m1 '^## ' CHANGELOG.md)', expected '## $version'"
if tagged=$(git rev-parse -q --verify "v$version^{commit}") &&
    [ "$tagged" != "$(git rev-parse HEAD)" ]; then
    fail "$version is released, as $tagged: raise runtime/include/etlmon/version.hpp (CONTRIBUTING)"
fi
folder=${1:-build/etlc-$version}
[ ! -e "$folder" ] || fail "$folder exists"

cmake/install_packages.sh build fleet recordings release
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH LC_ALL=C TZ=UTC
umask 022
box=$PWD/build/making-$version
rm -rf "$box"
mkdir -p "$box"
trap 'rm -rf "$box"' EXIT
made=$box/made source=$box/etlc-$version
mkdir "$made"
git archive --format=tar --prefix="etlc-$version/" HEAD >"$box/source.tar"
tar -C "$box" -xf "$box/source.tar"
gzip -9nc "$box/source.tar" >"$made/etlc-$version.tar.gz"
cp CHANGELOG.md "$made"

echo "Building etlc $version"
(
    cd "$source"
    . cmake/build.sh
    configure release -DETLC_BUILD_TESTS=OFF -DETLC_BUILD_EXAMPLES=OFF \
        -DCMAKE_CXX_FLAGS="-ffile-prefix-map=$source=."
    build release all wheel
    cd build/release
    cpack -G DEB -B "$box/deb" >cpack.log 2>&1 || { cat cpack.log; exit 1; }
)
cp "$source"/build/release/dist/etlc-*.whl "$box"/deb/*.deb "$made"
cmake/sbom.py "$version" "$made" >"$made/sbom.spdx.json"
(cd "$made" && sha256sum -- * >"$box/sums" && mv "$box/sums" SHA256SUMS)

"$source/tests/package/stranger.sh" "$made"
mkdir -p "$(dirname "$folder")"
mv "$made" "$folder"
(cd "$folder" && du -h -- *)
echo "etlc $version is in $folder. To say that this commit is it: git tag v$version"
