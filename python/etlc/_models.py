"""The identity of a model in this process: a hash of everything that it computes with.

A spec names a file for each encoder, and etlc refuses embeddings by another file. For a model in
Python that file holds this hash, so all of etlc guards it: episodes, thresholds, classes.
"""

from __future__ import annotations

import dis
import hashlib
import importlib.util
import os
import sys
import sysconfig
import types
from pathlib import Path
from typing import Any, Callable, Iterable

import numpy as np

from .errors import InputError

_LIBRARIES = tuple(os.path.realpath(path) + os.sep for path in sysconfig.get_paths().values())
_ATOMS = (type(None), bool, int, float, complex, str, bytes, bytearray, type(...))
#: Members of a class that say nothing about what it computes.
_NOT_COMPUTED = {"__module__", "__doc__", "__dict__", "__weakref__", "__qualname__",
                 "__firstlineno__", "__static_attributes__", "__annotations__", "__parameters__",
                 "__orig_bases__", "_abc_impl"}  # fmt: skip


def identity_of(model: object) -> str:
    """Returns the text of the file that stands for a model.

    The hash covers its weights and buffers bit by bit, its code and that of functions which it
    calls, its settings, and the versions of the libraries that run it.

    Raises:
        InputError: some of it cannot be hashed; the message says where that is.
    """
    walk = _Walk()
    walk.add(model)
    versions = "".join(f"{name} {version}\n" for name, version in sorted(walk.libraries.items()))
    return f"a model in Python\nsha256 {walk.digest()}\n{versions}"


