"""Basins: one tile of a map, or its pairs of nearby states."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.attractors.stored_returns import known_attractors
from burridge_knopoff.basins.settings import BasinSettings
from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries.basins import pairs, tile

params, number = snakemake.params, snakemake.wildcards.get("tile")
plane = BasinSettings(initial=InitialState(**params.state), threads=snakemake.resources.cpus_per_task, **params.basins)
model = model_of(params.model, snakemake.wildcards.law, params.a, params.model["chain"]["blocks"])
known = known_attractors(*map(open_summary, snakemake.input), model)
search = SearchSettings(**params.attractors)
if number is None:
    found = pairs(known, plane, search.label_limit, search.seed, params.start)
else:
    found = tile(known, int(number), plane, search.label_limit, params.start)
write_summary(found, *next(iter(params.seals.items())))
