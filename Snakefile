# The study: config -> points -> summary -> figures. Run `snakemake -c2`; README.md tells more.
import shlex
import sys
from pathlib import Path

from snakemake.utils import min_version

min_version("9.0")

from burridge_knopoff.config import (
    ConfigError,
    all_points,
    check_file,
    load_study,
    read_schema,
)
from burridge_knopoff.files import display_path
from burridge_knopoff.friction import LAWS
from burridge_knopoff.provenance import STABILITY_SOURCES, source_fingerprint

# A config given on the command line replaces the default one; Snakemake would merge the two.
if not workflow.configfiles:

    configfile: str(Path(workflow.basedir, "config/paper.yaml"))


if len(workflow.configfiles) > 1:
    sys.exit("--configfile: several files are not allowed: one file is one study")
if " " in sys.executable:
    sys.exit(
        f"{sys.executable}: Snakemake cannot run scripts from a path with a space: move the checkout"
    )

try:
    check_file(workflow.configfiles[0])
    STUDY = load_study(
        config,
        read_schema(Path(workflow.basedir, "workflow/schemas/config.schema.yaml")),
        display_path(workflow.configfiles[0]),
    )
except ConfigError as error:
    sys.exit(f"{error}")

RESULTS = f"results/{STUDY.name}"
POINT = f"{RESULTS}/points/{{law}}/{{initial}}/a{{a}}.nc"


# Jobs find the `bk` of this environment, activated or not.
shell.prefix(
    f"export PATH={shlex.quote(str(Path(sys.executable).parent))}:$PATH; set -euo pipefail; "
)


# The least in which `make setup` works: Python, a C compiler and make. Used only if jobs are to run in containers.
container: "docker://python:3.11"


wildcard_constraints:
    law="|".join(LAWS),
    initial="|".join(STUDY.initial),
    a=r"\d+\.\d+",
    blocks=r"\d+",


include: "workflow/rules/simulate.smk"
include: "workflow/rules/summarize.smk"
include: "workflow/rules/attractors.smk"
include: "workflow/rules/basins.smk"
include: "workflow/rules/orbits.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/chains.smk"


rule all:
    default_target: True
    input:
        rules.points.input,
        rules.summary.input,
        rules.figures.input,
    message:
        f"study {STUDY.name}: all points, summaries and figures are in {RESULTS}"
