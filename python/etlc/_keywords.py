"""Turns the arguments of a function into the words of a command, by the table of options."""

from __future__ import annotations

import difflib
import functools
import inspect
import os
from pathlib import Path
from typing import Any, Callable, Iterable, Mapping, ParamSpec, TypeVar, Union

import numpy as np

from ._arguments import flag, is_mapping
from ._library import encoded, encoded_path
from ._options import OPTIONS, Option
from .errors import InputError

FilePath = Union[str, "os.PathLike[str]"]
FilePaths = Union[FilePath, Iterable[FilePath]]

#: Arguments whose names differ from those of their options.
_RENAMED = {
    "W": "warnings_are_errors", "set": "settings", "map": "names", "episodes": "groups",
    "encoder-cmd": "encoder_command", "format": "form",
}  # fmt: skip
#: The values of options that are numbers.
_NUMBERS = ("N", "SECONDS", "MB")
#: Options of all commands that the package itself sets.
_OWN = ("--diagnostics",)

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


def keyword_of(option: Option) -> str:
    """Returns the name of the argument for an option."""
    name = option.name.lstrip("-")
    return _RENAMED.get(name, name.replace("-", "_"))


def options_of(command: str, without: Iterable[str] = ()) -> dict[str, Option]:
    """Returns the options that the function of a command takes, by argument."""
    left_out = {*_OWN, *without}
    return {
        keyword_of(option): option for option in OPTIONS[command] if option.name not in left_out
    }


def checks_names(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """Makes the TypeError about an argument that the function does not have more helpful."""
    known = tuple(inspect.signature(function).parameters)

    @functools.wraps(function)
    def checked(*arguments: Arguments.args, **keywords: Arguments.kwargs) -> Result:
        for name in keywords:
            if name not in known:
                near = difflib.get_close_matches(name, known, 1)
                hint = f"; did you mean {near[0]}?" if near else f", only {', '.join(known)}"
                raise TypeError(f"etlc.{function.__name__} has no option {name}{hint}")
        return function(*arguments, **keywords)

    return checked


def words_of(command: str, given: Mapping[str, Any]) -> list[bytes]:
    """Returns the words of a call: of each option in `given` that is not None or False.

    Positional words stand first: an option with several values would take them.
    """
    words = [] if command == "compile" else [command.encode()]
    options = options_of(command)
    unknown = set(given) - set(options)
    assert not unknown, unknown
    ordered = sorted(options.items(), key=lambda one: one[1].manner != "positional")
    for keyword, option in ordered:
        value = given.get(keyword)
        is_off = value is False and (
            option.manner in ("flag", "word", "any") or option.name == "-W"
        )
        if value is not None and not is_off:
            words += _words(keyword, option, value)
    is_heard = any(option.name == "--diagnostics" for option in OPTIONS[command])
    return [*words, b"--diagnostics", b"json"] if is_heard else words


def _words(keyword: str, option: Option, value: Any) -> list[bytes]:
    name = option.name.encode()
    if option.manner == "flag" or option.name == "-W":
        return [b"-Werror" if flag(keyword, value) and name == b"-W" else name]
    if isinstance(value, bool):
        if option.manner not in ("word", "any"):
            raise InputError(f"{keyword} is {value}, expected {option.value or 'a word'}")
        return [name]
    if "=" in option.value and not isinstance(value, str):
        return [
            encoded(keyword, f"{option.name}={one}={to}") for one, to in _pairs(keyword, value)
        ]
    if option.manner == "word":
        return [name + b"=" + encoded(keyword, value)]
    if option.manner in ("positional", "several", "any"):
        values = [_file_word(keyword, one) for one in _listed(keyword, option, value)]
        return values if option.manner == "positional" else [name, *values]
    return [name, encoded_path(keyword, _joined(keyword, option, value))]


def _file_word(keyword: str, value: Any) -> bytes:
    """Encodes one of several words, which must not be read as the name of an option."""
    word = encoded_path(keyword, value)
    return b"./" + word if word.startswith(b"-") else word


def _pairs(keyword: str, value: Any) -> Iterable[tuple[object, object]]:
    if not is_mapping(value):
        raise InputError(f"{keyword} is {value!r}, expected a dict")
    pairs: Iterable[tuple[object, object]] = value.items()
    return pairs


def _joined(keyword: str, option: Option, value: Any) -> str | bytes | os.PathLike[str]:
    """Returns a value as one word: (40, 20, 4) is "40,20,4", and a shard (1, 3) is "1/3"."""
    if is_path(value):
        path: FilePath = value
        return path
    between = next((sign for sign in "/," if sign in option.value), None)
    if between is not None and hasattr(value, "__iter__"):
        return between.join(map(str, value))
    if option.value in _NUMBERS and np.ndim(value) == 0 and np.asarray(value).dtype.kind in "iuf":
        return str(value)
    raise InputError(f"{keyword} is {value!r}, expected {option.value or 'a word'}")


def path_of(keyword: str, value: Any) -> Path:
    """Returns a path of the caller."""
    return Path(os.fsdecode(encoded_path(keyword, value)))


def output_of(spec: FilePath, output: FilePath | None, ending: str) -> Path:
    """Returns where a command writes: by default to a file beside the spec."""
    if output is not None:
        return path_of("output", output)
    return path_of("spec", spec).with_suffix(ending)


def _listed(keyword: str, option: Option, value: Any) -> list[FilePath]:
    """Returns one path, or several, as a list."""
    if is_path(value):
        return [value]
    if is_mapping(value) or not hasattr(value, "__iter__"):
        raise InputError(f"{keyword} is {value!r}, expected {option.value}")
    several: list[FilePath] = list(value)
    if not several:
        raise InputError(f"{keyword} is empty, expected {option.value}")
    return several


def is_path(value: Any) -> bool:
    return isinstance(value, (str, bytes, os.PathLike))
