"""Record the slip events of one run."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.catalogue_of_run import events_of_run

job.write(events_of_run(job.config, job.law))
