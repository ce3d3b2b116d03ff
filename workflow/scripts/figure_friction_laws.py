"""Figure: the friction laws, and the least friction in the runs."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.figures.friction_laws import draw
from burridge_knopoff.figures.style import write_figure
from burridge_knopoff.laws import law_of

params = snakemake.params
laws = [law_of(name, params.a, description) for name, description in params.laws.items()]
figure = draw(laws, sorted({params.a, params.largest}), open_summary(snakemake.input[0]))
write_figure(figure, *snakemake.output)
