"""Compare the mean distance J between the end blocks with the threshold of synchrony."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.mean_distance import summarize

job.write(summarize(job.summary("runs"), **job.config))
