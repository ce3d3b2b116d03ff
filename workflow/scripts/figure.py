"""Draw a figure of summaries, or of single runs by their initial states."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

import gc
from importlib import import_module

from burridge_knopoff.study.study import Study
from burridge_knopoff.summaries.points import Grid, open_point

# A figure is drawn quickly, and garbage collection would take a tenth of the time.
gc.disable()
figure = import_module(f"burridge_knopoff.figures.{job.params.figure}")
if figure.INPUTS == ("points",):
    grid = Grid.of_config(job.results / "points", {**job.config, "a": [job.config["figures"]["a"]]})
    job.write(figure.draw({initial: open_point(grid, law, initial, a) for _, (law, initial, a) in grid}))
else:
    study = Study.of_keys(job.config)
    properties = {name: getattr(study, name) for name in getattr(figure, "FROM_STUDY", ())}
    job.write(figure.draw(*job.summaries("summaries"), **properties))
