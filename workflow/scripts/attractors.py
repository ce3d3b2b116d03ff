"""Attractors of all laws, their branches numbered alike where one law turns into the other."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.stability.settings import SearchSettings
from burridge_knopoff.study.model import models_of
from burridge_knopoff.summaries import attractors, refined
from burridge_knopoff.summaries.between import named_alike, with_branches_between
from burridge_knopoff.summaries.results import write_results

params = snakemake.params
parts, further = ([open_summary(path) for path in paths] for paths in (snakemake.input.grid, snakemake.input.refined))
models = models_of(params.model, params.a, params.blocks)
numbers = attractors.branch_numbers(parts, models, SearchSettings(**params.attractors))
on_grid = attractors.merge(parts, numbers)
write_results(on_grid, attractors, snakemake.output[:2])
everywhere = refined.merge(further, with_branches_between(numbers, further))
write_summary(named_alike(everywhere, on_grid), snakemake.output[2])
