"""The calls of a Monitor about earlier steps: incidents, and the explanation."""

from __future__ import annotations

import ctypes
import json
from ctypes import byref, c_char_p, c_size_t, c_uint32, c_void_p

from ._library import call, decoded, library
from .description import Described
from .verdicts import Explanation


class Keeping(Described):
    """An open session with a flight recorder or a history."""

    @property
    def incidents(self) -> tuple[bytes, ...]:
        """The complete incidents, each an alarm with the steps around it, for `etlc incident`.

        An incident is complete some steps after its alarm, or at the end of the episode (`reset`,
        `close_incidents`). It does not change after that.

        Raises:
            NotKeptError: the monitor was opened without a recorder.
        """
        incidents: list[bytes] = []
        for n in range(self._incident_counts()[0]):
            data, size = c_void_p(), c_size_t()
            call(library.etlc_incident, self._session, n, byref(data), byref(size))
            incidents.append(ctypes.string_at(data, size.value))
        return tuple(incidents)

    @property
    def lost_incidents(self) -> int:
        """The number of alarms that began while there was no room for another incident."""
        return self._incident_counts()[1]

    def close_incidents(self) -> None:
        """Completes pending incidents with the steps so far."""
        call(library.etlc_close_incidents, self._session)

    def forget_incidents(self) -> None:
        """Deletes the incidents to make room for new ones."""
        call(library.etlc_forget_incidents, self._session)

    def _incident_counts(self) -> tuple[int, int]:
        complete, lost = c_uint32(), c_uint32()
        call(library.etlc_incidents, self._session, byref(complete), byref(lost))
        return complete.value, lost.value

    def explain(self, monitor: str) -> Explanation:
        """Explains the last verdict of a monitor, like `etlc explain`.

        Raises:
            NotKeptError: the monitor was opened without a history as long as the episode.
            UndecidedError: there is no verdict yet.
        """

        at = self._at(self._monitor_at, "monitor", monitor)
        said: list[str] = []
        for form in (0, 1):
            text = c_char_p()
            call(library.etlc_explain, self._session, at, form, byref(text))
            said.append(decoded(text.value))
        return Explanation(said[0], json.loads(said[1]))
