"""Figure: J against time, for each initial state."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.figures.distance import draw
from burridge_knopoff.figures.style import write_figure

write_figure(draw({name: open_summary(path) for name, path in snakemake.input.items()}), *snakemake.output)
