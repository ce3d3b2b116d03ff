"""What Snakemake does not tell a Snakefile of its command line, or would report with a traceback."""

from __future__ import annotations

import argparse
import re
from collections.abc import Sequence
from pathlib import Path

from burridge_knopoff.messages import command, format_value
from burridge_knopoff.provenance.files import display_path
from burridge_knopoff.study.yaml_file import ConfigError, read_config

#: Options with which Snakemake runs no jobs of the study.
_RUNS_NONE = re.compile(
    "--(touch|summary|detailed-summary|report(=|$)|list|rulegraph|filegraph|d3dag|dag$|lint|unlock|archive|cleanup|delete|"
    "print-compilation|containerize|export|generate|draft|edit)|-n?tn?$|-[SDl]$"
)


#: Options without a value that may share a dash, with -R as the last one: -kF, -kR agreement.
_LETTERS = re.compile(r"-([ntkfFlSDpa]*)(R.*)?(.*)", re.DOTALL)


def without_force(arguments: Sequence[str]) -> list[str]:
    """Return a command line without -f, -F and -R, which make files again that are up to date."""
    kept: list[str] = []
    is_forced_target = False
    for place, word in enumerate(arguments):
        if word == "--":
            return [*kept, *arguments[place:]]
        if re.match(r"--force\w*(=|$)", word):
            is_forced_target = word.startswith("--forcer") and "=" not in word
        elif word.startswith("--"):
            is_forced_target = False
            kept.append(word)
        elif letters := _LETTERS.fullmatch(word):
            is_forced_target = letters[2] == "R"
            rest = re.sub("[fF]", "", letters[1]) + letters[3]
            kept += [f"-{rest}"] * bool(rest)
        elif not is_forced_target:
            kept.append(word)
    return kept


def runs_jobs(arguments: Sequence[str]) -> bool:
    """Return whether a command line, except for a dry run, runs jobs, rather than printing or marking something."""
    return not any(_RUNS_NONE.match(argument) for argument in arguments)


def only_reports(arguments: Sequence[str]) -> bool:
    """Return whether a command line writes Snakemake's report on results that are there, and runs nothing."""
    options = {word.partition("=")[0] for word in arguments}
    return "--report" in options and "--report-after-run" not in options


def check_one_config(paths: Sequence[str | Path]) -> None:
    """Raise ConfigError, one line, for several config files: Snakemake reads targets that follow one as files."""
    if len(paths) > 1:
        first, second = map(display_path, paths[:2])
        raise ConfigError(
            f"--configfile: got {second} as a second file, expected one file: one file is one study; "
            f"put a target before it: {command('snakemake', second, '--configfile', first)}"
        )


def check_command_line(arguments: Sequence[str]) -> None:
    """Raise ConfigError, one line, for a config file that cannot be read and for a malformed --config.

    Snakemake creates its log handlers before it reads the config files; no other code of the project runs in between.
    """
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    parser.add_argument("--configfile", "--configfiles", nargs="*", action="extend", default=[])
    parser.add_argument("--config", "-C", nargs="*", action="extend", default=[])
    options, _ = parser.parse_known_args(arguments)
    check_one_config(options.configfile)
    for path in options.configfile:
        read_config(path)
    for entry in options.config:
        if not re.match(r"[a-zA-Z_][\w-]*\w=", entry):
            keys = "key=value; a key of one letter can only be set in the config file"
            raise ConfigError(f"--config: got {format_value(entry)}, expected {keys}")
