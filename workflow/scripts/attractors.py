"""Attractors of all laws; branches that continue into each other have the same number."""

import logging
import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
logging.basicConfig(level=logging.INFO, format="%(message)s")

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.study.model import models_of
from burridge_knopoff.summaries import all_laws, refined, rotation
from burridge_knopoff.summaries.results import write_results

params = snakemake.params
parts, further = ([open_summary(path) for path in paths] for paths in (snakemake.input.grid, snakemake.input.refined))
models = models_of(params.model, params.a, params.blocks)
numbers = all_laws.branch_numbers(parts, models, SearchSettings(**params.attractors), snakemake.threads)
on_grid = all_laws.merge(parts, numbers)
*paths, between, turns = snakemake.output
write_results(on_grid, all_laws, {path: params.seals[path] for path in paths})
numbers = all_laws.with_branches_between(numbers, further)
everywhere = all_laws.merge(further, numbers, refined.VARIABLES, "Attractors at refined values of a")
everywhere = all_laws.named_alike(everywhere, on_grid)
write_summary(everywhere, between, params.seals[between])
write_summary(rotation.summarize(everywhere, models), turns, params.seals[turns])
