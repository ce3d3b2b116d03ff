"""Figure: the friction laws, and the least friction in the runs."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.figures.friction_laws import draw
from burridge_knopoff.figures.style import write_figure

runs = open_summary(snakemake.input[0])
write_figure(draw(sorted({snakemake.params.a, snakemake.params.largest}), runs), *snakemake.output)
