"""Summary of points, other summaries and keys of the config, made by the module of its name."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from importlib import import_module

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.summaries.points import Grid
from burridge_knopoff.summaries.results import write_results

params = snakemake.params
grid = Grid.of(params.folder, params.points)
others = [open_summary(path) for path in snakemake.input.summaries]
module = import_module(f"burridge_knopoff.summaries.{params.summary}")
write_results(module.summarize(grid, *others, **params.config), module, params.seals)
