"""Why Snakemake has no job for a target, in one line, with what to write in its place."""

from __future__ import annotations

import os
import shlex
from collections.abc import Iterable, Sequence
from difflib import get_close_matches
from pathlib import Path, PurePosixPath

from burridge_knopoff.messages import suggestion
from burridge_knopoff.provenance.files import display_path
from burridge_knopoff.provenance.record import read_study_record
from burridge_knopoff.study.study import run_files
from burridge_knopoff.study.yaml_file import ConfigError, read_yaml
from snakemake_logger_plugin_study.plan import PLAN
from snakemake_logger_plugin_study.private import targets

#: Largest number of values that a message lists.
MOST_VALUES = 8
_FOLDER = "it is a folder: name a file in it, or a rule, such as figures"


def unknown_target(target: str) -> str:
    """Return why a target is neither a rule nor a file of the planned study."""
    if PLAN.study is None:
        return f"{target}: unknown target"
    # Snakemake compares names of files letter by letter.
    path = os.path.relpath(target)
    if "/" in target or PurePosixPath(target).suffix or path != target or _is_above(path) or Path(path).is_dir():
        return f"{target}: unknown target: {_of_file(path)}"
    names = sorted(rule.name for rule in PLAN.workflow.rules)
    similar = suggestion(target, names) or "; snakemake --list-target-rules prints the names"
    return f"{target}: unknown target: no rule of that name{similar}"


def rule_with_wildcards() -> str | None:
    """Return why a rule of several jobs is no target, with how to make one or all of them; None without such a rule."""
    if PLAN.study is None:
        return None
    names = {rule.name for rule in PLAN.workflow.rules if rule.has_wildcards()}
    for target in names & targets(PLAN.workflow) & PLAN.rules.keys():
        rule = PLAN.rules[target]
        files = [file for file, maker in _files().items() if maker == target]
        if rule.refusal or not files:
            return f"{target}: not a target: {rule.refusal or 'this study has no such jobs'}"
        remedy = f"name a file, such as {files[0]}, or the rule {rule.stage}, which makes all of them"
        return f"{target}: not a target, since it has several jobs: {remedy}"
    return None


def _files() -> dict[str, str]:
    """Return {file of the study: its rule}, points included."""
    runs = run_files(PLAN.study) if PLAN.study else {}
    rules = {name: "simulate_solver" if "solver" in run else "simulate" for name, run in runs.items()}
    return {**PLAN.files, **{f"{PLAN.results}/{name}": rule for name, rule in rules.items()}}


def _of_file(path: str) -> str:
    """Return why a file, by its path from the current folder, is not made."""
    folder, files = PLAN.results, _files()
    if path == folder or _is_above(path) or any(file.startswith(f"{path}/") for file in files):
        return _FOLDER
    if f"{folder}/{path}" in files:
        return f"write {folder}/{path}"
    if not path.startswith(f"{folder}/"):
        return _of_other_study(path, list(files))
    if values := _values(path, files):
        return f"got {values[0]}, expected {listed(values[1:])}"
    similar = _similar(path, list(files)) or "; snakemake --list-rules says what each rule makes"
    kind = {f"{folder}/figures": "figure", f"{folder}/summary": "summary"}.get(path.rpartition("/")[0], "file")
    return f"no {kind} has that name{similar}"


def listed(values: Sequence[str]) -> str:
    """Return values as a message lists them."""
    return " | ".join([*values[:MOST_VALUES], *["…"] * (len(values) > MOST_VALUES)])


def _values(path: str, files: Iterable[str]) -> list[str]:
    """Return the one folder, or the name, in which a path differs from some files, and what these have in its place."""
    parts, different = path.split("/"), dict[int, list[str]]()
    for file in files:
        others = file.split("/")
        places = [k for k, pair in enumerate(zip(parts, others, strict=False)) if len({*pair}) > 1]
        if len(others) == len(parts) and len(places) == 1:
            different.setdefault(places[0], []).append(others[places[0]])
    place = min(different, default=-1)
    # The names in these folders are not values of one thing.
    if place < 0 or parts[place - 1] in ("summary", "figures"):
        return []
    return [parts[place], *dict.fromkeys(different[place])]


def _is_above(path: str) -> bool:
    """Return whether a folder contains the results folder of the study."""
    return PurePosixPath(path) in PurePosixPath(PLAN.results).parents


def _of_other_study(path: str, files: list[str]) -> str:
    """Return why a file outside the results of this study is not made, with the command that makes it if one does."""
    assert PLAN.study is not None
    results, name, *inside = [*PurePosixPath(path).parts, "", ""]
    arguments = _arguments(name) if results == "results" else ""
    if not inside[0] and arguments:
        return f"the folder of study {name}, and this is study {PLAN.study.name}: snakemake -c2 {arguments}"
    if results != "results" or not inside[0]:
        similar = _similar(path, files) if PurePosixPath(path).suffix else ""
        return f"this study makes files in {PLAN.results}{similar}"
    study = f"a file of study {name}, and this is study {PLAN.study.name}"
    if arguments:
        return f"{study}: snakemake -c2 {shlex.join([path])} {arguments}"
    if suggestion(name, [PLAN.study.name]):
        return f"{study}{_similar(path, files)}"
    return f"{study}: name its config file: snakemake -c2 {shlex.join([path])} --configfile FILE"


def _similar(path: str, files: list[str]) -> str:
    """Return the file of this study with the most similar name, as a question; empty if none is similar."""
    of_stem: dict[str, list[str]] = {}
    for file in files:
        of_stem.setdefault(PurePosixPath(file).stem, []).append(file)
    near = get_close_matches(PurePosixPath(path).stem, of_stem, 1)
    return f" (did you mean {get_close_matches(path, of_stem[near[0]], 1, 0.0)[0]}?)" if near else ""


def _arguments(study: str) -> str:
    """Return the arguments of snakemake for a study that has run here, or whose config lies by; empty if none does."""
    folder = Path("results", study)
    try:
        record = read_study_record(folder)
        if record["config"].get("study") == study:
            return record["arguments"] or f"--configfile {shlex.quote(record['config_file'])}"
    except ValueError:
        pass
    places = dict.fromkeys([Path(PLAN.config).parent, PLAN.checkout / "config", PLAN.checkout / "config/examples"])
    for file in [file for place in places for file in sorted(place.glob("*.yaml"))]:
        try:
            config = read_yaml(file)
        except ConfigError:
            continue
        if isinstance(config, dict) and config.get("study") == study:
            return f"--configfile {shlex.quote(display_path(file))}"
    return ""
