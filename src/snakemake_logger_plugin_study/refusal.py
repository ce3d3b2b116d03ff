"""One-line errors where Snakemake would print a traceback, a block of lines or nothing."""

from __future__ import annotations

import argparse
import atexit
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from burridge_knopoff.messages import format_value
from burridge_knopoff.provenance.files import check_folder, display_path
from burridge_knopoff.study.yaml_file import ConfigError, read_config
from snakemake_logger_plugin_study.targets import rule_with_wildcards, unknown_target

#: The names of keys that Snakemake accepts.
_NAME = re.compile(r"[a-zA-Z_][\w-]*\w")

#: Options with which Snakemake runs no jobs of the study.
_RUNS_NONE = re.compile(
    "--(touch|summary|detailed-summary|report(=|$)|list|rulegraph|filegraph|d3dag|dag$|lint|unlock|archive|cleanup|delete|"
    "print-compilation|containerize|export|generate|draft|edit)|-n?tn?$|-[SDl]$"
)
#: Messages of Snakemake without an event or a field that identifies them, and the text that replaces them.
_REPLACEMENTS = (
    # Written with every few jobs.
    (re.compile(r"\ASelect jobs to execute"), ""),
    # The closing lines have the time of the run, without that of planning it.
    (re.compile(r"\AElapsed time: "), ""),
    # A dry run ends with a table of its stages instead.
    (
        re.compile(r"\A(Reasons:\n|This was a dry-run |Some jobs were triggered by provenance |Rules with provenance)"),
        "",
    ),
    # Written by --touch for each job; the closing lines count these files.
    (re.compile(r"\AOutput files? not touched because "), ""),
    # The failed job is reported right after, with the reason from its log.
    (re.compile(r"\ARuleException:\s+CalledProcessError "), ""),
    # Written by --report for each file that is not made; the error that follows names one of them.
    (re.compile(r"\AMissing metadata for file (?P<missing>.+?)\. Maybe metadata was deleted"), ""),
    (
        re.compile(r"^File (.+) marked for report but does not exist\.", re.MULTILINE),
        r"--report: \1 is missing: run the study first, by the same command without --report",
    ),
    (
        re.compile(r"\A(\d+) jobs have (?:missing|outdated) provenance/metadata so that .*", re.DOTALL),
        r"\1 jobs: .snakemake has no record of how their results were made; only `bk check` finds those out of date",
    ),
    # The error that a function of a rule raised, one line among the wildcards and the lines of code.
    (re.compile(r"^ *ConfigError: (.+)$", re.MULTILINE), r"\1"),
)
_UNKNOWN = re.compile(r"^No rule to produce (.+?) \(if you", re.MULTILINE)
_WILDCARDS = re.compile(r"^Target rules may not contain wildcards", re.MULTILINE)


def replacement(message: str) -> str | None:
    """Return the text that replaces a message of Snakemake, empty to hide it; None to keep the message."""
    for pattern, text in _REPLACEMENTS:
        hit = pattern.search(message)
        if hit and not Path(hit.groupdict().get("missing", "")).is_file():
            return hit.expand(text)
    if match := _UNKNOWN.search(message):
        return unknown_target(match[1])
    return rule_with_wildcards() if _WILDCARDS.search(message) else None


def provide_cache() -> None:
    """Give Snakemake a temporary folder for its cache of sources if the user's cannot be created, as without a home."""
    # Otherwise Snakemake ends with a traceback. The folder stays empty, since all sources of a study are local.
    from snakemake.common import get_appdirs

    try:
        folder = Path(get_appdirs().user_cache_dir, "snakemake")
        folder.mkdir(parents=True, exist_ok=True)
        check_folder(folder)
    except OSError:
        os.environ["XDG_CACHE_HOME"] = tempfile.mkdtemp(prefix="snakemake-cache-")
        atexit.register(shutil.rmtree, os.environ["XDG_CACHE_HOME"], ignore_errors=True)


def is_ctrl_c(message: str) -> bool:
    """Return whether a message of Snakemake says that Ctrl-C ends the run; there is no such event."""
    return message.startswith("Terminating processes on user request")


def is_nothing_to_do(message: str) -> bool:
    """Return whether a message of Snakemake says that there is nothing to do."""
    return message.startswith("Nothing to be done")


def is_touch(arguments: Sequence[str]) -> bool:
    """Return whether a command line has --touch, which Snakemake forgets in a dry run."""
    return any(re.fullmatch("--touch|-n?tn?", argument) for argument in arguments)


def runs_jobs(arguments: Sequence[str]) -> bool:
    """Return whether a command line, except for a dry run, runs jobs, rather than printing or marking something."""
    return not any(_RUNS_NONE.match(argument) for argument in arguments)


def _several_files_error(paths: Sequence[str | Path]) -> str:
    """Return the error if --configfile has several files: Snakemake reads targets that follow it as files."""
    first, second = map(display_path, paths[:2])
    return (
        f"--configfile: got {second} as a second file, expected one file: one file is one study; "
        f"put a target before it: snakemake {second} --configfile {first}"
    )


def call_error(checkout: Path, config_files: Sequence[str | Path]) -> str:
    """Return why a checkout cannot run these config files in the current folder, in one line; empty if it can."""
    # Results are written to the folder in which `snakemake` is called. In `workflow` it would find the second Snakefile
    # and begin another study.
    if Path.cwd() == checkout / "workflow":
        return f"no study is run in the folder workflow: cd {shlex.quote(str(checkout))}"
    if len(config_files) > 1:
        return _several_files_error(config_files)
    if " " in sys.executable:
        return f"{sys.executable}: Snakemake cannot run scripts from a path with a space: move the checkout"
    return ""


def cluster_error(submit: str | None) -> str:
    """Return why a submit command cannot reach Slurm, in one line; otherwise each job would try for minutes."""
    program = Path(submit or "")
    if program.name != "submit.py" or not program.with_name("jobs.py").is_file():
        return ""
    answer = subprocess.run(["sh", "-c", "squeue --me --noheader"], capture_output=True, text=True)
    return f"no job is submitted, Slurm does not answer: squeue: {answer.stderr.strip()}" if answer.returncode else ""


def cores_of_command_line(arguments: Sequence[str]) -> int:
    """Return the number of cores of a command line, 0 without a number: Snakemake uses one core for a dry run.

    Raises ConfigError, one line, for a config file that cannot be read and for a malformed --config: Snakemake creates
    its log handlers before it reads the config files, and no other code of the project runs in between.
    """
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    parser.add_argument("--configfile", "--configfiles", nargs="*", action="extend", default=[])
    parser.add_argument("--config", "-C", nargs="*", action="extend", default=[])
    parser.add_argument("--cores", "-c", "--jobs", "-j", nargs="?", const="", default="")
    options, _ = parser.parse_known_args(arguments)
    if len(options.configfile) > 1:
        raise ConfigError(_several_files_error(options.configfile))
    for path in options.configfile:
        read_config(path)
    for entry in options.config:
        name, equals, _ = entry.partition("=")
        if not (equals and _NAME.fullmatch(name)):
            if equals and len(name) == 1:
                reason = "cannot be set here (Snakemake requires keys of two letters); set it in the config file"
                raise ConfigError(f"--config: {name} {reason}")
            raise ConfigError(f"--config: got {format_value(entry)}, expected key=value")
    return int(options.cores) if options.cores.isdecimal() else 0
