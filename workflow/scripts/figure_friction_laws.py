"""Figure: the friction laws."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.figures.friction_laws import draw
from burridge_knopoff.figures.style import write_figure

write_figure(draw(sorted({snakemake.params.a, snakemake.params.largest})), *snakemake.output)
