"""Attractors of one law along a, at the values of the grid and at values added between them."""

import logging
import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
logging.basicConfig(level=logging.INFO, format="%(message)s")

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.continuation.along_a import continue_attractors
from burridge_knopoff.continuation.settings import Refine
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.study.model import model_of

params, law = snakemake.params, snakemake.wildcards.law
initial = [InitialState(name, **state) for name, state in params.initial.items()]
models = [model_of(params.model, law, a, params.model["chain"]["blocks"]) for a in params.grid]
settings, motion = SearchSettings(**params.attractors), MotionSettings(**params.motion)
refine = Refine(**params.refine)
share = {"processes": snakemake.resources.cpus_per_task, "folder": params.kept}
found = continue_attractors(models, settings, motion, refine, starts=initial, start=params.start, **share)

# Imported late: each process of the search would otherwise hold another 40 MB, for writing files.
from burridge_knopoff.attractors.stored_returns import returns_of_law
from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.summaries import attractors, refined

on_grid = attractors.one_law(found, initial, settings, motion, params.start)
between = refined.one_law(found, settings, motion, refine, params.start)
returns = returns_of_law(models, [found.rows(k) for k in found.grid], on_grid.attrs)
for dataset, (path, about) in zip((on_grid, between, returns), params.seals.items(), strict=True):
    write_summary(dataset, path, about)
