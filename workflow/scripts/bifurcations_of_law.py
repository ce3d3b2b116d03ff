"""Bifurcations of the branches of attractors under one law."""

import logging
import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
logging.basicConfig(level=logging.INFO, format="%(message)s")

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries.bifurcations import one_law

params, law = snakemake.params, snakemake.wildcards.law
attractors, refined = (open_summary(path).sel(law=law) for path in snakemake.input)
model = model_of(params.model, law, params.a, params.blocks)
dataset = one_law(model, attractors, refined, snakemake.resources.cpus_per_task, params.kept)
write_summary(dataset, *next(iter(params.seals.items())))
