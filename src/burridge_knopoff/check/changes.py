"""What has changed in a study since its files were made, in the words of its config."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path

import netCDF4

from burridge_knopoff.dataset.variables import NETCDF_LOCK
from burridge_knopoff.provenance.keys import MISSING, difference, value_of
from burridge_knopoff.provenance.origin import Origin, embedded_origin
from burridge_knopoff.study.study import Study


def changes(study: Study, results: Path, sources: Mapping[str, str]) -> dict[str, list[str]]:
    """Return {change: rules that it concerns}, such as {`attractors.samples: 100 → 120`: [attractors_of_law, …]}.

    The changes are those since the files of the study that have their origin in them were made; corrupt files count as
    new.

    sources : {file of the study: its current sources, see `provenance.origin`}
    """
    rules: dict[str, list[str]] = defaultdict(list)
    for name, current in sources.items():
        if (results / name).is_file() and (origin := _origin(results / name)):
            for change in _changes(origin, study, current):
                rules[change] += [origin.rule] * (origin.rule not in rules[change])
    return rules


def _origin(path: Path) -> Origin | None:
    """Return the origin of a file without a check of its content; None if it has none, or none that can be read."""
    # Whatever netCDF4 and others make of a missing file or of overwritten bytes.
    with suppress(OSError, RuntimeError, SyntaxError, TypeError, ValueError, AttributeError):
        if path.suffix != ".nc":
            return Origin(**embedded_origin(path))
        with NETCDF_LOCK, netCDF4.Dataset(path) as dataset:
            return Origin.from_attributes(vars(dataset))
    return None


def _changes(origin: Origin, study: Study, sources: str) -> Iterator[str]:
    for key, value in origin.params.items():
        now = value_of(study.config, study.parameters, key)
        if now is not MISSING and (change := difference(value, now, key, "{}: {} → {}")):
            yield change
    if origin.rule_fingerprint != sources:
        yield "the sources"
