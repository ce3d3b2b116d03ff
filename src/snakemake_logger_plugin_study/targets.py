"""Why Snakemake has no job for a target, in one line, with what to write in its place."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterator
from difflib import get_close_matches
from pathlib import Path, PurePosixPath

from burridge_knopoff.jobs.jobs import Jobs, files_of
from burridge_knopoff.jobs.rule import Rule
from burridge_knopoff.messages import suggestion
from burridge_knopoff.provenance.files import display_path
from burridge_knopoff.provenance.record import read_study_record
from burridge_knopoff.study.yaml_file import ConfigError, read_yaml
from snakemake_logger_plugin_study.plan import PLAN

#: Largest number of values that a message lists.
MOST_VALUES = 8
_FOLDER = "it is a folder: name a file in it, or a rule, such as figures"


def unknown_target(target: str) -> str:
    """Return why a target is neither a rule nor a file of the planned study."""
    if PLAN.jobs is None:
        return f"{target}: unknown target"
    # Snakemake compares names of files letter by letter.
    path = os.path.relpath(target)
    is_file = "/" in target or PurePosixPath(target).suffix or path != target or _is_above(path) or Path(path).is_dir()
    reason = _of_file(PLAN.jobs, path) if is_file else _of_rule(PLAN.jobs, target)
    return f"{target}: {'not made' if reason in PLAN.jobs.absence.values() else 'unknown target'}: {reason}"


def rule_with_wildcards() -> str | None:
    """Return why a rule of several jobs is no target, with how to make one or all of them; None without such a rule."""
    if PLAN.jobs is None:
        return None
    names = {rule.name for rule in PLAN.workflow.rules if rule.has_wildcards()}
    for target in names.intersection(PLAN.workflow.dag_settings.targets):
        for name, rule in PLAN.jobs.defined.items():
            # A workflow that imports the study puts a prefix before the names of its rules.
            if f"_{target}".endswith(f"_{name}") and rule.each[0]:
                if name in PLAN.jobs.absence:
                    return f"{target}: not a target: {PLAN.jobs.absence[name]}"
                return (
                    f"{target}: not a target, since its jobs differ in {', '.join(rule.each[0])}: name a file, such as "
                    f"{PLAN.results}/{files_of(rule)[0]}, or the stage {rule.stage}, which makes all of them"
                )
    return None


def _of_rule(jobs: Jobs, target: str) -> str:
    """Return why there is no rule, or no stage, of a name."""
    for rule in jobs.rules.values():
        if target in (rule.name, rule.stage) and rule.name in jobs.absence:
            return jobs.absence[rule.name]
    names = sorted(rule.name for rule in PLAN.workflow.rules)
    return f"no rule of that name{suggestion(target, names) or '; snakemake --list-target-rules prints the names'}"


def _of_file(jobs: Jobs, path: str) -> str:
    """Return why a file, by its path from the current folder, is not made."""
    folder, name = PLAN.results, path.removeprefix(f"{PLAN.results}/")
    if path == folder or _is_above(path):
        return _FOLDER
    files = [*jobs.all_files, *(file for rule in jobs.runs() for file in files_of(rule))]
    if name in files:
        return f"write {folder}/{name}"
    if name == path:
        return _of_other_study(jobs, path, files)
    if any(file.startswith(f"{name}/") for file in files):
        return _FOLDER
    rules = [(rule, match) for rule, form in _forms(jobs) if (match := re.fullmatch(jobs.pattern(form), name))]
    for rule, _ in rules:
        if rule.name not in jobs.existing:
            return jobs.absence[rule.name]
    for rule, match in rules:
        for key, value in match.groupdict().items():
            values = list(dict.fromkeys(job[key] for job in rule.each))
            if value not in values:
                shown = " | ".join([*values[:MOST_VALUES], *["…"] * (len(values) > MOST_VALUES)])
                return f"{key}: got {value}, expected {shown}"
    if rules:
        return "this study has no job of these values"
    kind = {"figures": "figure", "summary": "summary"}.get(name.partition("/")[0], "file")
    return f"no {kind} has that name{_similar(path, files) or '; snakemake --list-rules says what each rule makes'}"


def _is_above(path: str) -> bool:
    """Return whether a folder contains the results folder of the study."""
    return PurePosixPath(path) in PurePosixPath(PLAN.results).parents


def _forms(jobs: Jobs) -> Iterator[tuple[Rule, str]]:
    """Yield each rule with the forms of its files, the most specific first: those without wildcards."""
    pairs = [(rule, form) for rule in jobs.rules.values() for form in rule.files]
    yield from sorted(pairs, key=lambda pair: "{" in pair[1])


def _of_other_study(jobs: Jobs, path: str, files: list[str]) -> str:
    """Return why a file outside the results of this study is not made, with the command that makes it if one does."""
    results, name, *inside = [*PurePosixPath(path).parts, "", ""]
    arguments = _arguments(name) if results == "results" else ""
    if not inside[0] and arguments:
        return f"the folder of study {name}, and this is study {jobs.study.name}: snakemake -c2 {arguments}"
    if results != "results" or not inside[0]:
        similar = _similar(path, files) if PurePosixPath(path).suffix else ""
        return f"this study makes files in {PLAN.results}{similar}"
    study = f"a file of study {name}, and this is study {jobs.study.name}"
    if arguments:
        return f"{study}: snakemake -c2 {shlex.join([path])} {arguments}"
    if suggestion(name, [jobs.study.name]):
        return f"{study}{_similar(path, files)}"
    return f"{study}: name its config file: snakemake -c2 {shlex.join([path])} --configfile FILE"


def _similar(path: str, files: list[str]) -> str:
    """Return the file of this study with the most similar name, as a question; empty if none is similar."""
    of_stem: dict[str, list[str]] = {}
    for file in files:
        of_stem.setdefault(PurePosixPath(file).stem, []).append(f"{PLAN.results}/{file}")
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
