"""Summary: independent solvers of the same equations."""

import sys
from pathlib import Path

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.summaries.points import Grid
from burridge_knopoff.summaries.solvers import summarize

params = snakemake.params
folder = Path(params.folder)
grid = Grid.of(folder / "points", params.points)
others = {solver: grid.elsewhere(folder / "solvers" / solver, settings) for solver, settings in params.others.items()}
path = snakemake.output[0]
write_summary(summarize(grid, others, params.step), path, params.seals[path])
