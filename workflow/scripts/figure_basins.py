"""Figure: maps of basins of attraction."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.figures.basins import draw
from burridge_knopoff.figures.style import write_figure

basins, attractors = (open_summary(path) for path in snakemake.input)
write_figure(draw(basins, attractors, snakemake.params.marked), *snakemake.output)
