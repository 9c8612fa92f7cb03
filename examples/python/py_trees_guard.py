"""A condition of a behaviour tree (py_trees): a guard says whether the task may go on.

    watched = Sequence("watched", memory=False, children=[Guarded("guard", guard, see), policy])
    root = Selector("root", memory=False, children=[watched, hand_over])

In the tick of an alarm the policy is interrupted and `hand_over` begins. The condition must be
ticked once for each step: put it first, under composites with memory=False.
"""

from __future__ import annotations

from typing import Any, Callable

import py_trees

import etlc


class Guarded(py_trees.behaviour.Behaviour):
    """SUCCESS while the guard says "continue", else FAILURE; `answer` has what it said.

    `see` returns the observation of this tick.
    A condition is never RUNNING, so py_trees calls `initialise` and `terminate` at each tick:
    neither may reset the guard. `begin` does, where the program begins an episode.
    """

    def __init__(self, name: str, guard: etlc.Guard, see: Callable[[], Any]) -> None:
        super().__init__(name)
        self.guard = guard
        self.answer = "continue"
        self._see = see

    def update(self) -> py_trees.common.Status:
        """Judges the observation of this tick."""
        self.answer = self.guard.step(self._see())
        self.feedback_message = f"{self.answer}: {self.guard.verdicts!r}"
        if self.answer == "continue":
            return py_trees.common.Status.SUCCESS
        return py_trees.common.Status.FAILURE

    def begin(self) -> None:
        """Begins a new episode."""
        self.guard.reset()
        self.answer = "continue"
