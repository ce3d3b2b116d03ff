# The study that the config describes, where its results lie, and what rules of several stages use.
import copy
import json
import os
import shlex
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

from snakemake.utils import update_config

from burridge_knopoff.provenance.kernel_build import KernelError, check_kernel

# Before anything imports the kernel. What is to run can be seen without one.
try:
    check_kernel(compiled=not workflow.output_settings.dryrun)
except KernelError as error:
    sys.exit(f"{error}")

from burridge_knopoff.claims.claim import checked_claims
from burridge_knopoff.figures.description import picture_names
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.proof.scope import LARGEST_V, NONLINEAR_V
from burridge_knopoff.provenance.files import (
    check_folder,
    display_path,
    nearest_folder,
)
from burridge_knopoff.provenance.record import check_owner, write_study_record
from burridge_knopoff.provenance.seal import identity
from burridge_knopoff.provenance.sources import source_fingerprint
from burridge_knopoff.study.model import MODEL_KEYS
from burridge_knopoff.study.paths import POINT
from burridge_knopoff.study.study import all_points, load_study
from burridge_knopoff.study.command_line import config_entries, of_command_line
from burridge_knopoff.study.yaml_file import ConfigError, read_config, read_yaml
from snakemake_logger_plugin_study.plan import PLAN
from snakemake_logger_plugin_study.refusal import several_files

# Another Snakefile may import this one as a module; then it is the other that Snakemake calls the main one.
ROOT = Path(f"{workflow.current_basedir}").resolve().parents[1]
SNAKEFILES = [ROOT / "Snakefile", ROOT / "workflow/Snakefile"]
IMPORTED = Path(workflow.main_snakefile).resolve() not in SNAKEFILES
# Results lie where `snakemake` is called: there it would find the second of them and begin another study.
if Path.cwd() == ROOT / "workflow":
    sys.exit(f"no study is run in the folder workflow: cd {shlex.quote(str(ROOT))}")
# One job is one thread; the linear-algebra library would start, and keep busy, one for every core.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# Return large freed blocks to the operating system: glibc would keep up to 64 MB, once as much has been freed.
os.environ.setdefault("MALLOC_MMAP_THRESHOLD_", str(2**20))
os.environ.setdefault("MALLOC_TRIM_THRESHOLD_", str(4 * 2**20))

if len(workflow.configfiles) > 1:
    sys.exit(several_files(workflow.configfiles))
if " " in sys.executable:
    sys.exit(
        f"{sys.executable}: Snakemake cannot run scripts from a path with a space: move the checkout"
    )
CONFIG_FILE = [*workflow.configfiles, workflow.main_snakefile][0]
# What imports the study hands its config over, with all that was given on the command line.
OVERRIDES = {} if IMPORTED else of_command_line(workflow.config_settings.config)

try:
    # Snakemake has read the file too, but takes some of what is refused here; what --config changes comes from it.
    WRITTEN = config if IMPORTED else read_config(CONFIG_FILE)
    GIVEN = copy.deepcopy(WRITTEN)
    update_config(GIVEN, OVERRIDES)
    STUDY = load_study(GIVEN, display_path(CONFIG_FILE), WRITTEN)
    RESULTS = f"results/{STUDY.name}"
    CLAIMS_FILE = ROOT / "config/claims.yaml"
    CLAIMS = read_yaml(CLAIMS_FILE)
    checked_claims(CLAIMS, CLAIMS_FILE, picture_names({*PAPER_STATES, *STUDY.initial}))
    # What Snakemake itself would tell in a traceback. Results may be read-only until a job is to run.
    check_folder(os.path.abspath(".snakemake"))
    nearest_folder(RESULTS)
    check_owner(RESULTS, CONFIG_FILE, WRITTEN)
except (ValueError, OSError) as error:
    sys.exit(f"{error}")

SUMMARY, FIGURES = f"{RESULTS}/summary", f"{RESULTS}/figures"

