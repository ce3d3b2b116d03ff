"""Summary: attractors of both laws."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.summaries.attractors import merge

write_summary(merge([open_summary(path) for path in snakemake.input]), snakemake.output[0])
