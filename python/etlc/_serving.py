"""Lets `etlc embed` use models of this process: it runs _relay.py, which connects to here."""

from __future__ import annotations

import os
import shlex
import shutil
import socket
import struct
import sys
import tempfile
import threading
from typing import BinaryIO, Mapping

import numpy as np

from . import _relay
from ._models import Encode
from ._types import Array
from .conversion import as_embedding

#: The command that connects. It is the same in each call, so episodes need not be made again.
COMMAND = shlex.join([sys.executable, "-I", _relay.__file__])


class Server:
    """Serves models, by the names of encoders, until it is closed.

    Attributes:
        variables: what the environment of the command needs.
        error: what a model raised first, or None.
    """

    def __init__(self, models: Mapping[str, Encode]) -> None:
        self._models = models
        self._folder = tempfile.mkdtemp(prefix="etlc")
        path = os.path.join(self._folder, "encoder")
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.bind(path)
        self._socket.listen()
        self._turn = threading.Lock()  # models need not allow calls from several threads
        self.variables = {"ETLC_PYTHON_ENCODER": path}
        self.error: BaseException | None = None
        self._accepting = threading.Thread(target=self._accept, daemon=True)
        self._accepting.start()

    def __enter__(self) -> Server:
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.shutdown(socket.SHUT_RDWR)
        self._accepting.join()
        self._socket.close()
        shutil.rmtree(self._folder)

    def _accept(self) -> None:
        while True:
            try:
                connection, _ = self._socket.accept()
            except OSError:  # closed
                return
            threading.Thread(target=self._serve, args=(connection,), daemon=True).start()

    def _serve(self, connection: socket.socket) -> None:
        with connection, connection.makefile("rb") as frames:
            try:
                model = self._models[frames.readline().decode().strip()]
                dimension = 0
                while (image := read_frame(frames)) is not None:
                    with self._turn:
                        z = as_embedding(model(image))
                    if dimension == 0:
                        connection.sendall(struct.pack("<I", z.size))
                    dimension = dimension or z.size
                    connection.sendall(z.tobytes())
            except OSError:  # etlc has ended, and says why
                pass
            except BaseException as error:  # of the model: the caller raises it again
                self.error = self.error or error


def read_frame(frames: BinaryIO) -> Array | None:
    """Reads an image, uint8 (rows, columns, 3); None at the end."""
    head = frames.read(8)
    if len(head) < 8:
        return None
    rows, columns = struct.unpack("<II", head)
    pixels = frames.read(rows * columns * 3)
    if len(pixels) < rows * columns * 3:
        return None
    return np.frombuffer(bytearray(pixels), np.uint8).reshape(rows, columns, 3)


def write_frame(image: Array) -> bytes:
    """Returns the bytes of an image, as `read_frame` takes them."""
    return struct.pack("<II", *image.shape[:2]) + image.tobytes()
