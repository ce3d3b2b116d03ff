"""`bk check`: compare the results of a study with its config and the current sources."""

from __future__ import annotations

import argparse

from burridge_knopoff.cli.output import print_lines

DESCRIPTION = """List the points and catalogues of studies that are missing, corrupt, outdated or failed, summaries
that are corrupt, missing files of jobs that have started, and files that do not belong to the study. Exit code 0: no
problems; 1: files are missing, corrupt or outdated; 3: runs have failed, without other problems."""

EXAMPLES = """  bk check results/paper
  bk check --paths results/*/
"""


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the folders to check, and the option for paths alone."""
    parser.add_argument("results", metavar="FOLDER", nargs="+", help="results of a study: results/<study>")
    parser.add_argument("--paths", action="store_true", help="print only the paths of the files to recreate")


def run(options: argparse.Namespace) -> int:
    """Check studies, and print the findings."""
    from burridge_knopoff.check.study import check_study

    codes = set()
    for results in options.results:
        check = check_study(results)
        print_lines(*(check.paths if options.paths else check.lines()))
        codes.add(check.exit_code)
    return 1 if 1 in codes else max(codes)
