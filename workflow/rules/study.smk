# The study that the config describes, and its results folder.
import copy
import os
import shlex
import subprocess
import sys
from itertools import chain
from pathlib import Path

from snakemake.utils import update_config

from burridge_knopoff.provenance.kernel_build import KernelError, check_kernel
from snakemake_logger_plugin_study import internals

# Checked before anything imports the kernel.
try:
    check_kernel(compiled=not internals.is_dry_run(workflow))
except KernelError as error:
    sys.exit(f"{error}")

from burridge_knopoff.attractors.settings import GIVEN_STATE_KEYS
from burridge_knopoff.check.changes import changes
from burridge_knopoff.check.leftovers import check_places
from burridge_knopoff.check.study import is_locked
from burridge_knopoff.claims.paper import CLAIMS, READS
from burridge_knopoff.figures.description import figure_descriptions
from burridge_knopoff.messages import command, escape_unprintable
from burridge_knopoff.outputs import outputs, refusal, stage_of, study_files
from burridge_knopoff.provenance.files import (
    check_folder,
    display_path,
    nearest_folder,
    remove_links,
)
from burridge_knopoff.provenance.keys import select
from burridge_knopoff.provenance.record import check_owner, write_study_record
from burridge_knopoff.provenance.sources import source_fingerprint
from burridge_knopoff.running.settings import SOLVERS
from burridge_knopoff.study.chunks import incomplete_chunks
from burridge_knopoff.study.command_line import config_arguments, of_command_line
from burridge_knopoff.study.keys import (
    other_length_keys,
    parts,
    point_keys,
    run_keys,
    study_keys,
)
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.model import MODEL_KEYS
from burridge_knopoff.study.paths import VALUE
from burridge_knopoff.point_job import (
    run_point_command,
    run_point_job,
    stop_on_interrupt,
)
from burridge_knopoff.script_server import ScriptServer
from burridge_knopoff.study.remarks import (
    change_remarks,
    override_remarks,
    remarks,
)
from burridge_knopoff.study.yaml_file import ConfigError, read_config
from burridge_knopoff.summaries.parameter_names import check_parameter_names
from snakemake_logger_plugin_study import LogHandler, internals
from snakemake_logger_plugin_study.command_line import (
    check_one_config,
    only_reports,
    runs_jobs,
)
from snakemake_logger_plugin_study.plan import Plan

# Another Snakefile may import this one as a module; it is then the main Snakefile.
ROOT = Path(f"{workflow.current_basedir}").resolve().parents[1]
SNAKEFILES = [ROOT / "Snakefile", ROOT / "workflow/Snakefile"]
IMPORTED = Path(workflow.main_snakefile).resolve() not in SNAKEFILES
CONFIG_FILE = [*workflow.configfiles, workflow.main_snakefile][0]
# The file to which the results belong.
OWNER = workflow.main_snakefile if IMPORTED else CONFIG_FILE
# The linear-algebra library would start a thread for every core, and keep it busy.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
# Jobs draw into files. The backend that a notebook names may not be installed here, and matplotlib would not load.
os.environ.pop("MPLBACKEND", None)

# Results are written to the current folder. In this one Snakemake finds the second Snakefile, and would begin another
# study.
if Path.cwd() == ROOT / "workflow":
    sys.exit(f"no study is run in the folder workflow: {command('cd', ROOT)}")

try:
    # Another workflow may have several config files.
    check_one_config([] if IMPORTED else workflow.configfiles)
    # Snakemake has read --config and the file as well, but accepts values that are refused here.
    ENTRIES, READ = internals.command_line_config(workflow)
    OVERRIDES = of_command_line(ENTRIES, READ)
    if IMPORTED:
        # The workflow that imports the study passes its config on, including the values of the command line.
        WRITTEN = {
            key: OVERRIDES[key] if key in READ and READ[key] == value else value for key, value in config.items()
        }
        OVERRIDES = {}
    else:
        WRITTEN = read_config(CONFIG_FILE)
    GIVEN = copy.deepcopy(WRITTEN)
    update_config(GIVEN, OVERRIDES)
    STUDY = load_study(GIVEN, display_path(CONFIG_FILE), WRITTEN)
    check_parameter_names(STUDY, display_path(CONFIG_FILE))
    RESULTS = f"results/{STUDY.name}"
    # Snakemake would report these errors with a traceback. Results may be read-only as long as no job runs.
    check_folder(os.path.abspath(".snakemake"))
    nearest_folder(RESULTS)
    check_owner(RESULTS, OWNER, WRITTEN)
except (ValueError, OSError) as error:
    sys.exit(escape_unprintable(f"{error}"))

# The arguments of `snakemake` for this study: of its config, and with the Snakefile of another workflow or folder.
if IMPORTED:
    NAMED = [*map(os.path.relpath, internals.config_files(workflow))]
    CONFIG_ARGUMENTS = [*(["--configfile"] if NAMED else []), *NAMED, *(["--config"] if ENTRIES else []), *ENTRIES]
else:
    OTHER_CONFIG = Path(CONFIG_FILE).resolve() != ROOT / "config/paper.yaml"
    CONFIG_ARGUMENTS = config_arguments(CONFIG_FILE if OTHER_CONFIG else None, OVERRIDES)
OTHER_SNAKEFILE = workflow.main_snakefile if IMPORTED else SNAKEFILES[0]
ARGUMENTS = [
    *(["-s", os.path.relpath(OTHER_SNAKEFILE)] if IMPORTED or ROOT != Path.cwd() else []),
    *CONFIG_ARGUMENTS,
]


# Jobs use the `bk` of this environment, even if it is not activated.
shell.prefix(f"export PATH={shlex.quote(str(Path(sys.executable).parent))}:$PATH; set -euo pipefail; ")


wildcard_constraints:
    **dict.fromkeys(STUDY.wildcards, VALUE),
    law="|".join(STUDY.laws),
    initial="|".join(STUDY.initial),
