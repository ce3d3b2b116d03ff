"""Edges of the branches of attractors."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.study.model import models_of
from burridge_knopoff.summaries.edges import summarize

params = snakemake.params
models = models_of(params.model, params.a, params.blocks)
attractors, refined = (open_summary(path) for path in snakemake.input)
write_summary(summarize(models, attractors, refined), snakemake.output[0])
