"""Compare the motion of two blocks under each friction law with that under the first."""

from burridge_knopoff.job import Job

job = Job(snakemake)

from burridge_knopoff.summaries.two_blocks import compare_laws

job.write(compare_laws(job.config, job.cores))
