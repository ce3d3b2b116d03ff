"""Chain file: what becomes of the sampled initial states of one number of blocks."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.stability.chains import Sample, Watch
from burridge_knopoff.summaries.chains import chain_dataset

options, model = dict(snakemake.params.chains), snakemake.params.model
laws, grid = options.pop("laws"), options.pop("a")
watch = Watch(options.pop("time_limit"), options.pop("synchronization_distance"), snakemake.params.threshold)
sample = Sample(**options, start=model["start"])
chain = chain_dataset(int(snakemake.wildcards.blocks), laws, grid, sample, watch, model["v"], model["contact"])
write_summary(chain, snakemake.output[0])
