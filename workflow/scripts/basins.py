"""Summary: basin maps."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.basins.settings import BasinSettings
from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries import basins
from burridge_knopoff.summaries.results import write_results

params = snakemake.params
plane = BasinSettings(initial=InitialState(**params.state), **params.basins)
blocks = params.model["chain"]["blocks"]
tiles, pairs = ([open_summary(path) for path in paths] for paths in (snakemake.input.tiles, snakemake.input.pairs))
maps = [
    (model_of(params.model, law, a, blocks), tiles[n * plane.tiles : (n + 1) * plane.tiles], pairs[n])
    for n, (law, a) in enumerate(params.maps)
]
attractors, limit = open_summary(snakemake.input.attractors), SearchSettings(**params.attractors).label_limit
dataset = basins.merge(maps, attractors, list(params.model["laws"]), plane, limit, params.start)
write_results(dataset, basins, snakemake.params.seals)
