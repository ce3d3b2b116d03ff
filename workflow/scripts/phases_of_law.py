"""Phases of the end blocks under one law."""

import logging
import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
logging.basicConfig(level=logging.INFO, format="%(message)s")

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.stability.settings import MotionSettings, PhaseSettings, SearchSettings
from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries.phases import one_law

params = snakemake.params
attractors = open_summary(snakemake.input[0])
model = model_of(params.model, snakemake.wildcards.law, params.grid[0], params.blocks)
how = PhaseSettings(**params.phases), SearchSettings(**params.attractors), MotionSettings(**params.motion)
dataset = one_law(attractors, model, params.grid, *how, processes=snakemake.resources.cpus_per_task)
write_summary(dataset, *next(iter(snakemake.params.seals.items())))
