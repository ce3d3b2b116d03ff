"""Average the distance J between the end blocks over each run."""

from burridge_knopoff.job import Job

job = Job(snakemake)

from burridge_knopoff.summaries.mean_distance import summarize

job.write(summarize(job.points, job.config["synchronization_threshold"]))
