# The study: config -> points -> summary -> figures -> report. Run `snakemake -c2`; README.md tells more.
import hashlib
import os
import shlex
import sys
import time
from dataclasses import asdict
from pathlib import Path

from snakemake.utils import min_version, update_config

min_version("9.0")

from burridge_knopoff.provenance.kernel_build import KernelError, check_kernel

# Before anything imports the kernel. What is to run can be seen without one.
try:
    check_kernel(compiled=not workflow.output_settings.dryrun)
except KernelError as error:
    sys.exit(f"{error}")

from burridge_knopoff.claims.ledger import read_claims
from snakemake_logger_plugin_study.closing import closing_lines
from burridge_knopoff.study import (
    ConfigError,
    all_points,
    load_study,
    read_config,
    read_yaml,
)
from burridge_knopoff.provenance.files import (
    check_folder,
    check_folders,
    display_path,
    nearest_folder,
)
from burridge_knopoff.running.settings import SOLVERS
from burridge_knopoff.provenance.sources import source_fingerprint
from burridge_knopoff.provenance.record import write_study_record
from snakemake_logger_plugin_study.command_line import SEVERAL_FILES
from snakemake_logger_plugin_study.outcome import say_outcome
from snakemake_logger_plugin_study.plan import announce

SNAKEFILE = Path(workflow.main_snakefile).resolve()
# One job is one thread; the linear-algebra library would start, and keep busy, one for every core.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

BEGIN = time.monotonic()

# A config given on the command line replaces the default one; Snakemake would merge the two.
DEFAULT_CONFIG = Path(workflow.basedir, "config/paper.yaml")
if not workflow.configfiles:

    configfile: str(DEFAULT_CONFIG)


if len(workflow.configfiles) > 1:
    sys.exit(SEVERAL_FILES)
if " " in sys.executable:
    sys.exit(
        f"{sys.executable}: Snakemake cannot run scripts from a path with a space: move the checkout"
    )

CLAIMS_FILE = Path(workflow.basedir, "config/claims.yaml")

try:
    read_claims(CLAIMS_FILE)
    CLAIMS = read_yaml(CLAIMS_FILE)
    # Snakemake has read the file too, but takes some of what is refused here; what --config changes comes from it.
    STUDY_CONFIG = read_config(workflow.configfiles[0])
    update_config(STUDY_CONFIG, workflow.config_settings.config)
    STUDY = load_study(STUDY_CONFIG, display_path(workflow.configfiles[0]))
except ConfigError as error:
    sys.exit(f"{error}")

# How the study is named to `snakemake`: its config file, empty for the default one, and all arguments.
CONFIG_FILE = os.path.relpath(workflow.configfiles[0])
if Path(CONFIG_FILE).resolve() == DEFAULT_CONFIG.resolve():
    CONFIG_FILE = ""
ARGUMENTS = [
    *(
        ["-s", os.path.relpath(SNAKEFILE)]
        if SNAKEFILE != Path("Snakefile").resolve()
        else []
    ),
    *(["--configfile", CONFIG_FILE] if CONFIG_FILE else []),
    *(["--config"] if workflow.config_settings.config else []),
    *(f"{key}={value}" for key, value in workflow.config_settings.config.items()),
]

RESULTS = f"results/{STUDY.name}"

# What Snakemake itself would tell in a traceback. Results may be read-only until a job is to run.
try:
    check_folder(os.path.abspath(".snakemake"))
    nearest_folder(RESULTS)
except OSError as error:
    sys.exit(f"{error}")

POINT = f"{RESULTS}/points/{{law}}/{{initial}}/a{{a}}.nc"

# Programs that submit jobs tell the studies of a folder apart by it.
os.environ.update(BK_RESULTS=RESULTS)


# Jobs find the `bk` of this environment, activated or not.
shell.prefix(
    f"export PATH={shlex.quote(str(Path(sys.executable).parent))}:$PATH; set -euo pipefail; "
)


# The least in which `make setup` works: Python, a C compiler and make. Used only if jobs are to run in containers.
container: "docker://python:3.11"


# What `snakemake --report` says on its first page.
report: "workflow/report/workflow.rst"


wildcard_constraints:
    law="|".join(STUDY.laws),
    initial="|".join(STUDY.initial),
    a=r"\d+\.\d+",


include: "workflow/rules/common.smk"
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
        write_study_record(
            RESULTS,
            STUDY,
            workflow.configfiles[0],
            read_yaml(workflow.configfiles[0]),
            shlex.join(ARGUMENTS),
        )
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
