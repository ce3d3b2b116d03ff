"""Figure: bifurcation diagrams of both laws."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.figures.bifurcation import draw
from burridge_knopoff.figures.style import write_figure
from burridge_knopoff.friction import LAWS

write_figure(draw(open_summary(snakemake.input[0]), list(LAWS)), *snakemake.output)
