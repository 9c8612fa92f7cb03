"""Encoders: those of a spec for images in arrays, and models of this process for `embed`."""

from __future__ import annotations

import re
import struct
import subprocess
import tempfile
import threading
from pathlib import Path
from typing import Any, Mapping

import numpy as np

from ._arguments import is_mapping
from ._keywords import FilePath, path_of, words_of
from ._models import Encode, identity_of
from ._process import Ran, concluded, run, started
from ._serving import COMMAND, Server, write_frame
from ._types import Array
from .conversion import as_embedding, as_images
from .errors import ClosedError, Diagnostic, InputError, SpecError
from .names import no_such

_ENCODER = re.compile(r'^encoder (\w+) = load\("([^"]*)"\)', re.MULTILINE)
_ANOTHER = (
    "this model is not the one that {} stands for: {}. Episodes and thresholds made with that one "
    "do not fit it; to begin again with this model, remove the file"
)


class Encoder:
    """An encoder of a spec, for images in arrays: the embeddings are those of `etlc embed`.

    `encode`, or a call, takes images. Only one thread at a time encodes; others wait. Use it as a
    context manager, or call `close`.

    Args:
        spec: the path of the spec; `embed` must have made its SPEC.embedded.npz.
        name: the name of the encoder; may be left out where the spec has one.
        encoder: the model that encodes in this process, where `embed` was given one.
        encoder_command: the command that encodes, where `embed` was given one.
        onnxruntime, embedded, settings: as in `embed`.

    Attributes:
        name: the name of the encoder.

    Raises:
        SpecError: E1003 to E1006: there are no embeddings, or those of another model or settings.
            E1017: another library or model encodes here than in `embed`.
        InputError: an argument is invalid.

    Example:
        >>> with etlc.Encoder("look.etl") as encoder:
        ...     verdicts = monitor.step(z=encoder(camera.read()))
    """

    def __init__(
        self,
        spec: FilePath,
        name: str | None = None,
        *,
        encoder: Encode | None = None,
        encoder_command: str | None = None,
        onnxruntime: FilePath | None = None,
        embedded: FilePath | None = None,
        settings: Mapping[str, object] | None = None,
    ) -> None:
        known = encoders_of(spec)
        if name is None and len(known) > 1:
            raise InputError(f"the spec has several encoders: name one of {', '.join(known)}")
        self.name: str = next(iter(known), "") if name is None else name
        if self.name not in known:
            raise InputError(no_such("encoder", self.name, tuple(known)))
        self._turn = threading.Lock()
        self._model = encoder
        self._process: subprocess.Popen[bytes] | None = None
        self._dimension = 0
        given = {
            "spec": spec, "pipe": self.name, "encoder_command": encoder_command,
            "onnxruntime": onnxruntime, "embedded": embedded, "settings": settings,
        }  # fmt: skip
        if encoder is None:
            self._said = tempfile.TemporaryFile()  # closed by `close`
            self._process = started(
                words_of("embed", given), stdin=subprocess.PIPE, stderr=self._said
            )
            self._encode_in_pipe(np.zeros((480, 640, 3), np.uint8))  # errors come now
            return
        expect_identity(known[self.name], identity_of(encoder), may_write=False)
        run(words_of("embed", {**given, "encoder_command": "true"}))  # checks the embeddings

    def encode(self, images: Any) -> Array:
        """Encodes one image, or several.

        Args:
            images: uint8, (rows, columns, 3) or (N, rows, columns, 3), red first.

        Returns:
            The embedding, float32 (D,), or (N, D).

        Raises:
            InputError: the images have another type or shape.
            SpecError: the encoder failed and is closed; the message gives the reason.
            ClosedError: it is closed.
        """
        array = as_images(images)
        with self._turn:
            if self._model is None and self._process is None:
                raise ClosedError("the encoder is closed")
            rows = [
                self._encode_in_pipe(image) if self._model is None
                else as_embedding(self._model(image.copy()))
                for image in array
            ]  # fmt: skip
        shape = (len(rows), self._dimension) if not rows else (len(rows), len(rows[0]))
        together: Array = np.array(rows, "f4").reshape(shape)
        return together if np.ndim(images) == 4 else together.reshape(shape[1])

    def __call__(self, images: Any) -> Array:
        """The same as `encode`."""
        return self.encode(images)

    def _encode_in_pipe(self, image: Array) -> Array:
        process = self._process
        assert process is not None and process.stdin is not None and process.stdout is not None
        try:
            process.stdin.write(write_frame(image))
            process.stdin.flush()
        except OSError:  # it has ended
            self._fail(process)
        if self._dimension == 0:
            head = process.stdout.read(4)
            if len(head) < 4:
                self._fail(process)
            (self._dimension,) = struct.unpack("<I", head)
        data = process.stdout.read(4 * self._dimension)
        if len(data) < 4 * self._dimension:
            self._fail(process)
        return np.frombuffer(data, "<f4")

    def _fail(self, process: subprocess.Popen[bytes]) -> None:
        """Raises what the program said in the end."""
        status = process.wait()
        self._said.seek(0)
        said = self._said.read()
        self.close()
        concluded(status or 1, b"", said)

    def close(self) -> None:
        """Ends the encoder. Every later call raises ClosedError."""
        process, self._process, self._model = self._process, None, None
        if process is None:
            return
        for stream in (process.stdin, process.stdout):
            try:
                if stream is not None:
                    stream.close()
            except OSError:  # the program has ended
                pass
        process.terminate()
        process.wait()
        self._said.close()

    def __enter__(self) -> Encoder:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        if hasattr(self, "_process"):
            self.close()

    def __repr__(self) -> str:
        return f"<etlc.Encoder {self.name}>"


