"""Summary: fraction of the sampled states that synchronize, over number of blocks and a."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.summaries.chains import summarize

write_summary(summarize(snakemake.input), snakemake.output[0])
