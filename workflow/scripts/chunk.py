"""Simulate the points of a chunk that are missing, damaged or out of date."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.provenance.files import reserve_room

reserve_room(sys.stderr)

from pathlib import Path

from burridge_knopoff.provenance.keys import nested
from burridge_knopoff.study.chunks import chunks
from burridge_knopoff.study.points import make_points
from burridge_knopoff.study.study import Study

study = Study.of_keys(nested(snakemake.params.config))
make_points(study, chunks(study)[snakemake.wildcards.chunk], Path(snakemake.output[0]).parents[1] / "points")
