"""Report: all results of a study in one HTML file."""

import sys
from pathlib import Path

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)

from burridge_knopoff.provenance.seal import check_seal
from burridge_knopoff.report.page import Sources, write_report
from burridge_knopoff.study.study import Study

params = snakemake.params
paths = [Path(path) for path in (*snakemake.input.summaries, *snakemake.input.figures, *params.optional)]
summaries, figures = ({path.stem: path for path in paths if path.suffix == suffix} for suffix in (".nc", ".png"))
for path in (*snakemake.input.claims, *snakemake.input.figures):
    check_seal(path)
claims = [Path(path) for path in snakemake.input.claims]
sources = Sources(claims[0] if claims else None, summaries, figures, Path(params.benchmarks))
write_report(Study(params.config, params.parameters), sources, params.arguments, *next(iter(params.seals.items())))
