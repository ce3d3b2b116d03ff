"""`bk prune`: delete results that no longer belong to a study."""

from __future__ import annotations

import argparse
from pathlib import Path

DESCRIPTION = """Delete and list files of laws, initial states, values of a and stages that are no longer in the config
of the last run, with their logs and benchmarks. Files with other names are kept."""

EXAMPLES = """  bk prune --dry-run results/paper
  bk prune results/paper
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of a deletion."""
    parser.add_argument("results", metavar="FOLDER", nargs="+", help="results of a study: results/<study>")
    parser.add_argument("-n", "--dry-run", action="store_true", help="only list what would be deleted")


def run(options: argparse.Namespace) -> int:
    """Delete leftover files, and print how many."""
    from burridge_knopoff.check.leftovers import delete, leftovers
    from burridge_knopoff.check.study import config_change
    from burridge_knopoff.jobs.jobs import Jobs
    from burridge_knopoff.study.formatting import format_count
    from burridge_knopoff.study.recorded import recorded_study

    studies = []
    for folder in map(Path, options.results):
        record, study = recorded_study(folder)
        if (found := config_change(folder, record)) and found.kind == "stale":
            raise ValueError(f"{folder}: {record['config_file']} has changed since the last run: run snakemake first")
        studies.append((folder, study))
    for folder, study in studies:
        left = leftovers(folder, Jobs(study))
        for path in left:
            print(path)
        if not options.dry_run:
            delete(folder, left)
        print(f"{folder}: {format_count(len(left), 'file')} {'would be ' * options.dry_run}deleted")
    return 0
