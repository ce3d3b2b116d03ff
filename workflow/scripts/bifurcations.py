"""Merge the bifurcations of all friction laws."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.bifurcations import listing, merge_laws

edges = next(iter(job.summaries("edges")), None)
bifurcations = merge_laws(job.summaries("bifurcations"), edges)
job.write(bifurcations, listing(bifurcations))
