"""Summary: uniform sliding, and how its perturbations grow."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries.equilibrium import summarize

params = snakemake.params
models = [model_of(params.model, law, params.grid[0], params.blocks) for law in params.model["laws"]]
write_summary(summarize(models, params.grid), snakemake.output[0])
