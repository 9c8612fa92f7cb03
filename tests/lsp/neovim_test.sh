#!/usr/bin/env bash
# neovim_test.sh NVIM ETLC: a session in Neovim's own client.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
box=$(mktemp -d)
trap 'rm -rf "$box"' EXIT
cat >"$box/dock.etl" <<'SPEC'
spec dock;

input z : f32[2];
target bay = [[1, 0], [0, 1]];

predicate at_bay = min cosine(z, bay) <= 0.25;
/* 🚀🤖 */ monitor arrive = F at_bai;
SPEC
cd "$box"
export ETLC=$2 SPEC=dock.etl
export XDG_CONFIG_HOME=$box/config XDG_DATA_HOME=$box/data XDG_STATE_HOME=$box/state
export XDG_CACHE_HOME=$box/cache LC_ALL=C.UTF-8
timeout 100 "$1" --headless -u NONE -i NONE -c "luafile $here/neovim_test.lua"
[ ! -e "$box/cache/nvim/lsp.log" ] || ! grep -a '^\[ERROR\]' "$box/cache/nvim/lsp.log"
