"""Attractors of all laws, their branches numbered alike where one law turns into the other."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.stability.settings import SearchSettings
from burridge_knopoff.study.model import models_of
from burridge_knopoff.summaries import attractors, refined
from burridge_knopoff.summaries.results import write_results

params = snakemake.params
parts = [open_summary(path) for path in snakemake.input.grid]
models = models_of(params.model, params.a, params.blocks)
numbers = attractors.branch_numbers(parts, models, SearchSettings(**params.attractors))
write_results(attractors.merge(parts, numbers), attractors, snakemake.output[:2])
write_summary(refined.merge([open_summary(path) for path in snakemake.input.refined], numbers), snakemake.output[2])
