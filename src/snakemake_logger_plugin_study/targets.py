"""Why Snakemake has no job for a target, in one line, with what to write in its place."""

from __future__ import annotations

import os
from collections.abc import Collection
from difflib import get_close_matches

from burridge_knopoff.messages import suggestion
from burridge_knopoff.study.study import run_files
from snakemake_logger_plugin_study.plan import Plan


def target_error(plan: Plan) -> str:
    """Return what is wrong with a target of the command line, in one line; empty if nothing is."""
    settings = getattr(plan.workflow, "dag_settings", None)
    if not (settings and plan.files and plan.study):
        return ""
    rules = {rule.name: rule for rule in plan.workflow.rules}
    files = {*plan.files, *(f"{plan.results}/{name}" for name in run_files(plan.study))}
    for target in (*settings.targets, *settings.forcerun, *settings.until, *settings.omit_from):
        path, rule = os.path.relpath(target), rules.get(target)
        for name in (target, path, *(rule.input if rule else ())):
            if name in plan.refusals:
                return f"{target}: not made: {plan.refusals[name]}"
        if rule and rule.has_wildcards() and target in settings.targets:
            remedy = f"name a file, or the rule {plan.stages[target]}, which makes all of them"
            return f"{target}: not a target, since it has several jobs: {remedy}"
        # Snakemake takes a path for the name of a file as it is written.
        if not rule and os.path.isabs(target) and path in files:
            return f"{target}: not a target under this name; write {path}"
        if not rule and path not in files:
            return f"{target}: unknown target{_remedy(target, files, rules, plan.results)}"
    return ""


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
