"""Figure: mirror synchrony of longer chains, and two blocks under each law."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.figures.chains import draw
from burridge_knopoff.figures.style import write_figure

figure = draw(open_summary(snakemake.input.chains), open_summary(snakemake.input.two_blocks))
write_figure(figure, *snakemake.output)
