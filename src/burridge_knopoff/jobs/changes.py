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
    found: dict[str, list[str]] = defaultdict(list)
    for name, (rule, job) in jobs.all_files.items():
        if name.endswith(".nc") and (results / name).is_file():
            # Whatever netCDF4 makes of overwritten bytes.
            with suppress(OSError, RuntimeError, TypeError, ValueError), netCDF4.Dataset(results / name) as dataset:
                if origin := Origin.from_attributes(vars(dataset)):
                    for change in _changes(origin, jobs.config(rule, job), source_fingerprint(*rule.sources)):
                        found[change] += [rule.name] * (rule.name not in found[change])
    return found


def _changes(origin: Origin, config: Mapping[str, object], fingerprint: str) -> Iterator[str]:
    for key, value in config.items():
        if key in origin.params and (change := difference(origin.params[key], value, key, "{}: {} → {}")):
            yield change
    if origin.rule_fingerprint != fingerprint:
        yield "the sources"
