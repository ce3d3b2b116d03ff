# The study: config -> points -> summaries -> figures -> report. `snakemake -c2` here runs it, see README.md.
from snakemake.utils import min_version

min_version("9.22")


# A config given on the command line replaces the default one; Snakemake would merge the two.
if not workflow.configfiles:

    configfile: f"{workflow.current_basedir}/config/paper.yaml"


# First page of `snakemake --report`.
report: "workflow/report/workflow.rst"


# A minimal image in which `make setup` works: Python, a C++ compiler and make. Only used to run jobs in containers.
container: "docker://python:3.11"


include: "workflow/rules/study.smk"
include: "workflow/rules/groups.smk"
include: "workflow/rules/simulate.smk"
include: "workflow/rules/common.smk"
include: "workflow/rules/jobs.smk"


rule all:
    """Compute the whole study: all points, summaries and figures, and the report."""
    default_target: True
    input:
        rules.points.input,
        paths(JOBS.files()),
    message:
        f"study {STUDY.name}: all points, summaries, figures and the report are in {RESULTS}"


onstart:
    prepare_results()


onsuccess:
    write_sums(
        Path(RESULTS), [*(name for name, *_ in run_files(JOBS)), *JOBS.all_files]
    )
