"""The names of monitors, which verdicts are looked up by."""

# pyright: reportPrivateUsage=false
from __future__ import annotations

import difflib


class Names:
    """The names of the monitors of a spec, in its order."""

    monitors: tuple[str, ...]
    _offsets: dict[str, int]
    #: How often verdicts were returned; none for names without a monitor.
    _said: int = -1

    def _name_monitors(self, monitors: tuple[str, ...]) -> None:
        #: The names of the monitors, in the order of the spec.
        self.monitors = monitors
        #: Where the verdict of each is among the bytes of a step.
        self._offsets = {name: 16 * m for m, name in enumerate(monitors)}


def names_of(monitors: tuple[str, ...]) -> Names:
    """Returns names without a monitor, for verdicts that were pickled."""
    names = Names()
    names._name_monitors(monitors)
    return names


def is_text(value: object) -> bool:
    """Whether it can be a name; the caller may have passed anything."""
    return isinstance(value, str)


def no_such(kind: str, name: object, names: tuple[str, ...]) -> str:
    """Says that the spec has no such name, and which is near it."""
    near = difflib.get_close_matches(str(name), names, 1)
    hint = f"; did you mean {near[0]!r}?" if near else f", only {', '.join(names) or 'none'}"
    return f"the spec has no {kind} {name!r}{hint}"
