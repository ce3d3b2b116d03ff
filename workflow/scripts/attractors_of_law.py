"""Attractors of one law along a."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.stability.settings import MotionSettings, SearchSettings
from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries.attractors import one_law

params, law = snakemake.params, snakemake.wildcards.law
initial = [InitialState(name, **state) for name, state in params.initial.items()]
model = model_of(params.model, law, params.grid[0], len(initial[0].position))
settings, motion = SearchSettings(**params.attractors), MotionSettings(**params.motion)
write_summary(one_law(model, params.grid, initial, settings, motion, params.start), snakemake.output[0])
