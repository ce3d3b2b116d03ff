"""The record of the last run of a study, in its folder of results: the config and the command to repeat the run."""

from __future__ import annotations

import contextlib
import json
import os
import re
import shlex
import subprocess
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any

from burridge_knopoff.messages import command, escape_unprintable
from burridge_knopoff.provenance.files import display_path, read_regular, write_text
from burridge_knopoff.provenance.sources import PACKAGE, SOFTWARE

NAME = "study.json"
#: The checkout of the package, and files in it, which an installed package lacks.
CHECKOUT, SNAKEFILE, PROFILE = PACKAGE.parents[1], "Snakefile", "profiles/default"
#: Stands in a command for the Snakefile of another workflow: only who names it runs its code.
OTHER_SNAKEFILE = "SNAKEFILE"

#: {key of a record: its type}
_TYPES = {
    **dict.fromkeys(("software", "git_commit", "arguments", "config_file"), str),
    **dict.fromkeys(("given", "config", "grid"), dict),
}
_ENTRY = re.compile(r"[a-zA-Z_][\w-]*=.*", re.ASCII | re.DOTALL)


@cache
def git_commit() -> str:
    """Return the commit checked out around the package, or "unknown" outside a checkout.

    It ends with "-dirty" if files differ from that commit.
    """
    checkout = PACKAGE.parent.parent
    # The checkout may be owned by another user.
    command = ["git", "-c", "safe.directory=*", "describe", "--always", "--abbrev=40", "--exclude=*", "--dirty"]
    with contextlib.suppress(OSError, subprocess.CalledProcessError):
        if (checkout / ".git").exists():
            return subprocess.run(command, cwd=checkout, capture_output=True, text=True, check=True).stdout.strip()
    return "unknown"


def write_study_record(
    results: str | Path,
    config: Mapping[str, Any],
    grid: Mapping[str, Mapping[str, float]],
    config_file: str | Path,
    given: dict[str, Any],
    arguments: str,
) -> None:
    """Record a study in its folder of results; a record with the same content is left untouched.

    config, grid : the config with all defaults, and {parameter: {name in file names: value}}
    config_file, given : the config file and its content
    arguments : arguments of `snakemake` except its targets, quoted for a shell: `--configfile config/mine.yaml`
    Raises OSError, one line, if the folder cannot be written to.
    """
    path = Path(results, NAME)
    values = (SOFTWARE, git_commit(), arguments, display_path(config_file), given, config, grid)
    text = json.dumps(dict(zip(_TYPES, values, strict=True)), indent=1, ensure_ascii=False) + "\n"
    if not (path.is_file() and path.read_bytes() == text.encode()):
        write_text(path, text)


def read_study_record(results: str | Path) -> dict[str, Any]:
    """Return the record of a folder of results.

    software, git_commit : of the last run
    arguments : words for the command line of `snakemake`, see `write_study_record`
    config_file : as it was recorded
    given, config : the content of the config file, and the config with all defaults
    grid : {parameter: {name in file names: value}}

    Raises ValueError, one line, if there is no record, or if it has arguments that no run records.
    """
    path = Path(results, NAME)
    try:
        record = json.loads(read_regular(path))
    except OSError as error:
        folder = escape_unprintable(str(results))
        if path.exists():
            raise ValueError(f"{folder}: {NAME} cannot be read: {error.strerror}") from None
        reason = f"not the results of a study: no {NAME} in it, which `snakemake` writes"
        raise ValueError(f"{folder}: {reason if Path(results).exists() else 'this folder does not exist'}") from None
    except (ValueError, RecursionError):
        record = None
    # Records of earlier versions have more keys.
    if not isinstance(record, dict) or {key: type(record.get(key)) for key in _TYPES} != _TYPES:
        raise _invalid(path)
    arguments = _recorded_words(record["arguments"], Path(results))
    if arguments is None:
        raise _invalid(path)
    return {**record, "arguments": arguments}


def _invalid(path: Path) -> ValueError:
    return ValueError(f"{escape_unprintable(str(path))}: not a valid record; run snakemake again to rewrite it")


