"""Summary: the files of a stage's jobs, merged by the module of its rule."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from importlib import import_module

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.summaries.results import write_results

module = import_module(f"burridge_knopoff.summaries.{snakemake.params.summary}")
write_results(module.merge([open_summary(path) for path in snakemake.input]), module, snakemake.params.seals)
