"""Summary: uniform sliding, and how its perturbations grow."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.summaries.equilibrium import summarize

params = snakemake.params
write_summary(summarize(params.blocks, params.grid, params.v), snakemake.output[0])
