"""Attractors of one law along a."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.summaries.attractors import one_law

params = snakemake.params
write_summary(one_law(snakemake.wildcards.law, params.grid, params.initial, params.config), snakemake.output[0])
