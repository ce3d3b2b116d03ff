"""Basins: one tile of a map."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.summaries.basins import tile

params, law, number = snakemake.params, snakemake.wildcards.law, int(snakemake.wildcards.tile)
attractors = open_summary(snakemake.input[0])
write_summary(tile(attractors, law, params.a, number, params.config, snakemake.threads), snakemake.output[0])
