"""Summary: maps of basins of attraction."""

import sys

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.summaries.basins import merge

params = snakemake.params
tiles = [open_summary(path) for path in snakemake.input]
count = params.config["basins"]["tiles"]
maps = [(law, a, tiles[n * count : (n + 1) * count]) for n, (law, a) in enumerate(params.maps)]
write_summary(merge(maps, params.config), snakemake.output[0])
