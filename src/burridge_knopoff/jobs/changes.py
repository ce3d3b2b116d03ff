"""What has changed in a study since its files were made, in the words of its config."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path

import netCDF4

from burridge_knopoff.jobs.jobs import Jobs
from burridge_knopoff.provenance.keys import difference
from burridge_knopoff.provenance.origin import Origin
from burridge_knopoff.provenance.sources import source_fingerprint


def changes(jobs: Jobs, results: Path) -> dict[str, list[str]]:
    """Return {change: rules that it concerns}, such as {`attractors.samples: 100 → 120`: [attractors_of_law]}.

    The changes are those since the netCDF files of the rules were made; damaged files count as new.
    """
    rules: dict[str, list[str]] = defaultdict(list)
    for name, (rule, job) in jobs.all_files.items():
        if name.endswith(".nc") and (origin := _origin(results / name)):
            for change in _changes(origin, jobs.config(rule, job), source_fingerprint(*rule.sources)):
                rules[change] += [rule.name] * (rule.name not in rules[change])
    return rules


def _origin(path: Path) -> Origin | None:
    """Return the origin of a netCDF file without a check of its content; None if it cannot be read."""
    # Whatever netCDF4 makes of a missing file or of overwritten bytes.
    with suppress(OSError, RuntimeError, TypeError, ValueError), netCDF4.Dataset(path) as dataset:
        return Origin.from_attributes(vars(dataset))
    return None


def _changes(origin: Origin, config: Mapping[str, object], fingerprint: str) -> Iterator[str]:
    for key, value in config.items():
        if key in origin.params and (change := difference(origin.params[key], value, key, "{}: {} → {}")):
            yield change
    if origin.rule_fingerprint != fingerprint:
        yield "the sources"
