"""Summary: each law compared with the first one, as netCDF, CSV and a few lines."""

import sys
from pathlib import Path

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.provenance.files import write_text
from burridge_knopoff.summaries.agreement import digest, summarize, table
from burridge_knopoff.summaries.points import Grid

grid = Grid.of(Path(snakemake.input.points[0]).parents[2], snakemake.params.points)
lyapunov = open_summary(snakemake.input.lyapunov[0])
dataset = summarize(grid, lyapunov, snakemake.params.threshold, snakemake.params.agreement)
write_summary(dataset, snakemake.output.dataset)
write_text(snakemake.output.table, table(dataset))
write_text(snakemake.output.digest, digest(dataset))
