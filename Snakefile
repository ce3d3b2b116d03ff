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
include: "workflow/rules/seals.smk"
include: "workflow/rules/simulate.smk"


# Optional stages, with all files that they make.
for stage in ("attractors", "basins", "bifurcations", "phases", "solvers", "proof"):
    if stage not in STUDY.left_out:

        include: f"workflow/rules/{stage}.smk"


if "catalogue" in STUDY.stages:

    include: "workflow/rules/catalogue.smk"


if not STUDY.is_plane:

    include: "workflow/rules/two_blocks.smk"


include: "workflow/rules/summaries.smk"
include: "workflow/rules/figures.smk"


if not STUDY.is_plane:

    include: "workflow/rules/chains.smk"


if "claims" in STUDY.stages:

    include: "workflow/rules/claims.smk"


include: "workflow/rules/report.smk"


rule all:
    """Make the whole study: all points, summaries and figures, and the report."""
    default_target: True
    input:
        rules.points.input,
        rules.summary.input,
        rules.figures.input,
        rules.report.output,
    message:
        f"study {STUDY.name}: all points, summaries, figures and the report are in {RESULTS}"


onstart:
    prepare_results()
