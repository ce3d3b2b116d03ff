"""Summary: two blocks under each law."""

import logging
import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
logging.basicConfig(level=logging.INFO, format="%(message)s")

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.dataset.summary import write_summary
from burridge_knopoff.motion.chain_settings import Sample
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries.two_blocks import BLOCKS, run_settings, summarize

params = snakemake.params
grid, samples = params.two_blocks["a"], params.two_blocks["samples"]
models = [model_of(params.model, law, grid[0], BLOCKS) for law in params.model["laws"]]
initial = Sample(samples=samples, symmetric_samples=0, **params.sample).initial(BLOCKS)
settings = run_settings(**params.settings)
judged = SearchSettings(**params.search), MotionSettings(**params.motion), params.agreement
found = summarize(models, initial, grid, settings, *judged, processes=snakemake.resources.cpus_per_task)
write_summary(found, *next(iter(snakemake.params.seals.items())))