# Cores for a long job, which shares them out among processes: those of all laws run side by side, but each has two at
# least, since on one core each they would not end together. Where no job is to run, as for --unlock, there need be no number of cores.
SHARED_CORES = max(2, (workflow.resource_settings.cores or 1) // len(STUDY.laws))

# How the study is named to `snakemake`, by its config alone and from another folder.
CONFIG_ARGUMENTS = []
if not IMPORTED and Path(CONFIG_FILE).resolve() != ROOT / "config/paper.yaml":
    CONFIG_ARGUMENTS += ["--configfile", os.path.relpath(CONFIG_FILE)]
if OVERRIDES:
    CONFIG_ARGUMENTS += ["--config", *config_entries(OVERRIDES)]
ARGUMENTS = [*CONFIG_ARGUMENTS]
if ROOT != Path.cwd():
    snakefile = workflow.main_snakefile if IMPORTED else SNAKEFILES[0]
    ARGUMENTS[:0] = ["-s", os.path.relpath(snakefile)]


def record_study():
    """Record in the folder of results what the study is, if there are any or some are to be made."""
    write_study_record(
        RESULTS,
        STUDY.config,
        STUDY.grid,
        CONFIG_FILE,
        WRITTEN,
        shlex.join(ARGUMENTS),
        recorded_seals(),
    )


PLAN.results, PLAN.workflow, PLAN.study = RESULTS, workflow, STUDY
PLAN.record = record_study


# Jobs find the `bk` of this environment, activated or not.
shell.prefix(
    f"export PATH={shlex.quote(str(Path(sys.executable).parent))}:$PATH; set -euo pipefail; "
)


wildcard_constraints:
    law="|".join(STUDY.laws),
    initial="|".join(STUDY.initial),
    a=r"\d+\.\d+",


def prepare_results():
    """Refuse a folder of results that cannot be written to, record the study in it, and announce the jobs."""
    check_cluster()
    # Programs that submit jobs tell by it what their jobs would make, and from what.
    decides = [
        STUDY.config,
        CLAIMS,
        [rule.params.get("sources") for rule in workflow.rules if rule.output],
    ]
    os.environ.update(BK_STUDY=f"{RESULTS} {identity(json.dumps(decides))}")
    try:
        check_folder(RESULTS, inside=True)
        record_study()
    except OSError as error:
        sys.exit(f"{error}")
    if STUDY.blocks == 1:
        print(
            "one block: J = 0; no basins, phases or synchronized orbit, which need two end blocks",
            file=sys.stderr,
        )
    elif (
        "basins" not in STUDY.left_out and not STUDY.basin_maps and GIVEN.get("basins")
    ):
        print(
            "basins: no map: give basins.a; none of its usual values is in the grid",
            file=sys.stderr,
        )
    # Snakemake would look at all jobs that are ready a second after each look as well, so often after hundreds of jobs that
    # it takes a fifth of a core (its issue 3804). Programs that submit jobs are to be asked less often.
    if not workflow.non_local_exec:
        workflow.scheduler.job_rate_limiter = None
    PLAN.announce()


def check_cluster():
    """End a run whose jobs go to a Slurm that does not answer, before each of them tries for minutes."""
    submit = Path(getattr(workflow.executor_settings, "submit_cmd", None) or "")
    if submit.name == "submit.py" and submit.with_name("jobs.py").is_file():
        asked = ["sh", "-c", "squeue --me --noheader"]
        answer = subprocess.run(asked, capture_output=True, text=True)
        if answer.returncode:
            sys.exit(
                f"no job is submitted, Slurm does not answer: squeue: {answer.stderr.strip()}"
            )


def sources(script, *modules):
    """Return the fingerprint of a script, of modules that it picks by name, and of all that they import."""
    return source_fingerprint(
        ROOT / f"workflow/scripts/{script}.py",
        *(f"burridge_knopoff.{module}" for module in modules),
    )


def keys(*names):
    """Return these keys of the config: a rule has those that it uses among its params, and no others."""
    return {name: STUDY.config[name] for name in names}


def basin_keys(*unused):
    """Return the keys of the section that a job uses, without what has a name of its own or changes no map."""
    others = {"a", "initial", "threads", *unused}
    section = STUDY.config["basins"]
    return {key: value for key, value in section.items() if key not in others}


def group(name):
    """Return the name of a group of jobs if the profile has it among `group-components`, else None."""
    return lambda wildcards: (
        name if name in workflow.group_settings.group_components else None
    )


def fixed_group(name, points):
    """Return what gives the jobs of a rule their groups, by wildcards; none unless `group-components` has a size.

    Snakemake would put jobs together at random. These groups are always the same, so that a run finds those of an
    earlier one that was killed.
    """
    numbers = {frozenset(point.items()): number for number, point in enumerate(points)}

    def group_of(wildcards):
        # Known only when jobs are planned.
        size = workflow.group_settings.group_components.get(name, 1)
        number = numbers.get(frozenset(wildcards.items()))
        if size == 1 or number is None:
            return None
        group = f"{name}{number // size}"
        # Snakemake unites jobs that need nothing of each other up to the size of the parent group. Nothing documented
        # says which jobs: a group named by wildcards cannot cut the grid into pieces. tests/workflow/test_groups.py
        # holds it.
        workflow.parent_groupids[group] = name
        return group

    return group_of


def model_config(laws=STUDY.laws):
    """Return what decides the models of a study under some of its laws; see `study.model.model_of`."""
    config = keys(*MODEL_KEYS)
    return {**config, "laws": {law: config["laws"][law] for law in laws}}


def other_length_config(laws=STUDY.laws):
    """Return the same for chains of other lengths; raises ConfigError if the study has one length only."""
    key = STUDY.single_length_key
    if key:
        raise ConfigError(
            f"chain.{key}: got {STUDY.config['chain'][key]}, expected one number for chains of another length"
        )
    return model_config(laws)


def proved_config():
    """Return what decides the models of the proof; raises ConfigError if the proof covers no model of the study."""
    if not STUDY.proved_laws:
        raise ConfigError(
            f"study {STUDY.name}: nothing to prove: the proof is of the paper's chain of 3 blocks and its two laws "
            f"(linearized: any v, at most {LARGEST_V:g} under a symmetric contact; nonlinear: v = {NONLINEAR_V:g})"
        )
    return model_config(STUDY.proved_laws)


def motion_config():
    """Return how kinds of motion are told."""
    return {
        **STUDY.config["motion"],
        **keys("synchronization_threshold", "section"),
    }


def cache_folder(what, *decides):
    """Return where a long job keeps what it finds, for a run with other values of a, or after a kill.

    decides : all that decides it but the values of a
    """
    return f".snakemake/study_cache/{STUDY.name}/{what}/{identity(json.dumps(decides))}"


def pictures(figures):
    """Return the files of some figures."""
    return [
        expand(
            f"{FIGURES}/{figure.file}.{{format}}",
            initial=STUDY.initial,
            format=("pdf", "png"),
        )
        for figure in figures
    ]
