"""The timelines of an episode as an SVG picture, as `etlc run --svg` and the report draw them.

There is a lane for each predicate whose distances were kept, and one for each monitor. The size
does not depend on the number of steps: with more steps than pixels, a line goes through the least
and the greatest number of each pixel.
"""

# pyright: reportPrivateUsage=false
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Iterator

import numpy as np

from ._html import escaped
from ._library import DECIDED, FINAL, SATISFIED, VIOLATED
from ._types import Array, extremes, untyped

if TYPE_CHECKING:
    from .arrays import Episode

# Lengths in pixels.
_WIDTH, _LEFT, _RIGHT = 900, 70, 14
_INNER = _WIDTH - _LEFT - _RIGHT
_TITLE, _CHART, _STRIP, _GAP = 18, 66, 7, 14

# The colours of the report. All rules begin with .etlc: a notebook has styles of its own.
_STYLE = "".join(
    ".etlc " + rule
    for rule in (
        "text{font:11px sans-serif;fill:#5d6b7c}", ".name{font-weight:600;fill:#1b2330}",
        ".line{fill:none;stroke:#0b4f7c;stroke-width:1.4}",
        ".bounds{fill:#0072b2;fill-opacity:.11}",
        ".threshold{fill:none;stroke:#b34700;stroke-width:1.3;stroke-dasharray:5 3}",
        ".axis{stroke:#d7dee6}", ".yes{fill:#0072b2}", ".violated{fill:#d55e00}",
        ".open{fill:#a7b0ba}", ".so-far{fill-opacity:.4}",
    )
)  # fmt: skip


@dataclass
class _Lane:
    name: str
    text: str
    values: Array
    levels: Array
    lower: Array | None = None
    upper: Array | None = None
    status: Array | None = None


def timeline(episode: Episode) -> str:
    """Returns the picture."""
    steps = len(episode)
    top = 4.0
    parts: list[str] = []
    for lane in _lanes(episode):
        drawing = _Drawing(lane, steps, top)
        parts.append(drawing.text())
        top = drawing.bottom
    parts.append(_time(steps, episode.step_seconds, top))
    height = top + 36
    return (
        f'<svg class="etlc" xmlns="http://www.w3.org/2000/svg" width="{_WIDTH}" '
        f'height="{height:g}" viewBox="0 0 {_WIDTH} {height:g}">\n<style>{_STYLE}</style>\n'
        f'<rect width="{_WIDTH}" height="{height:g}" fill="#ffffff"/>\n'
        f'<g transform="translate({_LEFT},0)">\n{"".join(parts)}</g>\n</svg>\n'
    )


def _lanes(episode: Episode) -> Iterator[_Lane]:
    none = np.full(len(episode), np.nan, "f4")
    for name, distance in episode.distances.items():
        levels = episode.thresholds.get(name, none)
        yield _Lane(name, episode.texts.get(name, ""), distance, levels)
    for one in episode:
        yield _Lane(
            one.name, episode.texts.get(one.name, ""), one.robustness,
            np.zeros(len(episode), "f4"), one.lower, one.upper, one._status,
        )  # fmt: skip


def _time(steps: int, seconds: float, top: float) -> str:
    last = max(steps - 1, 0)
    text = ""
    for part in range(5):
        shown = last * part / 4 * (seconds or 1)
        text += _words(_INNER * part / 4, top + 8, f"{shown:.4g}", "middle" if part < 4 else "end")
    return text + _words(_INNER / 2, top + 24, "time, s" if seconds else "step", "middle")


def _words(x: float, y: float, text: str, anchor: str = "start", kind: str = "") -> str:
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" class="{kind}">'
        f"{escaped(text)}</text>\n"
    )


class _Drawing:
    """Draws a lane: its name, its chart, and the strip of its verdicts."""

    def __init__(self, lane: _Lane, steps: int, top: float) -> None:
        self._lane, self._steps, self._top = lane, steps, top
        self.bottom = top + _TITLE + _CHART + 2 + _GAP
        if lane.status is not None:
            self.bottom += _STRIP + 2
        shown = np.concatenate([lane.values, lane.levels])
        shown = shown[np.isfinite(shown)].astype("f8")
        low, high = extremes(shown)
        room = (high - low) * 0.06 if high > low else 0.5
        self._low, self._high = low - room, high + room

    def text(self) -> str:
        lane, top = self._lane, self._top
        text = _words(0, top + 13, lane.name, "start", "name")
        text += _words(8 + 7.5 * len(lane.name), top + 13, lane.text)
        for part in (0.1, 0.9):
            value = self._low + (self._high - self._low) * part
            text += _words(-6, float(self._y(np.array(value))) + 4, f"{value:.3g}", "end")
        if lane.lower is not None and lane.upper is not None:
            text += self._bounds(lane.lower, lane.upper)
        edge = top + _TITLE
        text += f'<line class="axis" y1="{edge:g}" y2="{edge + _CHART:g}"/>\n'
        text += f'<path class="threshold" d="{self._path(lane.levels)}"/>\n'
        text += f'<path class="line" d="{self._path(lane.values)}"/>\n'
        return text if lane.status is None else text + self._strip(lane.status)

    def _x(self, step: Array) -> Array:
        found: Array = np.clip(step / max(self._steps - 1, 1), 0, 1) * _INNER
        return found

    def _y(self, value: Array) -> Array:
        part = np.clip((value - self._low) / (self._high - self._low), 0, 1)
        found: Array = self._top + _TITLE + _CHART * (1 - part)
        return found

    def _path(self, values: Array) -> str:
        """Returns a path through the numbers, with gaps, or through the extremes of each pixel."""
        width = max(1, self._steps // _INNER)
        path, drawn = "", False
        for first in range(0, self._steps, width):
            here = values[first : first + width]
            here = here[np.isfinite(here)]
            if here.size == 0:
                drawn = False
                continue
            x = float(self._x(np.array(first)))
            y = self._y(np.array([untyped.min(here), untyped.max(here)], "f8"))
            path += f"{'L' if drawn else 'M'}{x:.1f} {y[0]:.1f}"
            if here.size > 1 and y[1] != y[0]:
                path += f"L{x:.1f} {y[1]:.1f}"
            drawn = True
        return path

    def _bounds(self, lower: Array, upper: Array) -> str:
        at: Array = untyped.arange(0, self._steps, max(1, self._steps // _INNER))
        at = at[~np.isnan(lower[at])]
        xs = self._x(at).tolist()
        above = zip(xs, self._y(upper[at].astype("f8")).tolist())
        below = zip(xs, self._y(lower[at].astype("f8")).tolist())
        around = [*above, *reversed(list(below))]
        path = "L".join(f"{x:.1f} {y:.1f}" for x, y in around)
        return f'<path class="bounds" d="M{path}Z"/>\n' if around else ""

    def _strip(self, status: Array) -> str:
        top = self._top + _TITLE + _CHART + 2
        text = _words(-6, top + _STRIP, "verdict", "end")
        ends = np.flatnonzero(np.diff(status)) + 1
        for first, end in zip([0, *ends.tolist()], [*ends.tolist(), self._steps]):
            if first == end:
                continue
            left, right = self._x(np.array([first - 0.5, end - 0.5])).tolist()
            text += (
                f'<rect class="{_kind(int(status[first]))}" x="{left:.1f}" y="{top:.1f}" '
                f'width="{max(right - left, 0.8):.1f}" height="{_STRIP}"/>\n'
            )
        return text


def _kind(status: int) -> str:
    kind = "yes" if status & SATISFIED else "violated" if status & VIOLATED else "open"
    return kind if status & FINAL and status & DECIDED else f"{kind} so-far"