class _Walk:
    """Adds objects to a hash, each once."""

    def __init__(self) -> None:
        self._hash = hashlib.sha256()
        self._seen: dict[int, int] = {}
        self._kept: list[object] = []  # so that no other object gets the same id
        self._path: list[str] = []
        self.libraries: dict[str, str] = {"python": "{}.{}".format(*sys.version_info)}

    def digest(self) -> str:
        return self._hash.hexdigest()

    def add(self, one: Any, name: str = "") -> None:
        """Adds an object; `name` is its place in the one that has it, for messages."""
        self._path.append(name)
        if _exactly(one, *_ATOMS):
            self._say(type(one).__name__, repr(one).encode())
        elif _exactly(one, tuple, frozenset, set):
            self._add_values(one)
        elif id(one) in self._seen:
            self._say("again", str(self._seen[id(one)]).encode())
        else:
            self._seen[id(one)] = len(self._seen)
            self._kept.append(one)
            self._add_object(one)
        self._path.pop()

    def _say(self, kind: str, content: bytes = b"") -> None:
        self._hash.update(f"{kind} {len(content)}\n".encode())
        self._hash.update(content)

    def _add_values(self, values: Any) -> None:
        self._say(type(values).__name__, str(len(values)).encode())
        if _exactly(values, tuple):
            self._add_all(values)
        else:  # in any order
            for digest in sorted(self._digest_of(one) for one in values):
                self._say("of", digest.encode())

    def _digest_of(self, one: object) -> str:
        walk = _Walk()
        walk.add(one)
        self.libraries.update(walk.libraries)
        return walk.digest()

    def _add_all(self, values: Iterable[Any]) -> None:
        for at, value in enumerate(values):
            self.add(value, f"[{at}]")

    def _add_object(self, one: Any) -> None:
        torch = sys.modules.get("torch")
        if _exactly(one, list):
            self._say("list", str(len(one)).encode())
            self._add_all(one)
        elif _exactly(one, dict):
            self._say("dict", str(len(one)).encode())
            for key, value in one.items():
                self.add(key)
                self.add(value, f"[{key!r}]")
        elif _is(one, np.ndarray) and not one.dtype.hasobject:
            self._say(f"array {one.dtype.str} {one.shape}", np.ascontiguousarray(one).tobytes())
        elif torch is not None and isinstance(one, torch.Tensor):
            self._add_tensor(torch, one)
        elif _is(one, types.ModuleType):
            if not self._is_library(one.__name__):
                raise self._refusal(f"the module {one.__name__}, which is no library")
            self._say("module", one.__name__.encode())
        elif _is(one, types.MappingProxyType):
            self.add(dict(one))
        elif _is(one, types.CodeType):
            self._add_code(one)
        elif _is(one, type, types.FunctionType, types.BuiltinFunctionType):
            self._add_named(one)
        elif _is(one, property, classmethod, staticmethod, types.MethodType):
            self._say(type(one).__name__)
            for part in ("fget", "fset", "fdel", "__func__", "__self__"):
                self.add(getattr(one, part, None), f".{part}")
        else:
            self._add_reduced(one)

    def _add_tensor(self, torch: Any, one: Any) -> None:
        if one.layout != torch.strided or one.is_meta or one.is_quantized:
            raise self._refusal(f"a tensor that is {one.layout} on {one.device}")
        flat = one.detach().resolve_conj().resolve_neg().cpu().contiguous().reshape(-1)
        data = flat.view(torch.uint8).numpy().tobytes() if flat.numel() > 0 else b""
        self._say(f"tensor {one.dtype} {tuple(one.shape)}", data)

    def _add_named(self, one: Any) -> None:
        """Adds a function or a class: that of a library by its name, others with their code."""
        module = str(getattr(one, "__module__", None) or "builtins")
        name = str(getattr(one, "__qualname__", ""))
        receiver = getattr(one, "__self__", None)
        is_builtin = _is(one, types.BuiltinFunctionType)
        if is_builtin and not (receiver is None or _is(receiver, types.ModuleType)):
            self._say("method", name.encode())
            self.add(receiver, ".__self__")
        elif self._is_library(module):
            self._say("named", f"{module}.{name}".encode())
        elif is_builtin:  # of an extension of the user
            self._say("named", name.encode())
            self._say("extension", Path(sys.modules[module].__file__ or "").read_bytes())
        elif _is(one, type):
            self._say("class", name.encode())
            self._add_all(one.__bases__)
            members: dict[str, Any] = dict(one.__dict__)
            for key, value in sorted(members.items()):
                if key not in _NOT_COMPUTED and not _is(value, *_SLOTS):
                    self.add(key)
                    self.add(value, f".{key}")
        else:
            self._add_function(one)

    def _add_function(self, one: types.FunctionType) -> None:
        self._say("function")
        self.add(one.__code__)
        self.add(one.__defaults__, ".__defaults__")
        self.add(one.__kwdefaults__, ".__kwdefaults__")
        cells = zip(one.__code__.co_freevars, one.__closure__ or ())
        for name, cell in cells:
            try:
                content = cell.cell_contents
            except ValueError:  # not assigned yet
                continue
            self.add(content, f".{name}")
        names, imports = _looked_up(one.__code__)
        for name in sorted(names):
            if name in one.__globals__:
                self._add_global(name, one.__globals__[name], names)
        for level, name in sorted(imports):
            self._add_import("." * level + name, one.__globals__.get("__package__"), names)

    def _add_global(self, name: str, value: Any, names: set[str]) -> None:
        """Adds what a name means; of a module that is no library, what `names` mean in it."""
        self.add(name)
        members: dict[str, Any] = getattr(value, "__dict__", {})
        if not _is(value, types.ModuleType) or self._is_library(value.__name__):
            self.add(value, f".{name}")
            return
        for member in sorted(names & set(members)):
            if members[member] is not value:
                self._add_global(member, members[member], names)

    def _add_import(self, name: str, package: str | None, names: set[str]) -> None:
        """Adds a module that a function imports when it is called."""
        try:
            full = importlib.util.resolve_name(name, package)
            importlib.import_module(full)
        except ImportError:  # the function may catch it
            self._say("absent", name.encode())
            return
        for end in range(1, len(full.split(".")) + 1):
            part = ".".join(full.split(".")[:end])
            self._add_global(part, sys.modules[part], names)

    def _add_code(self, code: types.CodeType) -> None:
        self._say("code", code.co_code)
        numbers = (code.co_argcount, code.co_kwonlyargcount, code.co_posonlyargcount, code.co_flags)
        constants = code.co_consts[1:] if _has_docstring(code) else code.co_consts
        self.add((*numbers, code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars))
        self.add(constants)

    def _add_reduced(self, one: Any) -> None:
        """Adds an object as pickle would take it apart."""
        try:
            reduced: Any = one.__reduce_ex__(4)
        except Exception as error:  # whatever the class raises
            raise self._refusal(f"{type(one).__qualname__}: {error}")
        self._say("object")
        self.add(type(one), f"<{type(one).__qualname__}>")
        if isinstance(reduced, str):
            self._say("named", reduced.encode())
            self.add(getattr(one, "__dict__", None))  # what functools.lru_cache wraps, for example
            return
        parts: list[Any] = [*reduced, None, None, None]
        make, arguments, state, items, pairs = parts[:5]
        self.add(make, ".__reduce__")
        self.add(arguments)
        if _exactly(state, dict):
            for key, value in state.items():
                self.add(key)
                self.add(value, f".{key}")
        else:
            self.add(state)
        self._add_all(items or ())
        self._add_all(pairs or ())

    def _is_library(self, module: str) -> bool:
        """Returns whether a module belongs to Python or a package, and notes the version."""
        top = module.partition(".")[0]
        if top in sys.builtin_module_names or top in sys.stdlib_module_names:
            return top != "__main__"
        path = os.path.realpath(getattr(sys.modules.get(module), "__file__", None) or os.sep)
        is_installed = "/site-packages/" in path or "/dist-packages/" in path
        if not is_installed and not path.startswith(_LIBRARIES):
            return False
        self.libraries[top] = _version_of(top)
        return True

    def _refusal(self, what: str) -> InputError:
        place = "".join(self._path) or "itself"
        return InputError(
            f"the encoder cannot be recognised again: {place} is {what}. Pass a function whose "
            "model and settings are tensors, arrays and plain objects"
        )


