"""Figure: drawn by the module of its name, of summaries or of single runs, and of properties of the study."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from importlib import import_module

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.figures.style import write_figure
from burridge_knopoff.summaries.points import Grid, open_runs

params = snakemake.params
if params.runs:
    sources = [open_runs(Grid.of(params.runs["folder"], params.runs))]
else:
    sources = [open_summary(path) for path in snakemake.input]
module = import_module(f"burridge_knopoff.figures.{params.figure}")
write_figure(module.draw(*sources, **params.from_study), *snakemake.output)
