"""Summary: the mean distance over law, initial state and a."""

import sys
from pathlib import Path

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.summaries.mean_distance import summarize
from burridge_knopoff.summaries.points import Grid

grid = Grid.of(Path(snakemake.input[0]).parents[2], snakemake.params.points)
write_summary(summarize(grid, snakemake.params.threshold), snakemake.output[0])
