"""The job of a script that is run by hand, on a finished study.

    python workflow/scripts/agreement.py [results/paper/summary/agreement.nc] [--out FOLDER] [--snakefile FILE]

The file is one that the script makes, by default the first one of the study that ran last. The script reads what its
job reads, and writes into a new temporary folder or into FOLDER: in the results, a new file would make everything that
depends on it out of date. Messages and errors are printed. It runs in a debugger and by `%run` in a notebook as well.

Results may come from others: the plan is that of the Snakefile of this checkout, without a profile. That of a workflow
that imports the study is named by --snakefile, and its code runs.
"""

import argparse
import os
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace

from burridge_knopoff.outputs import refusal, rule_of, study_files
from burridge_knopoff.provenance.record import CHECKOUT, NAME, SNAKEFILE, imports_study, study_folder
from burridge_knopoff.study.recorded import recorded_study
from snakemake_logger_plugin_study.dry_run import dry_run
from snakemake_logger_plugin_study.internals import requested_jobs

SCRIPT = Path(sys.modules["__main__"].__file__).resolve()


def by_hand(arguments):
    """Return what Snakemake would give to this script; raises ValueError, one line, if it makes no such file."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", type=Path)
    parser.add_argument("--out", type=Path, metavar="FOLDER")
    parser.add_argument("--snakefile", type=Path, metavar="FILE")
    options = parser.parse_args(arguments)
    results = study_folder(options.file) if options.file else last_study()
    if not results:
        raise ValueError(f"{options.file or 'results'}: no study: no {NAME} in it, which `snakemake` writes")
    record, study = recorded_study(results)
    files = {name for name, file in study_files(study).items() if script_of(file.rule) == SCRIPT.stem}
    name = options.file.absolute().relative_to(results).as_posix() if options.file else min(files, default="")
    if name not in files:
        reasons = [refusal(study, rule) for rule in [rule_of(name) or SCRIPT.stem] if script_of(rule) == SCRIPT.stem]
        raise ValueError(
            f"{name or study.name}: {SCRIPT.name} does not make it{': '.join(['', *filter(None, reasons)])}"
        )
    folder = (options.out or Path(tempfile.mkdtemp(prefix=f"{SCRIPT.stem}-"))).resolve()
    if folder.is_relative_to(results.resolve()):
        raise ValueError(f"--out: got {options.out}, expected a folder outside the results")
    root = results.parents[1]
    if imports_study(record, root) and not options.snakefile:
        raise ValueError(
            f"--snakefile: missing, expected {record['config_file']}, which imports the study: it would run"
        )
    snakefile = (options.snakefile or CHECKOUT / SNAKEFILE).resolve()
    # Snakemake names files by their paths from the folder that contains `results`.
    os.chdir(root)
    job = planned_job(f"results/{results.name}/{name}", snakefile, record["arguments"])
    print(f"{name}: written into {folder}", file=sys.stderr)
    given = {key: getattr(job, key) for key in ("input", "output", "params", "wildcards", "threads", "resources")}
    return SimpleNamespace(**given, rule=job.rule.name, log=[], folder=folder)


def script_of(rule):
    """Return the name of the script of a rule: that of the rule, or of all figures."""
    return "figure" if rule.startswith("figure_") else rule


def last_study():
    """Return the folder of the study that ran last, None if there is none here."""
    records = sorted(Path("results").absolute().glob(f"*/{NAME}"), key=lambda path: path.stat().st_mtime)
    return records[-1].parent if records else None


def planned_job(file, snakefile, words):
    """Return the job that makes a file, by Snakemake's own plan with the recorded words of a run."""
    others = words[2:] if words[:1] == ["-s"] else words
    plan, written = dry_run([file, "-s", f"{snakefile}", "--profile", "none", "--workflow-profile", "none", *others])
    # A DAG without jobs to run counts as false.
    if not plan or plan.workflow.dag is None:
        raise ValueError(written.strip())
    for job in requested_jobs(plan.workflow):
        if file in job.output:
            return job
    raise ValueError(f"{file}: no rule of {snakefile} makes it, expected the Snakefile of its run as --snakefile")


try:
    snakemake = by_hand(sys.argv[1:])
except ValueError as error:
    sys.exit(f"{SCRIPT.name}: {error}")
