"""Basins: pairs of near states of a map."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.summaries.basins import pairs

params, law = snakemake.params, snakemake.wildcards.law
attractors = open_summary(snakemake.input[0])
write_summary(pairs(attractors, law, params.a, params.config, snakemake.threads), snakemake.output[0])
