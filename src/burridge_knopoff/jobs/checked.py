"""Checks that files of a study are whole, and were made for their place in it and with its params."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from burridge_knopoff.dataset.run import open_run
from burridge_knopoff.jobs.jobs import Jobs
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.provenance.origin import Origin, check_origin
from burridge_knopoff.provenance.sums import check_sum, read_sums
from burridge_knopoff.study.chunks import incomplete_chunks


def check_file(jobs: Jobs, results: Path, name: str, record: Mapping[str, Any]) -> tuple[Origin | None, str]:
    """Check a file of a study, by its name in the results; return its origin, None for a run, and its checksum.

    Raises BadFile, one line with the difference, if the file is missing, damaged, or not the expected one. Files that
    other sources made are accepted.
    """
    path = results / name
    if command := jobs.command(name):
        with open_run(path, command) as dataset:
            return None, dataset.checksum
    return check_origin(path, results, record)


def damaged_files(jobs: Jobs, results: Path) -> list[tuple[Path, str]]:
    """Return damaged texts and pictures, which few jobs read, and marks of incomplete chunks, each with the reason."""
    damaged, sums = [], read_sums(results)
    for name in jobs.all_files:
        if not name.endswith(".nc") and (results / name).is_file():
            try:
                check_sum(results, name, sums)
            except BadFile as error:
                damaged.append((error.path, error.reason))
    marks = incomplete_chunks(jobs.study, results)
    return [*damaged, *((mark, "a point of this chunk is missing or was changed") for mark in marks)]
