"""Merge the edge states of all friction laws."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.edges import merge
from burridge_knopoff.summaries.edges_in_words import edges_in_words

edges = merge(job.summaries("edges"))
job.write(edges, edges_in_words(edges))
