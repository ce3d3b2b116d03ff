# The study that the config describes, and where its results lie.
import copy
import json
import os
import re
import shlex
import sys
from pathlib import Path

from snakemake.utils import update_config

from burridge_knopoff.provenance.kernel_build import KernelError, check_kernel

# Before anything imports the kernel. A dry run needs no kernel.
try:
    check_kernel(compiled=not workflow.output_settings.dryrun)
except KernelError as error:
    sys.exit(f"{error}")

from burridge_knopoff.claims.claim import read_claims
from burridge_knopoff.figures.description import picture_names
from burridge_knopoff.jobs.checked import damaged_files
from burridge_knopoff.jobs.jobs import Jobs, files_of
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.provenance.files import (
    check_folder,
    display_path,
    nearest_folder,
)
from burridge_knopoff.provenance.record import check_owner, write_study_record
from burridge_knopoff.provenance.seal import canonical_json, identity
from burridge_knopoff.provenance.sources import source_fingerprint
from burridge_knopoff.running.settings import SOLVERS
from burridge_knopoff.study.command_line import config_arguments, of_command_line
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.paths import VALUE
from burridge_knopoff.study.study import remarks
from burridge_knopoff.study.yaml_file import ConfigError, read_config
from snakemake_logger_plugin_study.plan import PLAN
from snakemake_logger_plugin_study.refusal import refused_call, refused_cluster

# Another Snakefile may import this one as a module; Snakemake then calls the other one the main Snakefile.
ROOT = Path(f"{workflow.current_basedir}").resolve().parents[1]
SNAKEFILES = [ROOT / "Snakefile", ROOT / "workflow/Snakefile"]
IMPORTED = Path(workflow.main_snakefile).resolve() not in SNAKEFILES
CONFIG_FILE = [*workflow.configfiles, workflow.main_snakefile][0]
# One job is one thread; the linear-algebra library would start, and keep busy, one for every core.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# Jobs draw into files. A notebook names a backend that need not be installed here; matplotlib would not load.
os.environ.pop("MPLBACKEND", None)

if refusal := refused_call(ROOT, workflow.configfiles):
    sys.exit(refusal)

try:
    # What imports the study hands its config over, with all that was given on the command line.
    OVERRIDES = {} if IMPORTED else of_command_line(workflow.config_settings.config)
    # Snakemake has read the file too, but takes some of what is refused here; what --config changes comes from it.
    WRITTEN = config if IMPORTED else read_config(CONFIG_FILE)
    GIVEN = copy.deepcopy(WRITTEN)
    update_config(GIVEN, OVERRIDES)
    STUDY = load_study(GIVEN, display_path(CONFIG_FILE), WRITTEN)
    RESULTS = f"results/{STUDY.name}"
    JOBS = Jobs(STUDY)
    read_claims(picture_names({*PAPER_STATES, *STUDY.initial}))
    # Snakemake itself would report this with a traceback. Results may be read-only until a job has to run.
    check_folder(os.path.abspath(".snakemake"))
    nearest_folder(RESULTS)
    check_owner(RESULTS, CONFIG_FILE, WRITTEN)
except (ValueError, OSError) as error:
    sys.exit(f"{error}")

# Cores of a long job, shared among its processes. The jobs of all laws run side by side, each with at least two cores,
# since with one core each they would not end together. Without jobs, as for --unlock, the number may be missing.
SHARED_CORES = max(2, (workflow.resource_settings.cores or 1) // len(STUDY.laws))

# How the study is named to `snakemake`, by its config alone and from another folder.
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
    """Record in the folder of results what the study is, if there are any or some are to be made."""
    arguments = shlex.join(ARGUMENTS)
    told = CONFIG_FILE, WRITTEN, arguments
    write_study_record(RESULTS, STUDY.config, STUDY.parameters, *told)


PLAN.results, PLAN.workflow, PLAN.jobs = RESULTS, workflow, JOBS
PLAN.record = record_study


# Jobs use the `bk` of this environment, whether activated or not.
shell.prefix(
    f"export PATH={shlex.quote(str(Path(sys.executable).parent))}:$PATH; set -euo pipefail; "
)


wildcard_constraints:
    **dict.fromkeys(STUDY.wildcards, VALUE),
    law="|".join(STUDY.laws),
    initial="|".join(STUDY.initial),


def prepare_results():
    """Refuse a folder of results that cannot be written to, record the study in it, and announce the jobs."""
    if refusal := refused_cluster(
        getattr(workflow.executor_settings, "submit_cmd", None)
    ):
        sys.exit(refusal)
    # Programs that submit jobs tell by it what their jobs would make, and from what.
    made_from = [source_fingerprint(*rule.sources) for rule in JOBS.existing.values()]
    decides = identity(json.dumps([STUDY.config, made_from]))
    os.environ.update(BK_STUDY=f"{RESULTS} {decides}")
    try:
        check_folder(RESULTS, inside=True)
        record_study()
    except OSError as error:
        sys.exit(f"{error}")
    for remark in remarks(STUDY, GIVEN):
        print(remark, file=sys.stderr)
    # Snakemake would check all ready jobs again one second after each check, which takes a fifth of a core after
    # hundreds of jobs (its issue 3804). Programs that submit jobs need the pause.
    if not workflow.non_local_exec:
        workflow.scheduler.job_rate_limiter = None
    PLAN.announce()


def remove_damaged():
    """Remove files that are damaged and that no job would read before they are kept; the run makes them again."""
    dry = workflow.output_settings.dryrun
    for path, reason in damaged_files(JOBS, Path(RESULTS)):
        print(
            f"{path}: {reason}: it {'would be' if dry else 'is'} made again",
            file=sys.stderr,
        )
        if not dry:
            path.unlink()


# Only in the main process, not in jobs.
if workflow.is_main_process:
    remove_damaged()


def paths(names):
    """Return the paths of files of the study."""
    return [f"{RESULTS}/{name}" for name in names]


def made(*rules):
    """Return the paths of the files that all jobs of some rules make."""
    return [path for rule in rules for path in paths(files_of(rule))]


def filled(words):
    """Return words with wildcards as Snakemake fills them in."""
    return re.sub(r"\{(\w+)\}", r"{wildcards.\1}", words)
