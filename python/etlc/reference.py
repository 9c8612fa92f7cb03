"""The call of a Monitor about the encoder of the robot."""

from __future__ import annotations

from ctypes import POINTER, byref, c_double, c_float
from typing import Any

import numpy as np

from . import conversion
from ._arguments import is_whole
from ._library import call, encoded, library
from .description import REFERENCE_FRAMES, Described
from .errors import InputError


class Referring(Described):
    """An open session with embeddings of the reference frames."""

    def encoder_difference(self, frame: int, embedding: Any, encoder: str | None = None) -> float:
        """Returns how far this machine's encoder is from the one of calibration.

        Args:
            frame: the number of a reference frame, from 0 to REFERENCE_FRAMES - 1. `etlc embed
                --write-reference FOLDER` writes them.
            embedding: what the encoder makes of it.
            encoder: the name of the encoder; may be left out where the spec has one.

        Returns:
            |z - r| / |r|, where r is what `etlc embed` made of the frame; infinity where the
            embedding is not finite.
        """
        array = conversion.as_elements(
            "embedding", embedding, np.dtype("f4"), (np.size(embedding),)
        )  # fmt: skip
        values = np.ascontiguousarray(array)
        if not is_whole(frame) or not 0 <= frame < REFERENCE_FRAMES:
            raise InputError(f"frame is {frame!r}, expected 0 to {REFERENCE_FRAMES - 1}")
        name = None if encoder is None else encoded("encoder", encoder)
        difference = c_double()
        call(
            library.etlc_encoder_difference, self._session, name, frame,
            values.ctypes.data_as(POINTER(c_float)), values.size, byref(difference),
        )  # fmt: skip
        return difference.value

    def encoder_agrees(
        self, frame: int, embedding: Any, encoder: str | None = None, tolerance: float = 1e-3
    ) -> bool:
        """Returns whether this machine's encoder is the one of calibration, but for rounding.

        Ask for each reference frame before the first step: verdicts mean nothing with another
        encoder. `encoder_difference` says what the arguments are. `tolerance` is its largest value.
        """
        return self.encoder_difference(frame, embedding, encoder) <= tolerance
