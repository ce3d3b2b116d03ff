"""Summary: attractors of both laws."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.provenance.files import write_text
from burridge_knopoff.summaries.attractors import digest, merge

dataset = merge([open_summary(path) for path in snakemake.input])
write_summary(dataset, snakemake.output.dataset)
write_text(snakemake.output.digest, digest(dataset))
