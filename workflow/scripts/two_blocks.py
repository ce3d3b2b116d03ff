"""Summary: two blocks under the linearized and the nonlinear law."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.stability.chains import Sample
from burridge_knopoff.summaries.two_blocks import BLOCKS, run_settings, summarize

params = snakemake.params
initial = Sample(samples=params.two_blocks["samples"], symmetric_samples=0, **params.sample).initial(BLOCKS)
settings = run_settings(**params.settings)
dataset = summarize(initial, params.two_blocks["a"], settings, params.threshold, params.motion, params.agreement)
write_summary(dataset, snakemake.output[0])
