"""Summary: Lyapunov exponents and kinds of motion."""

import sys
from pathlib import Path

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.summaries.lyapunov import summarize
from burridge_knopoff.summaries.points import Grid

grid = Grid.of(Path(snakemake.input[0]).parents[2], snakemake.params.points)
params = snakemake.params
write_summary(summarize(grid, params.exponents, params.threshold, params.motion), snakemake.output[0])
