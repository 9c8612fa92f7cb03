#!/usr/bin/env bash
# install_packages.sh GROUP...: installs the packages of these groups of packages.txt that are
# missing, through apt, as root or with sudo. Without apt it names what is missing and fails; if
# nothing is missing it prints nothing.
set -euo pipefail
list=$(dirname "${BASH_SOURCE[0]}")/packages.txt

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
[ ${#missing[@]} -gt 0 ] || exit 0

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
