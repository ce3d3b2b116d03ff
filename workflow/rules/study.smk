# The study that the config describes, and its results folder.
import copy
import os
import re
import shlex
import sys
from pathlib import Path

from snakemake.utils import update_config

from burridge_knopoff.provenance.kernel_build import KernelError, check_kernel

# Checked before anything imports the kernel. A dry run needs none.
try:
    check_kernel(compiled=not workflow.output_settings.dryrun)
except KernelError as error:
    sys.exit(f"{error}")

from burridge_knopoff.check.leftovers import run_files
from burridge_knopoff.check.study import is_locked
from burridge_knopoff.claims.claim import read_claims
from burridge_knopoff.figures.description import picture_names
from burridge_knopoff.jobs.checked import damaged_files
from burridge_knopoff.jobs.jobs import Jobs, files_of
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.provenance.bad_file import CHANGED
from burridge_knopoff.provenance.files import (
    check_folder,
    display_path,
    nearest_folder,
)
from burridge_knopoff.provenance.record import check_owner, write_study_record
from burridge_knopoff.provenance.keys import digest_of
from burridge_knopoff.provenance.sources import source_fingerprint
from burridge_knopoff.provenance.sums import write_sums
from burridge_knopoff.running.settings import SOLVERS
from burridge_knopoff.study.command_line import config_arguments, of_command_line
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.paths import VALUE
from burridge_knopoff.study.remarks import remarks
from burridge_knopoff.study.yaml_file import ConfigError, read_config
from snakemake_logger_plugin_study.plan import PLAN
from snakemake_logger_plugin_study.refusal import (
    call_error,
    cluster_error,
    runs_jobs,
)
from snakemake_logger_plugin_study.remarks import (
    changed_params,
    kept_stages,
    points_of_grid,
    replaced_results,
)

# Another Snakefile may import this one as a module; it is then the main Snakefile.
ROOT = Path(f"{workflow.current_basedir}").resolve().parents[1]
SNAKEFILES = [ROOT / "Snakefile", ROOT / "workflow/Snakefile"]
IMPORTED = Path(workflow.main_snakefile).resolve() not in SNAKEFILES
CONFIG_FILE = [*workflow.configfiles, workflow.main_snakefile][0]
# A job has one thread; the linear-algebra library would start one for every core, and keep it busy.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# Jobs draw into files. The backend that a notebook names may not be installed here, and matplotlib would not load.
os.environ.pop("MPLBACKEND", None)

if error := call_error(ROOT, workflow.configfiles):
    sys.exit(error)

try:
    # Snakemake has read --config and the file as well, but accepts values that are refused here.
    READ = workflow.config_settings.config
    OVERRIDES = of_command_line(workflow.config_settings.config_args, READ)
    if IMPORTED:
        # The workflow that imports the study passes its config on, including the values of the command line.
        WRITTEN = {
            key: OVERRIDES[key] if key in READ and READ[key] == value else value
            for key, value in config.items()
        }
        OVERRIDES = {}
    else:
        WRITTEN = read_config(CONFIG_FILE)
    GIVEN = copy.deepcopy(WRITTEN)
    update_config(GIVEN, OVERRIDES)
    STUDY = load_study(GIVEN, display_path(CONFIG_FILE), WRITTEN)
    RESULTS = f"results/{STUDY.name}"
    read_claims(picture_names({*PAPER_STATES, *STUDY.initial}))
    JOBS = Jobs(STUDY)
    # Snakemake would report these errors with a traceback. Results may be read-only as long as no job runs.
    check_folder(os.path.abspath(".snakemake"))
    nearest_folder(RESULTS)
    check_owner(RESULTS, CONFIG_FILE, WRITTEN)
except (ValueError, OSError) as error:
    sys.exit(f"{error}")

