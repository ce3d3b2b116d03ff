"""Summary: the synchronized orbit and where it is lost."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.summaries.orbits import summarize

write_summary(summarize(**snakemake.params.model, grid=snakemake.params.grid), snakemake.output[0])
