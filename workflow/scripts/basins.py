"""Summary: maps of basins of attraction."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.files import write_text
from burridge_knopoff.summaries.basins import digest, merge

params = snakemake.params
tiles, pairs = ([open_summary(path) for path in paths] for paths in (snakemake.input.tiles, snakemake.input.pairs))
count = params.config["basins"]["tiles"]
maps = [(law, a, tiles[n * count : (n + 1) * count], pairs[n]) for n, (law, a) in enumerate(params.maps)]
dataset = merge(maps, params.config)
write_summary(dataset, snakemake.output.dataset)
write_text(snakemake.output.digest, digest(dataset))
