"""Simulate the points of a chunk that are missing, damaged or out of date."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.provenance.files import reserve_room

reserve_room(sys.stderr)

from pathlib import Path

from burridge_knopoff.provenance.record import read_study_record
from burridge_knopoff.provenance.seal import canonical_json, identity
from burridge_knopoff.study.chunks import chunks
from burridge_knopoff.study.points import make_points
from burridge_knopoff.study.study import Study

folder = Path(snakemake.params.folder)
record = read_study_record(folder)
study = Study(record["config"], record["grid"])
if identity(canonical_json(study.points)) != snakemake.params.points:
    raise ValueError(f"{folder}: now belongs to another config, as another run has changed it; run snakemake again")
make_points(study, chunks(study)[snakemake.wildcards.chunk], folder / "points")
