"""Why Snakemake has no job for a target, in one line, with what to write in its place."""

from __future__ import annotations

import os
from collections.abc import Collection
from difflib import get_close_matches

from burridge_knopoff.messages import suggestion
from burridge_knopoff.outputs import outputs, refusal, rule_of, study_files
from burridge_knopoff.study.study import run_files
from snakemake_logger_plugin_study.internals import named_targets
from snakemake_logger_plugin_study.plan import Plan


def target_error(plan: Plan) -> str:
    """Return what is wrong with a target of the command line, in one line; empty if nothing is."""
    targets, named = named_targets(plan.workflow)
    if not named or plan.is_imported:
        return ""
    rules = {rule.name: rule for rule in plan.workflow.rules}
    files = {f"{plan.results}/{name}" for name in (*study_files(plan.study), *run_files(plan.study))}
    for target in named:
        path, rule = os.path.relpath(target), rules.get(target)
        for name in (target, path, *(rule.input if rule else ())):
            if name not in files and (reason := _refusal(plan, name)):
                return f"{target}: not made: {reason}"
        if rule and rule.has_wildcards() and target in targets:
            remedy = f"name a file, or the rule {outputs()[target].stage}, which makes all of them"
            return f"{target}: not a target, since it has several jobs: {remedy}"
        # Snakemake takes a path for the name of a file as it is written.
        if not rule and os.path.isabs(target) and path in files:
            return f"{target}: not a target under this name; write {path}"
        if not rule and path not in files:
            return f"{target}: unknown target{_remedy(target, files, rules, plan.results)}"
    return ""


def _refusal(plan: Plan, name: str) -> str:
    """Return why the study does not have a rule or a file; empty if it has, or if the name is of neither."""
    rule = name if name in outputs() else rule_of(f"{name}".removeprefix(f"{plan.results}/"))
    return refusal(plan.study, rule) if rule else ""


def _remedy(target: str, files: set[str], rules: Collection[str], results: str) -> str:
    """Return what may be meant by a target that is neither a rule nor a file of the study."""
    if not (os.sep in target or os.path.splitext(target)[1]):
        return suggestion(target, rules) or "; snakemake --list-rules describes the rules"
    path = os.path.relpath(target)
    # Of names that are equally close, the one with the same beginning is meant.
    near = max(
        get_close_matches(path, files, 5),
        key=lambda file: len(os.path.commonprefix([file, path])),  # noqa: RUF071
        default="",
    )
    other = (
        ""
        if path.startswith(f"{results}/")
        else f"; this study makes files in {results}, another one needs its --configfile"
    )
    return (f" (did you mean {near}?)" if near else "") + other
