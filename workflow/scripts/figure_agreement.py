"""Figure: agreement of the laws against a."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.figures.agreement import draw
from burridge_knopoff.figures.style import write_figure

write_figure(draw(open_summary(snakemake.input[0])), *snakemake.output)
