"""Small tables for notebooks."""

from __future__ import annotations

import html
import math
from typing import Iterable, Sequence


def escaped(text: object) -> str:
    """Returns a text for HTML and SVG, without the control characters that XML forbids."""
    shown = "".join(
        one if one.isprintable() or one == " " else one.encode("unicode_escape").decode()
        for one in str(text)
    )
    return html.escape(shown)


def number(value: float | None) -> str:
    """Returns a number for people; a dash where there is none."""
    return "–" if value is None or math.isnan(value) else f"{value:.4g}"


def table(head: Sequence[str], rows: Iterable[Sequence[object]], title: str = "") -> str:
    """Returns a table with a line for each row."""

    def line(cells: Sequence[object], kind: str) -> str:
        begin = f'<{kind} style="text-align:left">'
        return "<tr>" + "".join(f"{begin}{escaped(one)}</{kind}>" for one in cells) + "</tr>"

    lines = "".join(line(row, "td") for row in rows)
    said = f"<p><b>{escaped(title)}</b></p>" if title else ""
    return f"{said}<table><thead>{line(head, 'th')}</thead><tbody>{lines}</tbody></table>"


def preformatted(text: str) -> str:
    """Returns a text that is set as it is, such as a report."""
    lines = "\n".join(map(escaped, text.splitlines()))
    return f"<pre>{lines}</pre>"
