"""Basins: one tile of a map, or its pairs of near states."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.stability.settings import BasinSettings, MotionSettings, SearchSettings
from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries.basins import pairs, tile

params = snakemake.params
attractors = open_summary(snakemake.input[0])
plane = BasinSettings(initial=InitialState(**params.state), threads=snakemake.resources.cpus_per_task, **params.basins)
model = model_of(params.model, snakemake.wildcards.law, params.a, len(plane.initial.position))
chosen = plane, SearchSettings(**params.attractors), MotionSettings(**params.motion), params.start
number = snakemake.wildcards.get("tile")
found = pairs(attractors, model, *chosen) if number is None else tile(attractors, model, int(number), *chosen)
write_summary(found, *next(iter(snakemake.params.seals.items())))
