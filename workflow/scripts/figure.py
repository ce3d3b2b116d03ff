"""Draw a figure of summaries, or of single runs by their initial states."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

import gc
from importlib import import_module

from burridge_knopoff.study.study import Study, all_points
from burridge_knopoff.summaries.points import open_point

# A figure is drawn quickly, and garbage collection would take a tenth of the time.
gc.disable()
figure = import_module(f"burridge_knopoff.figures.{job.params.figure}")
if figure.INPUTS == ("points",):
    study = Study.of_keys({**job.config, "a": [job.config["figures"]["a"]]})
    points = {point["initial"]: point for point in all_points(study)}
    job.write(figure.draw({initial: open_point(study, job.results, point) for initial, point in points.items()}))
else:
    properties = {name: getattr(job.study, name) for name in getattr(figure, "FROM_STUDY", ())}
    job.write(figure.draw(*job.summaries("summaries"), **properties))
