"""Figure of summaries and of properties of the study, drawn by the module of its name."""

import gc
import sys

# No garbage collection: the process ends soon, and collecting takes a tenth of the time.
gc.disable()
sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from importlib import import_module

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.figures.style import write_figure

params = snakemake.params
module = import_module(f"burridge_knopoff.figures.{params.figure}")
summaries = [open_summary(path) for path in snakemake.input]
write_figure(module.draw(*summaries, **params.from_study), *snakemake.output, seals=params.seals)
