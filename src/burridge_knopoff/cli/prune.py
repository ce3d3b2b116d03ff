"""`bk prune`: delete results that no longer belong to a study."""

from __future__ import annotations

import argparse
from pathlib import Path

from burridge_knopoff.cli.output import print_lines

DESCRIPTION = """Delete and list files of laws, initial states, values of a and stages that are no longer in the config
of the last run, with their logs and benchmarks, and files that only earlier versions wrote. Files of other names are
kept. Nothing is deleted if a point is missing or a file is outdated, since the record of the last run may then be that
of another study."""

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
    from burridge_knopoff.check.study import check_record
    from burridge_knopoff.study.formatting import format_count
    from burridge_knopoff.study.recorded import recorded_study

    folders = list(map(Path, options.results))
    for folder in folders:
        check_record(folder)
    for folder in folders:
        left = leftovers(folder, recorded_study(folder)[1])
        for path in left:
            print_lines(str(path))
        if not options.dry_run:
            delete(folder, left)
        print_lines(f"{folder}: {format_count(len(left), 'file')} {'would be ' * options.dry_run}deleted")
    return 0
