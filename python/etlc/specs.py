"""The commands about a spec alone: `check` and `compile`."""

from __future__ import annotations

from typing import Mapping

from ._keywords import FilePath, checks_names, path_of, words_of
from ._process import run
from .results import Checked, Written


@checks_names
def check(
    spec: FilePath,
    *,
    thresholds: FilePath | None = None,
    fitted: FilePath | None = None,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    values: str | None = None,
    targets_as: str | None = None,
    lets: bool = False,
    explain: bool = False,
    retargetable: bool = False,
    recorder: str | tuple[int | str, int | str, int] | None = None,
    max_state: int | None = None,
    max_code: int | None = None,
    max_work: int | None = None,
    warnings_are_errors: bool = False,
) -> Checked:
    """Checks a spec (`etlc SPEC --check`). Files that do not exist yet are no errors.

    Args:
        spec: the path of the spec.
        thresholds, fitted, embedded: files for the spec; by default those beside it.
        settings: other values for constants: {"limit": 0.25, "deadline": "2s"}.
        values, targets_as, lets, explain, retargetable, recorder: as in `compile`.
        max_state, max_code, max_work: limits of the plan in bytes of state, bytes of code and
            operations per step.
        warnings_are_errors: whether a warning fails the check.

    Returns:
        The warnings, which are also Python's.

    Raises:
        SpecError: the spec does not compile; its `diagnostics` give the places.
        InputError: an argument is invalid.
    """
    given = locals()
    return Checked(run(words_of("compile", {**given, "check": True})).diagnostics)


@checks_names
def compile(
    spec: FilePath,
    output: FilePath,
    *,
    emit: str | None = None,
    standalone: bool | str = False,
    namespace: str | None = None,
    thresholds: FilePath | None = None,
    fitted: FilePath | None = None,
    embedded: FilePath | None = None,
    settings: Mapping[str, object] | None = None,
    values: str | None = None,
    targets_as: str | None = None,
    lets: bool = False,
    explain: bool = False,
    retargetable: bool = False,
    recorder: str | tuple[int | str, int | str, int] | None = None,
    inline_targets: int | None = None,
    targets_file: FilePath | None = None,
    depfile: FilePath | None = None,
    max_state: int | None = None,
    max_code: int | None = None,
    max_work: int | None = None,
    warnings_are_errors: bool = False,
) -> Written:
    """Compiles a spec to a C++ header.

    Args:
        spec: the path of the spec.
        output: the header.
        emit: write a stage in place of the header: "ast", "graph", "plan", "hpp", "params", "dot"
            or "report".
        standalone: include the runtime: True or "portable", or "host".
        namespace: of the generated code; by default the name of the spec.
        thresholds, fitted, embedded, settings, max_state, max_code, max_work,
            warnings_are_errors: as in `check`.
        values: "robustness", or "boolean" for verdicts without numbers.
        targets_as: the storage of target sets: "f32", "f16" or "i8".
        lets: also generate the robustness of lets.
        explain: generate the functions that name the sample which decides a verdict.
        retargetable: store targets, thresholds and other numbers in a file that can be replaced.
        recorder: record the steps around each alarm: the numbers of steps before and after it, and
            of alarms, as (40, 20, 4) or "2s,1s,4".
        inline_targets: the bytes of the largest target set that is written into the header.
        targets_file: the file for larger ones; by default STEM.targets.bin beside the header.
        depfile: also write the dependencies of the output, for make and ninja.

    Raises:
        SpecError: the spec does not compile; its `diagnostics` give the places.
        InputError: an argument is invalid.
    """
    ran = run(words_of("compile", locals()))
    return Written(path_of("output", output), ran.report, ran.diagnostics)
