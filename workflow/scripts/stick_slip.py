"""Summary: stick-slip cycles of each block."""

import sys
from pathlib import Path

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.summaries.points import Grid
from burridge_knopoff.summaries.stick_slip import summarize

params = snakemake.params
grid = Grid.of(Path(snakemake.input[0]).parents[2], params.points)
write_summary(summarize(grid, params.blocks, **params.window), snakemake.output[0])