def encoders_of(spec: FilePath) -> dict[str, Path]:
    """Returns the paths of the files that stand for the encoders of a spec, by name."""
    text = run(words_of("compile", {"spec": spec, "emit": "ast"}), quiet=True).report
    return {name: path_of("spec", spec).parent / file for name, file in _ENCODER.findall(text)}


def expect_identity(file: Path, identity: str, may_write: bool) -> bool:
    """Refuses a model that is not the one which a file stands for. Returns whether it wrote it."""
    if may_write and not file.exists():
        file.write_text(identity, encoding="utf-8")
        return True
    try:
        found = file.read_bytes()
    except OSError as error:
        raise _refusal(file, f"cannot be read: {error.strerror}; etlc.embed makes it") from None
    if found != identity.encode():
        raise _refusal(file, _ANOTHER.format(file.name, _difference(found, identity)))
    return False


def _difference(found: bytes, identity: str) -> str:
    then = found.decode(errors="replace").splitlines()
    now = identity.splitlines()
    if then[:1] != now[:1]:
        return "it is no hash of a model in Python"
    libraries = [f"{one} here" for one in now[2:] if one not in then]
    libraries += [f"{one} then" for one in then[2:] if one not in now]
    return ", ".join(libraries) or "its weights, code or settings differ"


def _refusal(file: Path, message: str) -> SpecError:
    one = Diagnostic("E1017", "error", message, str(file))
    return SpecError(str(one), [one])


def embed_here(
    spec: FilePath, encoder: Encode | Mapping[str, Encode], given: Mapping[str, Any]
) -> Ran:
    """Runs `etlc embed` with models of this process."""
    if given["encoder_command"] is not None:
        raise InputError("encoder and encoder_command exclude each other")
    known = encoders_of(spec)
    given_models: Any = encoder  # one, or a dict
    models: dict[str, Encode]
    if is_mapping(encoder):
        models = dict(given_models)
    elif len(known) == 1:
        models = {name: given_models for name in known}
    else:
        raise InputError(f"encoder is one model, and the spec has {len(known)} encoders: pass a "
                         "dict by name")  # fmt: skip
    if set(models) != set(known):
        raise InputError(
            f"encoder is for {', '.join(sorted(models))}, the spec has {', '.join(sorted(known))}"
        )
    identities = {name: identity_of(model) for name, model in models.items()}
    written = [
        known[name] for name, identity in identities.items()
        if expect_identity(known[name], identity, may_write=True)
    ]  # fmt: skip
    words = words_of("embed", {**given, "encoder_command": COMMAND})
    with Server(models) as server:
        try:
            return run(words, variables=server.variables)
        except BaseException:
            for file in written:  # the next call makes it again
                file.unlink(missing_ok=True)
            if server.error is not None:
                raise server.error
            raise
