"""Figure: velocities and positions at the end of a run."""

import sys
from pathlib import Path

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.figures.motion import draw
from burridge_knopoff.figures.style import write_figure
from burridge_knopoff.summaries.points import Grid, open_point

params = snakemake.params
grid = Grid.of(Path(snakemake.input[0]).parents[2], params.points)
write_figure(draw(open_point(grid, params.law, snakemake.wildcards.initial, params.a)), *snakemake.output)
