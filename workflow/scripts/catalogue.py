"""Summary: statistics of slip events."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.summaries.catalogue import summarize

params = snakemake.params
catalogues = map(open_summary, snakemake.input)
write_summary(summarize(catalogues, params.laws, params.grid, **params.fit), *next(iter(params.seals.items())))
