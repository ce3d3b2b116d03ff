"""Phases of the end blocks under one law."""

import logging
import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
logging.basicConfig(level=logging.INFO, format="%(message)s")

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.attractors.stored_returns import known_attractors
from burridge_knopoff.basins.settings import PhaseSettings
from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries.phases import one_law

params = snakemake.params
attractors, returns = map(open_summary, snakemake.input)
models = [model_of(params.model, snakemake.wildcards.law, a, params.blocks) for a in params.grid]
known = [known_attractors(attractors, returns, model) for model in models]
limit = SearchSettings(**params.attractors).label_limit
dataset = one_law(known, PhaseSettings(**params.phases), limit, snakemake.resources.cpus_per_task)
write_summary(dataset, *next(iter(params.seals.items())))
