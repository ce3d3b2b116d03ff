"""Summary of the models of a study, made by the module of its name."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from importlib import import_module

from burridge_knopoff.study.model import models_of
from burridge_knopoff.summaries.results import write_results

params = snakemake.params
module = import_module(f"burridge_knopoff.summaries.{params.summary}")
models = models_of(params.model, params.grid[0], params.blocks)
write_results(module.summarize(models, params.grid), module, snakemake.params.seals)
