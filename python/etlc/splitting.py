"""Divides recorded episodes into parts that share none: `split`."""

from __future__ import annotations

import json
import math
import os
import zlib
from glob import glob
from pathlib import Path

from ._keywords import FilePath, FilePaths, path_of
from .errors import InputError

_ENDINGS = (".csv", ".npz", ".h5", ".hdf5")


def split(data: FilePaths, *shares: float, by: str = "hash") -> list[list[str]]:
    """Divides episodes into parts, such as those to fit on, to calibrate on and to evaluate.

    They are the parts of `--split 0:0.25`, `--split 0.25:0.5` and `--split 0.5:1` of the commands.

    Args:
        data: files (.csv, .npz, .h5), folders, data sets or patterns. An .h5 file is one episode.
        *shares: the share of the episodes in each part, in all 1: 0.25, 0.25, 0.5.
        by: "hash" deals them by their content, whatever the files are called; "order" keeps their
            order, so that later parts are later recordings where names are in order of time.

    Returns:
        The paths of each part, for the argument `data` of the other functions.

    Raises:
        InputError: the shares are not in all 1, or a part is empty.
    """
    if by not in ("hash", "order"):
        raise InputError(f"by is {by!r}, expected 'hash' or 'order'")
    if len(shares) < 2 or min(shares) <= 0 or not math.isclose(sum(shares), 1, abs_tol=1e-9):
        raise InputError(f"the shares are {shares}, expected two or more, in all 1")
    episodes = _episodes_of(data)
    if by == "hash":
        episodes.sort(key=_sum_of)
    ends = [round(sum(shares[: k + 1]) * len(episodes)) for k in range(len(shares))]
    parts = [episodes[begin:end] for begin, end in zip([0, *ends], ends)]
    if not all(parts):
        raise InputError(f"{len(episodes)} episodes are too few for the shares {shares}")
    return parts


def _episodes_of(data: FilePaths) -> list[str]:
    """Returns the episodes of all arguments in their order, each once."""
    arguments = [data] if isinstance(data, (str, bytes, os.PathLike)) else list(data)
    found: dict[str, None] = {}
    for argument in arguments:
        found.update(dict.fromkeys(_episodes_in(argument)))
    return list(found)


def _episodes_in(argument: FilePath) -> list[str]:
    path = path_of("data", argument)
    if (path / "meta" / "info.json").exists():
        count = json.loads((path / "meta" / "info.json").read_text(encoding="utf-8"))
        return [f"{path}:{number}" for number in range(count["total_episodes"])]
    found = path.iterdir() if path.is_dir() else map(Path, glob(str(path)))
    episodes = sorted(
        str(one) for one in found if one.suffix in _ENDINGS and one.name != "labels.csv"
    )
    if not episodes:
        raise InputError(f"{path} has no episodes: {', '.join(_ENDINGS)} or a data set")
    return episodes


def _sum_of(episode: str) -> int:
    """Returns the CRC-32 of a file, or of the number of an episode of a data set."""
    path = Path(episode)
    content = path.read_bytes() if path.exists() else episode.rpartition(":")[2].encode()
    return zlib.crc32(content)
