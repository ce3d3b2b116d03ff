"""Prove by ball arithmetic where the synchronized orbit loses its stability."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.summaries.proof import digest, prove

proof = prove(job.config)
job.write(proof, digest(proof))
