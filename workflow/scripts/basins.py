"""Summary: maps of basins of attraction."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.provenance.files import write_text
from burridge_knopoff.stability.settings import BasinSettings
from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries.basins import digest, merge

params = snakemake.params
plane = BasinSettings(initial=InitialState(**params.state), **params.basins)
blocks = len(plane.initial.position)
tiles, pairs = ([open_summary(path) for path in paths] for paths in (snakemake.input.tiles, snakemake.input.pairs))
maps = [
    (model_of(params.model, law, a, blocks), tiles[n * plane.tiles : (n + 1) * plane.tiles], pairs[n])
    for n, (law, a) in enumerate(params.maps)
]
dataset = merge(maps, list(params.model["laws"]), plane, params.time_limit, params.start)
write_summary(dataset, snakemake.output.dataset)
write_text(snakemake.output.digest, digest(dataset))
