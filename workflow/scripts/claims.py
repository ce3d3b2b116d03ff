"""Judge every claim of the paper."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.claims.ledger import verdicts

names = [path.stem for path in job.paths("summaries")]
summaries = dict(zip(names, job.summaries("summaries"), strict=True))
job.write(*verdicts(job.config, summaries, job.params.figures))
