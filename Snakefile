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
include: "workflow/rules/common.smk"
include: "workflow/rules/points.smk"
include: "workflow/rules/summaries.smk"
include: "workflow/rules/attractors.smk"
include: "workflow/rules/basins.smk"
include: "workflow/rules/bifurcations.smk"
include: "workflow/rules/phases.smk"
include: "workflow/rules/solvers.smk"
include: "workflow/rules/proof.smk"
include: "workflow/rules/two_blocks.smk"
include: "workflow/rules/catalogue.smk"
include: "workflow/rules/chains.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/claims.smk"
include: "workflow/rules/collect.smk"
include: "workflow/rules/report.smk"


rule all:
    """Compute the whole study: all points, summaries and figures, and the report."""
    default_target: True
    input:
        rules.points.input,
        rules.summary.input,
        rules.figures.input,
        rules.report.output,
    message:
        f"study {STUDY.name}: all points, summaries, figures and the report are in {RESULTS}"


include: "workflow/rules/start.smk"
