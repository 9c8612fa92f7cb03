"""Results as pandas frames, and as pictures of matplotlib, where these are installed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterable, Iterator

import numpy as np

from ._types import Array, extremes, untyped

if TYPE_CHECKING:
    from .arrays import Episode, EpisodeVerdicts, Tables
    from .verdicts import Verdicts

#: What a row of an evaluation is about, by its place in the JSON of `etlc evaluate`.
_FIGURES = ("f1", "precision", "recall", "agreement")


def _needed(module: str, method: str) -> Any:
    import importlib

    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.split(".", maxsplit=1)[0]
        raise ImportError(
            f"{method} needs {package}, which is not installed: pip install {package}"
        ) from error


def frame_of_step(verdicts: Verdicts) -> Any:
    """A row for each monitor."""
    pandas = _needed("pandas", "to_pandas")
    rows = [
        (one.name, one.status, one.final, one.robustness, one.lower, one.upper)
        for one in verdicts
    ]
    columns = ["monitor", "status", "final", "robustness", "lower", "upper"]
    return pandas.DataFrame(rows, columns=columns).set_index("monitor")


def frame_of_tables(tables: Tables[Any], axes: tuple[str, ...]) -> Any:
    """A row for each monitor at each place of the leading axes."""
    pandas = _needed("pandas", "to_pandas")
    shape = tables.table.shape
    places = np.indices(shape).reshape(len(shape), -1)
    columns: dict[str, Any] = {name: places[at] for at, name in enumerate(axes)}
    columns["monitor"] = np.array(tables.monitors, "O")[places[-1]]
    status = [one.status for one in tables]
    columns["status"] = np.stack(status, axis=-1).reshape(-1)
    columns["final"] = np.stack([one.final for one in tables], axis=-1).reshape(-1)
    for name in ("robustness", "lower", "upper"):
        columns[name] = tables.table[name].reshape(-1)
    return pandas.DataFrame(columns)


def frame_of_episode(episode: Episode) -> Any:
    """The same for an episode, with a column for each distance."""
    frame = frame_of_tables(episode, ("step",))
    for name, distance in episode.distances.items():
        frame[f"distance_{name}"] = np.repeat(distance, len(episode.monitors))
    return frame


def frame_of_figures(data: dict[str, Any]) -> Any:
    """A row for each predicate and monitor of an evaluation."""
    pandas = _needed("pandas", "to_pandas")
    return pandas.DataFrame(list(figures(data)))


def figures(data: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Yields a row for each predicate by frames, and each monitor by steps and by episodes."""
    specs = data.get("specs", {None: data})
    for spec, one in specs.items():
        beginning = {} if spec is None else {"spec": spec}
        for name, found in one.get("predicates", {}).items():
            yield {**beginning, "name": name, "by": "frames", **_row(found)}
        for name, found in one.get("monitors", {}).items():
            for by in ("steps", "episodes"):
                if by in found:
                    yield {**beginning, "name": name, "by": by, **_row(found[by])}


def _row(found: dict[str, Any]) -> dict[str, Any]:
    row: dict[str, Any] = {}
    for name in _FIGURES:
        row[name] = found.get(name)
        low, high = found.get(f"{name}_interval") or (None, None)
        row[f"{name}_low"], row[f"{name}_high"] = low, high
    return row


def plot(episode: Episode) -> Any:
    """Draws the distances against their thresholds, and the verdicts with their bounds."""
    pyplot = _needed("matplotlib.pyplot", "plot")
    lanes = len(episode.distances) + len(episode.monitors)
    figure, axes = pyplot.subplots(
        lanes, sharex=True, squeeze=False, figsize=(9, 1.6 * lanes + 0.6), layout="constrained"
    )
    places = list(axes[:, 0])
    x: Array = untyped.arange(len(episode)) * (episode.step_seconds or 1)
    for name, distance in episode.distances.items():
        ax = places.pop(0)
        ax.plot(x, distance, color="#0b4f7c")
        if name in episode.thresholds:
            ax.plot(x, episode.thresholds[name], color="#b34700", linestyle="--")
        _title(ax, name, episode.texts.get(name, ""))
    for one in episode:
        plot_verdicts(one, places.pop(0), x, episode.texts.get(one.name, ""))
    axes[-1, 0].set_xlabel("time, s" if episode.step_seconds else "step")
    return figure


def plot_verdicts(one: EpisodeVerdicts, ax: Any, x: Array, text: str) -> None:
    """Draws the robustness of a monitor with its bounds, and marks where it is final."""
    known = one.robustness[np.isfinite(one.robustness)]
    low, high = extremes(known)
    room = (high - low) * 0.06 or 0.5
    ax.set_ylim(min(low, 0) - room, max(high, 0) + room)
    ax.fill_between(
        x, *(np.clip(bound, *ax.get_ylim()) for bound in one.bounds), color="#0072b2", alpha=0.11
    )
    ax.axhline(0, color="#b34700", linestyle="--", linewidth=1)
    ax.plot(x, one.robustness, color="#0b4f7c")
    for where, colour in ((one.alarm, "#d55e00"), (one.fulfilled, "#0072b2")):
        ax.fill_between(
            x, 0, 0.05, where=where, step="mid", color=colour, transform=ax.get_xaxis_transform()
        )
    _title(ax, one.name, text)


def plot_figures(data: dict[str, Any]) -> Any:
    """Draws the figures of an evaluation with their intervals, a row for each."""
    pyplot = _needed("matplotlib.pyplot", "plot")
    rows = list(figures(data))[::-1]
    figure, axes = pyplot.subplots(
        1, len(_FIGURES), sharey=True, figsize=(10, 0.4 * len(rows) + 1.2), layout="constrained"
    )
    for ax, name in zip(axes, _FIGURES):
        for at, row in enumerate(rows):
            if row[name] is not None and row[f"{name}_low"] is not None:
                ax.plot([row[f"{name}_low"], row[f"{name}_high"]], [at, at], color="#0b4f7c")
            ax.plot([row[name]], [at], "o", color="#0b4f7c")
        ax.set_title(name, loc="left", fontsize="small")
        ax.set_xlim(-0.03, 1.03)
    keys = [key for key in ("spec", "name", "by") if rows and key in rows[0]]
    names = [" ".join(str(row[key]) for key in keys) for row in rows]
    axes[0].set_yticks(range(len(rows)), names)
    return figure


def _title(ax: Any, name: str, text: str) -> None:
    ax.set_title(f"{name}  {text}".replace("$", r"\$"), loc="left", fontsize="small")


def standing(one: Any) -> str:
    """Returns the status in words: a verdict that may still change is not called violated."""
    status: str = one.status
    if one.final:
        return status + " for good"
    return {"violated": "not yet satisfied", "satisfied": "satisfied so far"}.get(status, status)


def rows_of_step(verdicts: Verdicts | Iterable[Any]) -> Iterator[tuple[object, ...]]:
    """Yields the cells of a small table: the verdict of each monitor."""
    from ._html import number

    for one in verdicts:
        yield one.name, standing(one), *map(number, (one.robustness, one.lower, one.upper))
