# The study: config -> points -> summary -> figures -> report. Run `snakemake -c2`; README.md tells more.
import hashlib
import os
import shlex
import sys
import time
from pathlib import Path

from snakemake.utils import min_version

min_version("9.0")

from burridge_knopoff.claims.ledger import read_claims
from burridge_knopoff.closing import closing_lines
from burridge_knopoff.config import (
    ConfigError,
    all_points,
    check_file,
    load_study,
    read_schema,
)
from burridge_knopoff.files import (
    check_folder,
    check_folders,
    display_path,
    nearest_folder,
)
from burridge_knopoff.friction import LAWS
from burridge_knopoff.provenance import (
    CLAIM_SOURCES,
    REPORT_SOURCES,
    STABILITY_SOURCES,
    source_fingerprint,
)
from burridge_knopoff.settings import SOLVERS
from snakemake_logger_plugin_study.outcome import say_outcome
from snakemake_logger_plugin_study.plan import announce

BEGIN = time.monotonic()

# A config given on the command line replaces the default one; Snakemake would merge the two.
if not workflow.configfiles:

    configfile: str(Path(workflow.basedir, "config/paper.yaml"))


if len(workflow.configfiles) > 1:
    sys.exit("--configfile: several files are not allowed: one file is one study")
if " " in sys.executable:
    sys.exit(
        f"{sys.executable}: Snakemake cannot run scripts from a path with a space: move the checkout"
    )

CLAIMS_FILE = str(Path(workflow.basedir, "config/claims.yaml"))
CLAIMS_SCHEMA = str(Path(workflow.basedir, "workflow/schemas/claims.schema.yaml"))

try:
    read_claims(CLAIMS_FILE, CLAIMS_SCHEMA)
    check_file(workflow.configfiles[0])
    STUDY = load_study(
        config,
        read_schema(Path(workflow.basedir, "workflow/schemas/config.schema.yaml")),
        display_path(workflow.configfiles[0]),
    )
except ConfigError as error:
    sys.exit(f"{error}")

RESULTS = f"results/{STUDY.name}"

# What Snakemake itself would tell in a traceback. Results may be read-only until a job is to run.
try:
    check_folder(os.path.abspath(".snakemake"))
    nearest_folder(RESULTS)
except OSError as error:
    sys.exit(f"{error}")

POINT = f"{RESULTS}/points/{{law}}/{{initial}}/a{{a}}.nc"


# Jobs find the `bk` of this environment, activated or not.
shell.prefix(
    f"export PATH={shlex.quote(str(Path(sys.executable).parent))}:$PATH; set -euo pipefail; "
)


# The least in which `make setup` works: Python, a C compiler and make. Used only if jobs are to run in containers.
container: "docker://python:3.11"


# What `snakemake --report` says on its first page.
report: "workflow/report/workflow.rst"


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
include: "workflow/rules/equilibrium.smk"
include: "workflow/rules/solvers.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/two_blocks.smk"
include: "workflow/rules/chains.smk"
include: "workflow/rules/claims.smk"
include: "workflow/rules/report.smk"


rule all:
    default_target: True
    input:
        rules.points.input,
        rules.summary.input,
        rules.figures.input,
        rules.report.output,
    message:
        f"study {STUDY.name}: all points, summaries, figures and the report are in {RESULTS}"


onstart:
    try:
        check_folders(RESULTS)
    except OSError as error:
        sys.exit(f"{error}")
    announce(workflow)


onsuccess:
    say_outcome(
        workflow,
        closing_lines,
        results=RESULTS,
        seconds=time.monotonic() - BEGIN,
        success=True,
    )


onerror:
    say_outcome(
        workflow,
        closing_lines,
        results=RESULTS,
        seconds=time.monotonic() - BEGIN,
        success=False,
    )
