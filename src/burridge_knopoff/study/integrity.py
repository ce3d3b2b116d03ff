"""Checks that files of a study are whole, and were made for their place in it and with its params."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from burridge_knopoff.dataset.run import open_run
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.provenance.origin import Origin, check_origin
from burridge_knopoff.provenance.sums import check_sum, read_sums
from burridge_knopoff.study.chunks import incomplete_chunks
from burridge_knopoff.study.study import Study


def check_file(
    study: Study, results: Path, name: str, record: Mapping[str, Any], run: Mapping[str, str] | None
) -> tuple[Origin | None, str]:
    """Check a file of a study, by its name in the results; return its origin, None for a run, and its checksum.

    record : of the study; run : the wildcards of the run if it is a point file, see `run_files`
    Raises BadFile, one line with the difference, if the file is missing, corrupt, or not the expected one. Files that
    other sources made are accepted.
    """
    if run is None:
        return check_origin(results / name, results, record)
    with open_run(results / name, study.command(**run)) as dataset:
        return None, dataset.checksum


def corrupt_files(study: Study, results: Path, names: Iterable[str]) -> list[tuple[Path, str]]:
    """Return corrupt texts and pictures, which few jobs read, and marks of incomplete chunks, each with the reason.

    names : of the files of the study in its results
    """
    corrupt, sums, marks = [], read_sums(results), incomplete_chunks(study, results)
    for name in names:
        if not name.endswith((".nc", ".done")) and (results / name).is_file():
            try:
                check_sum(results, name, sums)
            except BadFile as error:
                corrupt.append((error.path, error.reason))
    return [*corrupt, *((mark, "a point of this chunk is missing or was changed") for mark in marks)]
