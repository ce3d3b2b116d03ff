"""Simulate the points of a chunk that are missing, corrupt or out of date."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.study.chunks import chunks
from burridge_knopoff.study.points import make_points

make_points(job.study, chunks(job.study)[job.wildcards.chunk], job.folder)
