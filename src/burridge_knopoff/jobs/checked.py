"""Checks that files of a study were made from its config, by the current sources, from the current inputs."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Collection
from pathlib import Path

from burridge_knopoff.jobs.jobs import Jobs
from burridge_knopoff.provenance.record import study_folder
from burridge_knopoff.provenance.seal import BadFile, config_part, describe_difference, first_difference, read_seal
from burridge_knopoff.study.chunks import incomplete_chunks
from burridge_knopoff.study.recorded import recorded_study


def check_file(jobs: Jobs, results: Path, name: str, *, any_sources: bool = False) -> str:
    """Check a file of a study, by its name in the results; return the status of its run, or "made" without a run.

    any_sources : accept a file made by other sources

    Raises BadFile, one line with the difference, if the file is missing, damaged, or not the expected one. If a bad
    input is the reason, the error names that input.
    """
    path = results / name
    found, status = read_seal(path)
    expected = jobs.expected(name)
    if expected is None:
        return status
    if any_sources:
        found, expected = config_part(found), config_part(expected)
        # Descriptions of another version may have more keys, or fewer.
        both = {"file"} | found.keys() & expected.keys()
        found, expected = ({key: one[key] for key in one if key in both} for one in (found, expected))
    if key := first_difference(found, expected):
        for other in expected.get("inputs", {}) if key == "inputs" else ():
            if found["inputs"].get(other) != expected["inputs"][other] and (results / other).is_file():
                check_file(jobs, results, other, any_sources=any_sources)
        raise BadFile(path, describe_difference(key, found, expected))
    return status


def damaged_files(jobs: Jobs, results: Path) -> list[tuple[Path, str]]:
    """Return damaged texts and pictures, which few jobs read, and marks of incomplete chunks, each with the reason."""
    found = []
    for name in jobs.all_files:
        path = results / name
        if path.suffix != ".nc" and path.is_file():
            try:
                read_seal(path)
            except BadFile as error:
                found.append((path, error.reason))
    marks = incomplete_chunks(jobs.study, results)
    return [*found, *((mark, "a point of this chunk is missing or was changed") for mark in marks)]


def check_result(path: Path, *, any_sources: bool = True) -> Collection[str]:
    """Check that a file is intact and, in a study, that it is the expected result.

    any_sources : accept a file made by other sources

    Returns the names of all files of the study except runs; none if the study is of another version, or cannot be read.
    Raises BadFile as `check_file` does.
    """
    folder, jobs = study_folder(path), None
    if folder is not None:
        with contextlib.suppress(ValueError, KeyError):
            jobs = Jobs(recorded_study(folder)[1])
    if folder is None or jobs is None:
        read_seal(path)
        return ()
    results = folder if path.is_absolute() else Path(os.path.relpath(folder))
    check_file(jobs, results, path.absolute().relative_to(folder).as_posix(), any_sources=any_sources)
    return jobs.all_files