# Cores of a long job, shared among its processes. The jobs of all laws run at the same time, each with at least two
# cores, since with one core each they would not end together. Without jobs, as with --unlock, the number may be missing.
SHARED_CORES = max(2, (workflow.resource_settings.cores or 1) // len(STUDY.laws))

# The arguments of `snakemake` for this study: of its config, and with the Snakefile from another folder.
OTHER_CONFIG = (
    not IMPORTED and Path(CONFIG_FILE).resolve() != ROOT / "config/paper.yaml"
)
CONFIG_ARGUMENTS = config_arguments(CONFIG_FILE if OTHER_CONFIG else None, OVERRIDES)
OTHER_SNAKEFILE = workflow.main_snakefile if IMPORTED else SNAKEFILES[0]
ARGUMENTS = [
    *(["-s", os.path.relpath(OTHER_SNAKEFILE)] if ROOT != Path.cwd() else []),
    *CONFIG_ARGUMENTS,
]


def record_study():
    """Record the study and its command in the results folder."""
    write_study_record(
        RESULTS,
        STUDY.config,
        STUDY.parameters,
        CONFIG_FILE,
        WRITTEN,
        shlex.join(ARGUMENTS),
    )


PLAN.results, PLAN.workflow, PLAN.jobs = RESULTS, workflow, JOBS
PLAN.config, PLAN.checkout = f"{CONFIG_FILE}", ROOT
PLAN.record = record_study


# Jobs use the `bk` of this environment, even if it is not activated.
shell.prefix(
    f"export PATH={shlex.quote(str(Path(sys.executable).parent))}:$PATH; set -euo pipefail; "
)


wildcard_constraints:
    **dict.fromkeys(STUDY.wildcards, VALUE),
    law="|".join(STUDY.laws),
    initial="|".join(STUDY.initial),


def write_line(text):
    """Write a line to standard error, in one piece: Snakemake writes to it from another thread."""
    sys.stderr.write(f"{text}\n")


def print_remarks():
    """Print what users may not expect of this study, a line each."""
    for remark in (
        *remarks(STUDY, GIVEN),
        *points_of_grid(JOBS),
        *kept_stages(JOBS),
        *changed_params(JOBS, RESULTS),
        *replaced_results(JOBS, RESULTS, display_path(CONFIG_FILE), OVERRIDES),
    ):
        write_line(remark)


def prepare_results():
    """Check that the results folder is writable, record the study in it, and plan the run."""
    if error := cluster_error(getattr(workflow.executor_settings, "submit_cmd", None)):
        sys.exit(error)
    # Identifies the results of the jobs to the programs that submit them.
    made_from = [source_fingerprint(*rule.sources) for rule in JOBS.existing.values()]
    decides = digest_of(STUDY.config, made_from)
    os.environ.update(BK_STUDY=f"{RESULTS} {decides}")
    print_remarks()
    try:
        check_folder(RESULTS, inside=True)
        record_study()
    except OSError as error:
        sys.exit(f"{error}")
    # Snakemake would check all ready jobs again one second after each check, which takes a fifth of a core after
    # hundreds of jobs (its issue 3804). Programs that submit jobs need the pause.
    if not workflow.non_local_exec:
        workflow.scheduler.job_rate_limiter = None
    PLAN.announce()


def set_damaged_aside(makes_files):
    """Set damaged texts and pictures aside, so that Snakemake finds them missing; say so if this run makes no files."""
    for path, reason in damaged_files(JOBS, Path(RESULTS)):
        words = "would be made again"
        # Someone may have edited it on purpose. Otherwise it is empty, or its job was killed.
        if makes_files and reason == CHANGED:
            path.replace(f"{path}.damaged")
            words = f"is made again; kept as {path.name}.damaged"
        elif makes_files:
            path.unlink()
            words = "is made again"
        write_line(f"{path}: {reason}: it {words}")


# Snakemake has no hook before it decides which jobs to run. Only in the main process, not in jobs, and not while another
# run writes these files.
if workflow.is_main_process:
    if not is_locked(Path(RESULTS)):
        set_damaged_aside(
            runs_jobs(sys.argv[1:]) and not workflow.output_settings.dryrun
        )
    # A dry run calls no hook.
    if workflow.output_settings.dryrun:
        print_remarks()


def paths(names):
    """Return the paths of files of the study."""
    return [f"{RESULTS}/{name}" for name in names]


def output_paths(*rules):
    """Return the paths of the files that all jobs of some rules make."""
    return [path for rule in rules for path in paths(files_of(rule))]


def snakemake_message(text):
    """Return a message with the wildcards as Snakemake writes them."""
    return re.sub(r"\{(\w+)\}", r"{wildcards.\1}", text)
