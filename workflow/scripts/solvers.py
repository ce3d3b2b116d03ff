"""Compare independent solvers of the equations of motion."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.solvers import compare_solvers

job.write(compare_solvers(job.config, job.results))
