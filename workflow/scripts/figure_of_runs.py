"""Figure of single runs, drawn by the module of its name."""

import gc
import sys

# No garbage collection: the process ends soon, and collecting takes a tenth of the time.
gc.disable()
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from importlib import import_module

from burridge_knopoff.figures.style import write_figure
from burridge_knopoff.summaries.points import Grid, open_point

params = snakemake.params
module = import_module(f"burridge_knopoff.figures.{params.figure}")
grid = Grid.of(params.folder, params.runs)
runs = {initial: open_point(grid, law, initial, a) for _, (law, initial, a) in grid}
write_figure(module.draw(runs), *snakemake.output, seals=params.seals)
