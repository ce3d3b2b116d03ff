"""Does a job: its function makes the content of the files, which are written with their origin."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

import xarray

from burridge_knopoff.dataset.given import Given
from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.provenance.files import write_text
from burridge_knopoff.provenance.keys import nested
from burridge_knopoff.provenance.origin import Origin, check_origin, other_params, with_origin
from burridge_knopoff.provenance.record import NAME, read_study_record
from burridge_knopoff.provenance.sums import add_sums


def do_job(
    make: str, rule: str, fingerprint: str, config: Mapping[str, Any], given: Given, outputs: Sequence[str | Path]
) -> None:
    """Make the files of a job.

    make : "package.module:function", called with `given` and the config
    rule, fingerprint : name of the rule, and fingerprint of its sources
    config : {key: value} on which the files depend, see `provenance.keys`

    Raises BadFile if an input is damaged or not the expected one, ValueError if the results belong to another config,
    OSError if a file cannot be written, and the errors of the function.
    """
    record = read_study_record(given.results)
    if words := other_params(config, record):
        raise ValueError(f"{given.results / NAME}: another run has changed the config ({words}); run snakemake again")
    params: dict[str, Any] = {}
    inputs: dict[str, str] = {}
    for path in (path for paths in given.inputs.values() for path in paths):
        origin, checksum = check_origin(path, given.results, record)
        params |= origin.params if origin else {}
        inputs[path.relative_to(given.results).as_posix()] = checksum
    room, _, function = make.partition(":")
    made = getattr(import_module(f"burridge_knopoff.{room}"), function)(given, nested(config))
    contents = made if isinstance(made, tuple) else (made,) * len(outputs)
    names = [Path(path).relative_to(given.results).as_posix() for path in outputs]
    pictures = {}
    for name, content in zip(names, contents, strict=True):
        path, origin = given.results / name, Origin(name, rule, {**params, **config}, inputs, fingerprint)
        if isinstance(content, xarray.Dataset):
            write_summary(content.assign_attrs(origin.attributes()), path)
        elif isinstance(content, str):
            write_text(path, with_origin(content, name, origin))
        else:
            pictures[path] = origin
    if pictures:
        from burridge_knopoff.figures.style import write_figure

        write_figure(made, *pictures, origins={path: vars(origin) for path, origin in pictures.items()})
    add_sums(given.results, [name for name in names if not name.endswith(".nc")])
