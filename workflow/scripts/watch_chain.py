"""Chain file: the outcome of the sampled initial states for one number of blocks."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.motion.chain_settings import Sample, Watch
from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries.chains import chain_dataset

params, blocks = snakemake.params, int(snakemake.wildcards.blocks)
models = [model_of(params.model, law, params.grid[0], blocks) for law in params.model["laws"]]
watch = Watch(**params.watch, **params.motion)
dataset = chain_dataset(models, params.grid, Sample(**params.sample), watch)
write_summary(dataset, *next(iter(params.seals.items())))
