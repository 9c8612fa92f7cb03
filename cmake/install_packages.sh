#!/usr/bin/env bash
# install_packages.sh GROUP...: installs the missing packages of these groups of packages.txt with
# apt, as root or with sudo. Without apt it names the missing packages and fails; if nothing is
# missing it prints nothing. With `recordings` it gets ONNX Runtime, for which Debian 12 has no
# package, from npm into build/onnxruntime, where tests look for it; with `test`, pyright into
# build/pyright.
set -euo pipefail
list=$(dirname "${BASH_SOURCE[0]}")/packages.txt
onnxruntime=1.30.0
library=$(dirname "$list")/../build/onnxruntime/libonnxruntime.so.$onnxruntime
pyright=1.1.414
checker=$(dirname "$list")/../build/pyright

# The package is for many machines; only the library for this one is kept.
get_onnxruntime() {
    local box machine
    box=$(mktemp -d)
    machine=$(uname -m)
    machine=${machine/x86_64/x64} machine=${machine/aarch64/arm64}
    echo "Getting ONNX Runtime $onnxruntime"
    npm pack --silent --pack-destination "$box" "onnxruntime-node@$onnxruntime" >/dev/null &&
        tar -C "$box" -xzf "$box/onnxruntime-node-$onnxruntime.tgz" --wildcards \
            "package/bin/napi-v*/linux/$machine/libonnxruntime.so.1" &&
        mkdir -p "$(dirname "$library")" &&
        mv "$box"/package/bin/napi-v*/linux/"$machine"/libonnxruntime.so.1 "$library" ||
        echo "It cannot be got from npm: networks will not be tested." >&2
    rm -rf "$box"
}

get_pyright() {
    local box
    box=$(mktemp -d)
    echo "Getting pyright $pyright"
    npm pack --silent --pack-destination "$box" "pyright@$pyright" >/dev/null &&
        mkdir -p "$checker" &&
        tar -C "$checker" -xzf "$box/pyright-$pyright.tgz" --strip-components=1 ||
        echo "It cannot be got from npm: mypy alone will check types." >&2
    rm -rf "$box"
}

from_npm=()
[[ " $* " != *" recordings "* || -e $library ]] || from_npm+=(get_onnxruntime)
[[ " $* " != *" test "* || -e $checker ]] || from_npm+=(get_pyright)
get_from_npm() {
    for get in "${from_npm[@]}"; do "$get"; done
}

packages=()
for group in "$@"; do
    mapfile -t -O "${#packages[@]}" packages \
        < <(awk -v group="$group" '$1 == group { print $2 }' "$list")
done

if ! command -v dpkg-query >/dev/null; then
    echo "This is no Debian: the packages that are needed cannot be looked up." \
        "Their Debian 12 names: ${packages[*]}" >&2
    exit 0
fi

installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${packages[@]}" 2>/dev/null |
    awk '$1 == "installed" { print $2 }' || true)
missing=()
for package in "${packages[@]}"; do
    grep -qxF -- "$package" <<<"$installed" || missing+=("$package")
done
if [ ${#from_npm[@]} -gt 0 ] && ! command -v npm >/dev/null; then
    missing+=(npm)
fi
if [ ${#missing[@]} -eq 0 ]; then
    get_from_npm
    exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    as_root=(sudo)
fi
if ! command -v apt-get >/dev/null ||
    { [ ${#as_root[@]} -gt 0 ] && ! command -v sudo >/dev/null; }; then
    echo "These packages are missing, and only root or sudo with apt could install them:" >&2
    echo "    apt-get install ${missing[*]}" >&2
    exit 1
fi

echo "Installing ${missing[*]}"
as_root+=(env DEBIAN_FRONTEND=noninteractive)
"${as_root[@]}" apt-get -qq update
"${as_root[@]}" apt-get -qq install --no-install-recommends -o Dpkg::Use-Pty=0 "${missing[@]}" \
    >/dev/null
get_from_npm