def _recorded_words(arguments: str, results: Path) -> list[str] | None:
    """Return the words of recorded arguments; None if they are others than a run of these results has."""
    try:
        words = shlex.split(arguments)
    except ValueError:
        return None
    named, left = dict[str, list[str]](), words
    for option in ("-s", "--configfile"):
        if left[:1] == [option]:
            named[option], left = left[1:2], left[2:]
    if not all(path and not path[0].startswith("-") for path in named.values()):
        return None
    if left and not (left[0] == "--config" and all(map(_ENTRY.fullmatch, left[1:]))):
        return None
    # A Snakefile that came with the results would run code of whoever sent them.
    whole = results.resolve()
    snakefile = [Path(results.absolute().parents[1], path).resolve() for path in named.get("-s", [])]
    return None if any(path.is_relative_to(whole) for path in snakefile) else words


def study_folder(path: str | Path) -> Path | None:
    """Return the folder of results that contains a file, or None."""
    return next((folder for folder in Path(path).absolute().parents if (folder / NAME).is_file()), None)


def check_owner(results: str | Path, config_file: str | Path, given: dict[str, Any]) -> None:
    """Refuse a folder of results that belongs to another config file with another content.

    A config keeps its folder when it is edited, and when it is moved or copied unchanged.

    given : content of the config file
    Raises ValueError, one line, with the differences and the remedy.
    """
    try:
        record = read_study_record(results)
    except ValueError:
        return
    owner, owner_keys = record["config_file"], record["given"]
    if Path(owner).resolve() == Path(config_file).resolve() or owner_keys == given:
        return
    differs = ", ".join(key for key in {**owner_keys, **given} if owner_keys.get(key) != given.get(key))
    raise ValueError(
        escape_unprintable(
            f"{display_path(config_file)}: study: got {Path(results).name!r}, expected another name: {results} has the "
            f"results of {owner}, which differs ({differs}); to continue there with this config, remove "
            f"{Path(results, NAME)}"
        )
    )


def imports_study(record: Mapping[str, Any], root: Path) -> bool:
    """Return whether another workflow imports a recorded study, whose Snakefile is on record as its config file.

    root : the folder from which `snakemake` was called
    """
    words: list[str] = record["arguments"]
    option, snakefile, *_ = [*words, "", ""]
    return option == "-s" and (root / snakefile).resolve() == (root / record["config_file"]).resolve()


def checkout_words(words: Sequence[str], root: Path) -> list[str]:
    """Return recorded words with the Snakefile and the profile of this checkout.

    Results may come from others: neither a Snakefile that they name nor a profile beside them is to run.

    root : the folder in which `snakemake` is called
    """
    option, recorded, *others = [*words, "", ""]
    is_named = option == "-s"
    others = [word for word in (others if is_named else words) if word]
    if root.resolve() == CHECKOUT and not is_named:
        return others
    snakefile, profile = (Path(os.path.relpath(CHECKOUT / name, root.resolve())) for name in (SNAKEFILE, PROFILE))
    snakefiles = (CHECKOUT / SNAKEFILE, CHECKOUT / "workflow" / SNAKEFILE)
    is_own = snakefiles[0].is_file() and (not is_named or (root / recorded).resolve() in snakefiles)
    own_words = ["-s", str(snakefile), "--workflow-profile", str(profile)]
    return [*(own_words if is_own else ["-s", OTHER_SNAKEFILE, "--workflow-profile", "none"]), *others]


def remake_command(
    study_file: str | Path, *paths: str | Path, listed: Sequence[str] = (), is_own_run: bool = False
) -> str:
    """Return the command that recreates files and everything that depends on them, from any folder.

    study_file : a file in the results of their study
    paths : the files, if other than that one
    listed : if there are too many paths, the words of a command that prints them relative to the folder where
        `snakemake` runs
    is_own_run : whether this process runs the study, by its recorded words; else see `checkout_words`
    """
    place, words, named = "", list[str](), [str(path) for path in paths or [study_file]]
    if folder := study_folder(study_file):
        # Snakemake identifies files by their paths from the folder where it was called for results/<study>.
        root = folder.parents[1]
        named = [os.path.relpath(name, root) for name in named]
        place = "" if root.resolve() == Path.cwd() else f"{command('cd', root)} && "
        with contextlib.suppress(ValueError):
            recorded = read_study_record(folder)["arguments"]
            words = recorded if is_own_run else checkout_words(recorded, root)
    start = place + command("snakemake", "-c2", *words, "-R")
    return f"{start} {f'$({command(*listed)})' if listed else command(*named)}"
