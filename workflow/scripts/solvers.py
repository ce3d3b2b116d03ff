"""Summary: independent solvers of the same equations."""

import sys
from pathlib import Path

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.summaries.points import Grid
from burridge_knopoff.summaries.solvers import summarize

params = snakemake.params
grid = Grid(Path(snakemake.input.points[0]).parents[2], tuple(params.initial), params.grid)
folder = Path(snakemake.input.others[0]).parents[3]
write_summary(summarize(grid, folder, params.solvers, params.step), snakemake.output[0])