_SLOTS = (types.MemberDescriptorType, types.GetSetDescriptorType)


def _exactly(one: Any, *kinds: type) -> bool:
    return type(one) in kinds


def _is(one: Any, *kinds: type) -> bool:
    return isinstance(one, kinds)


def _has_docstring(code: types.CodeType) -> bool:
    """Whether the first constant may be the docstring, which computes nothing."""
    first = code.co_consts[0] if code.co_consts else None
    return bool(code.co_flags & 0x2) and isinstance(first, str) and _loads_no_first(code)


def _loads_no_first(code: types.CodeType) -> bool:
    return all(
        one.argval is not code.co_consts[0]
        for one in dis.get_instructions(code)
        if one.opcode in dis.hasconst
    )


def _looked_up(code: types.CodeType) -> tuple[set[str], set[tuple[int, str]]]:
    """Returns the names that a function, or one within it, may look up, and what it imports."""
    names = set(code.co_names)
    imports: set[tuple[int, str]] = set()
    before: list[Any] = [0, 0]
    for one in dis.get_instructions(code):
        if one.opname == "IMPORT_NAME":  # the level was loaded before the list of names
            imports.add((before[-2] if isinstance(before[-2], int) else 0, str(one.argval)))
        before.append(one.argval)
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            more, others = _looked_up(constant)
            names, imports = names | more, imports | others
    return names, imports


def _version_of(package: str) -> str:
    import importlib.metadata

    version = getattr(sys.modules.get(package), "__version__", None)
    if isinstance(version, str):
        return version
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return "of unknown version"


#: What encodes an image: uint8 (rows, columns, 3) to a vector.
Encode = Callable[[Any], Any]
