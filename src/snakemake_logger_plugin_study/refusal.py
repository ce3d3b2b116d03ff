"""What Snakemake would answer with a traceback, in a block of lines or not at all is said in one line."""

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

from burridge_knopoff.provenance.files import check_folder, display_path
from burridge_knopoff.study.yaml_file import ConfigError, read_config
from burridge_knopoff.values import format_value

#: What Snakemake takes for the name of a key.
_NAME = re.compile(r"[a-zA-Z_][\w-]*\w")

#: Messages of Snakemake that no event and no field tells apart, and what is said instead.
_REWORDED = (
    # It comes with every few jobs.
    (re.compile(r"\ASelect jobs to execute"), ""),
    # The failed job itself is told of right after, with what its log says.
    (re.compile(r"\ARuleException:\s+CalledProcessError "), ""),
    # What a function of a rule raised: one line made for people, among the wildcards and the lines of code.
    (re.compile(r"^ *ConfigError: (.+)$", re.MULTILINE), r"\1"),
    (
        re.compile(r"^No rule to produce (.+?) \(if you", re.MULTILINE),
        r"\1: unknown target (misspelt, or part of a stage disabled by `without`)",
    ),
)


def reworded(message: str) -> str | None:
    """Return what is said instead of a message of Snakemake, "" for nothing; None if it is said as it is."""
    for pattern, words in _REWORDED:
        if found := pattern.search(message):
            return found.expand(words)
    return None


def provide_cache() -> None:
    """Give Snakemake a folder for its cache of sources, where the user's cannot be made, as without a home."""
    # Snakemake would end with a traceback. No study puts anything there, since all its sources are local.
    from snakemake.common import get_appdirs

    try:
        folder = Path(get_appdirs().user_cache_dir, "snakemake")
        folder.mkdir(parents=True, exist_ok=True)
        check_folder(folder)
    except OSError:
        os.environ["XDG_CACHE_HOME"] = tempfile.mkdtemp(prefix="snakemake-cache-")
        atexit.register(shutil.rmtree, os.environ["XDG_CACHE_HOME"], ignore_errors=True)


def is_end_by_hand(message: str) -> bool:
    """Tell whether a message of Snakemake says that Ctrl-C ends the run; no event does."""
    return message.startswith("Terminating processes on user request")


def says_nothing_to_do(message: str) -> bool:
    """Tell whether a message of Snakemake says that a run has nothing to make."""
    return message.startswith("Nothing to be done")


def several_files(paths: Sequence[str | Path]) -> str:
    """Return what is said where --configfile has more than one file: Snakemake takes targets after it for files."""
    first, second = map(display_path, paths[:2])
    return (
        f"--configfile: got {second} as a second file, expected one file: one file is one study; "
        f"a target stands before it, as in snakemake {second} --configfile {first}"
    )


def refused_call(checkout: Path, config_files: Sequence[str | Path]) -> str:
    """Return why no study is run here from a checkout by these config files, in one line; nothing if it can be."""
    # Results lie where `snakemake` is called: there it would find the second Snakefile and begin another study.
    if Path.cwd() == checkout / "workflow":
        return f"no study is run in the folder workflow: cd {shlex.quote(str(checkout))}"
    if len(config_files) > 1:
        return several_files(config_files)
    if " " in sys.executable:
        return f"{sys.executable}: Snakemake cannot run scripts from a path with a space: move the checkout"
    return ""


def refused_cluster(submit: str | None) -> str:
    """Return why no job goes to Slurm by a submit command, in one line: else each job would try for minutes."""
    program = Path(submit or "")
    if program.name != "submit.py" or not program.with_name("jobs.py").is_file():
        return ""
    answer = subprocess.run(["sh", "-c", "squeue --me --noheader"], capture_output=True, text=True)
    return f"no job is submitted, Slurm does not answer: squeue: {answer.stderr.strip()}" if answer.returncode else ""


def checked_cores(arguments: Sequence[str]) -> int:
    """Return the cores that a command line gives, 0 if it gives no number: Snakemake takes one for a dry run.

    Raises ConfigError, one line, for a config file that cannot be read and for what --config does not take: Snakemake
    makes its log handlers first and reads the config files next, and nothing of the project runs in between.
    """
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    parser.add_argument("--configfile", "--configfiles", nargs="*", action="extend", default=[])
    parser.add_argument("--config", "-C", nargs="*", action="extend", default=[])
    parser.add_argument("--cores", "-c", "--jobs", "-j", nargs="?", const="", default="")
    options, _ = parser.parse_known_args(arguments)
    if len(options.configfile) > 1:
        raise ConfigError(several_files(options.configfile))
    for path in options.configfile:
        read_config(path)
    for entry in options.config:
        name, equals, _ = entry.partition("=")
        if not (equals and _NAME.fullmatch(name)):
            short = f"; {name} has its place in the config file" if len(name) == 1 else ""
            raise ConfigError(
                f"--config: got {format_value(entry)}, expected key=value, the key of two letters or more{short}"
            )
    return int(options.cores) if options.cores.isdecimal() else 0
