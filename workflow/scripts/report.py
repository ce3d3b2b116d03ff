"""Write the report of the study."""

from burridge_knopoff.job import Job

if "snakemake" not in globals():
    from by_hand import snakemake
job = Job(snakemake)

from burridge_knopoff.report.page import Sources, render

study = job.study
sources = Sources(
    claims=next(iter(job.paths("claims")), None),
    summaries={path.stem: path for path in job.paths("summaries")},
    figures={path.stem: path for path in job.paths("figures")},
    benchmarks=job.results / "benchmarks",
    results=None if study.is_plane else job.results,
)
job.write(render(study, sources, job.params.arguments))
