"""The commands that run until they are stopped: `label` and `watch`; and `propose`."""

from __future__ import annotations

import json
import subprocess
import threading
from typing import Iterator, Mapping, TypeVar

from ._keywords import FilePath, FilePaths, checks_names, words_of
from ._process import concluded, run, started
from .results import Suggestions


_Self = TypeVar("_Self", bound="Running")


class Running:
    """A program that runs until it is stopped. Always true.

    Use it as a context manager, or call `stop`.
    """

    def __init__(self, process: subprocess.Popen[bytes]) -> None:
        """For `label` and `watch`."""
        self._process = process
        self._said = b""
        self._hearing = threading.Thread(target=self._hear, daemon=True)
        self._hearing.start()

    def _hear(self) -> None:
        """Reads what the program says, so that it never waits."""
        assert self._process.stderr is not None
        self._said = self._process.stderr.read()

    def _lines(self) -> Iterator[str]:
        """Yields the lines that the program prints, until it ends."""
        assert self._process.stdout is not None
        while line := self._process.stdout.readline():
            yield line.decode(errors="replace").rstrip()

    def wait(self) -> None:
        """Waits until the program ends, which `stop` or Ctrl-C does.

        Raises:
            SpecError: it failed.
        """
        try:
            status = self._process.wait()
        finally:
            self.stop()
        if status > 0:  # it was not stopped
            concluded(status, b"", self._said)

    def stop(self) -> None:
        """Ends the program."""
        if self._process.poll() is None:
            self._process.terminate()
        self._process.wait()
        self._hearing.join()
        for stream in (self._process.stdout, self._process.stderr):
            if stream is not None:
                stream.close()

    def __enter__(self: _Self) -> _Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()


class Labelling(Running):
    """A page that is served: `label` makes one. Always true.

    Use it as a context manager, or call `stop`; labels are in their tables at any time.

    Attributes:
        address: the page, for a browser on this machine.
        tables: the tables of labels.
    """

    def __init__(self, process: subprocess.Popen[bytes]) -> None:
        """For `label`. Raises if the program ends before it serves the page."""
        super().__init__(process)
        lines = self._lines()
        self.address: str = next(lines, "")
        self.tables: tuple[str, ...] = ()
        for line in lines:
            if not line.startswith("Labels go to "):
                break
            self.tables += (line.removeprefix("Labels go to ").removesuffix("."),)
        if not self.address.startswith("http"):
            self.wait()

    def __repr__(self) -> str:
        return f"<etlc.Labelling {self.address}: {', '.join(self.tables)}>"


class Watching(Running):
    """A camera that is watched: `watch` makes one. Always true.

    Iterate over it for a line of text for each change, until the camera ends.
    """

    def __iter__(self) -> Iterator[str]:
        yield from self._lines()
        self.wait()


@checks_names
def label(
    spec: FilePath,
    data: FilePaths,
    *,
    labels: FilePath | None = None,
    frames: str | None = None,
    camera: str | None = None,
    port: int | None = None,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    groups: str | None = None,
    split: str | None = None,
    jobs: int | None = None,
    warnings_are_errors: bool = False,
) -> Labelling:
    """Serves a page, on this machine alone, on which you label the predicates of a spec.

    Args:
        spec: the path of the spec.
        data: episodes: files (.csv, .npz, .h5), folders, data sets or patterns.
        labels: the table of labels to write; by default labels.csv beside the episodes.
        frames: camera frames: an array of the episodes, the folder of a data set, or a pattern:
            "camera/{episode}/*.png".
        camera: the camera of a data set.
        port: that of the page; by default any free one.
        embedded, settings, names, groups, split, jobs, warnings_are_errors: as in `calibrate`.

    Returns:
        The page, until it is stopped; open its `address` in a browser.

    Raises:
        SpecError: there is no page; the message gives the reason.
        InputError: an argument is invalid.
    """
    return Labelling(started(words_of("label", locals())))


@checks_names
def propose(
    spec: FilePath,
    data: FilePaths,
    *,
    labels: FilePath | None = None,
    camera: str | None = None,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    groups: str | None = None,
    split: str | None = None,
    jobs: int | None = None,
    warnings_are_errors: bool = False,
) -> Suggestions:
    """Proposes labels for the episodes without (`etlc label --proposals`).

    Args:
        spec, data, labels, camera, embedded, settings, names, groups, split, jobs,
            warnings_are_errors: as in `label`.

    Raises:
        SpecError: the command failed; the message gives the reason.
        InputError: an argument is invalid.
    """
    ran = run(words_of("label", {**locals(), "proposals": True}))
    return Suggestions(json.loads(ran.report), ran.diagnostics)


@checks_names
def watch(
    spec: FilePath,
    video: FilePath,
    *,
    page: bool | int = False,
    record: FilePath | None = None,
    recorder: str | tuple[int | str, int | str, int] | None = None,
    encoder_command: str | None = None,
    encoder_timeout: int | None = None,
    onnxruntime: FilePath | None = None,
    thresholds: FilePath | None = None,
    fitted: FilePath | None = None,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    names: Mapping[str, str] | None = None,
    values: str | None = None,
    targets_as: str | None = None,
    max_state: int | None = None,
    max_code: int | None = None,
    max_work: int | None = None,
    warnings_are_errors: bool = False,
) -> Watching:
    """Follows a camera or a video, with a line for each change of a verdict.

    Args:
        spec: the path of the spec.
        video: a camera ("/dev/video0"), an address or a file.
        page: also serve a page, on any port or on this one.
        record, recorder: write the steps around each alarm into this folder.
        encoder_command, encoder_timeout, onnxruntime: as in `embed`.
        thresholds, fitted, embedded, settings, names, values, targets_as, max_state, max_code,
            max_work, warnings_are_errors: as in `evaluate`.

    Returns:
        What is running: `for line in etlc.watch(...)`, or `stop` it.

    Raises:
        InputError: an argument is invalid.
    """
    return Watching(started(words_of("watch", locals())))
