"""Compare the motion of two blocks under each friction law with that under the first."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.two_blocks import compare_two_blocks

job.write(compare_two_blocks(job.config, job.cores))
