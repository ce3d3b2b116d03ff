"""Does a job: its function makes the content of the files, which are written and sealed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

import xarray

from burridge_knopoff.dataset.given import Given
from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.provenance.seal import BadFile, digest_of, read_seal, write_sealed_text

#: Keys of a description that are not params of the function that makes the file.
_ABOUT = ("file", "make", "points", "of_points", "sources", "inputs")


def do_job(
    abouts: Mapping[str, Mapping[str, Any]],
    results: Path,
    inputs: Mapping[str, Sequence[str | Path]],
    wildcards: Mapping[str, str],
    cores: int = 1,
    arguments: Sequence[str] = (),
) -> None:
    """Make the files of a job.

    abouts : {file: its description}, see `Jobs.abouts`
    results : folder of the study; inputs, wildcards, cores, arguments : see `Given`

    Raises BadFile if an input is damaged or not the expected one, OSError if a file cannot be written, and the errors
    of the function.
    """
    about = next(iter(abouts.values()))
    room, _, function = about["make"].partition(":")
    files = {name: [Path(path) for path in paths] for name, paths in inputs.items()}
    for path in (path for paths in files.values() for path in paths):
        _check(path, results, about["inputs"].get(path.relative_to(results).as_posix()))
    given = Given(results, files, about.get("points", {}), wildcards, cores, arguments)
    params = {name: value for name, value in about.items() if name not in _ABOUT}
    made = getattr(import_module(f"burridge_knopoff.{room}"), function)(given, **params)
    contents = made if isinstance(made, tuple) else (made,) * len(abouts)
    pictures = {}
    for (name, each), content in zip(abouts.items(), contents, strict=True):
        path = results / name
        if isinstance(content, xarray.Dataset):
            write_summary(content, path, each)
        elif isinstance(content, str):
            write_sealed_text(path, content, each)
        else:
            pictures[str(path)] = each
    if pictures:
        from burridge_knopoff.figures.style import write_figure

        write_figure(made, *pictures, seals=pictures)


def _check(path: Path, results: Path, digest: str | None) -> None:
    """Raise BadFile if an input is damaged or has another digest; points have none and are checked when read."""
    if digest is not None and digest_of(read_seal(path)[0]) != digest:
        # A job needs the study only to give the reason.
        from burridge_knopoff.jobs.checked import check_result

        check_result(path, any_sources=False)
        raise BadFile(path, "was not made from the config and by the sources of this run")
