"""The jobs of a study: its rules, their files, and the keys of the config on which these depend."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import chain, product
from typing import Any

from burridge_knopoff.jobs import shown, stages
from burridge_knopoff.jobs.rule import Rule, Wildcards
from burridge_knopoff.provenance.keys import select
from burridge_knopoff.study.paths import VALUE
from burridge_knopoff.study.stages import STAGES
from burridge_knopoff.study.study import Study

#: Patterns of wildcards in the names of files; all parameters of the grid have that of a.
PATTERNS = {
    "law": r"[a-z]\w*",
    "initial": r"[A-Za-z]\w*",
    "a": VALUE,
    "values": rf"[A-Za-z]\w*?{VALUE}(?:_[A-Za-z]\w*?{VALUE})*",
    "solver": r"\w+",
    "chunk": r"\d+",
    "tile": r"(?:0|[1-9]\d*)",
    "blocks": r"[1-9]\d*",
}


def files_of(rule: Rule) -> list[str]:
    """Return the files of all jobs of a rule."""
    return [form.format(**job) for job in rule.each for form in rule.files]


class Jobs:
    """The jobs of a study.

    rules : all rules by name, in the order of a study, including those that this study does not have
    existing : those that this study has
    defined : those, and rules whose files may be requested by name, which is refused with a reason
    absence : {rule that the study does not have: the reason, with the key of the config that decides}
    """

    def __init__(self, study: Study) -> None:
        self.study = study
        self.rules: dict[str, Rule] = {}
        self.existing: dict[str, Rule] = {}
        self.defined: dict[str, Rule] = {}
        self.absence: dict[str, str] = {}
        self._made_by: dict[str, Rule] = {}
        for declared in (*stages.STAGES, shown.summaries, shown.figures):
            self._add(declared(study))
        pictures = [name.removeprefix("figures/").removesuffix(".png") for name in self.files("figures/", ".png")]
        self._add(shown.claims(study, sorted(pictures)))
        self._add(shown.report(study, [form for rule in self.requested() for form in rule.files]))

    def _add(self, rules: Sequence[Rule]) -> None:
        """Add rules, after those whose files they read; raises ValueError, one line, if no rule makes such a file."""
        for declared in rules:
            inputs = declared.inputs
            for form in (form for forms in inputs.values() for form in forms):
                if not any(form in rule.files for rule in self.rules.values()):
                    raise ValueError(f"rule {declared.name}: reads {form}, which no rule declared before it makes")
            reads = {name: [form for form in forms if form in self._made_by] for name, forms in inputs.items()}
            makers = [self._made_by[form] for forms in reads.values() for form in forms]
            obstacle = self._obstacle(declared)
            rule = replace(
                declared,
                reads=reads,
                exists=not obstacle and declared.exists and bool(declared.each),
                requested=declared.requested and all(maker.requested for maker in makers),
            )
            self.rules[rule.name] = rule
            if rule.exists:
                self.existing[rule.name] = rule
                self._made_by.update(dict.fromkeys(rule.files, rule))
            else:
                self.absence[rule.name] = obstacle or rule.refusal or "this study has no such jobs"
            if rule.exists or (not obstacle and rule.refusal and rule.each):
                self.defined[rule.name] = rule

    def _obstacle(self, declared: Rule) -> str:
        """Return why studies such as this one have no jobs of a rule; empty if the rule itself decides."""
        study, stage = self.study, declared.stage
        if declared.over == "several" and not study.is_plane:
            return "only a study of several parameters has it: `grid: {a: …, v: …}` in place of `a: …`"
        if declared.over == "a" and study.is_plane:
            return "a study of several parameters has none: `a: …` in place of `grid: …`"
        if stage in study.omitted_stages:
            without = study.config["without"]
            left_out = " and ".join(name for name in (stage, STAGES[stage]) if name in without)
            needs = f", which needs {STAGES[stage]}" if STAGES[stage] in without else ""
            return f"part of stage {stage}{needs}: remove {left_out} from `without: [{', '.join(without)}]`"
        for form in () if declared.optional_reads else chain.from_iterable(declared.inputs.values()):
            if form not in self._made_by:
                maker = next(rule for rule in self.rules.values() if form in rule.files)
                return self.absence[maker.name]
        return ""

    def requested(self) -> list[Rule]:
        """Return the rules of the files that the target `all` makes, except runs."""
        return [rule for rule in self.existing.values() if rule.requested and rule.make]

    def runs(self) -> list[Rule]:
        """Return the rules of the point files, whose wildcards are arguments of `Study.command`."""
        return [self.existing[name] for name in ("simulate", "simulate_solver") if name in self.existing]

    def stage_of(self, name: str) -> str:
        """Return the stage of a rule, by its name, to which a workflow that imports this one may add a prefix."""
        known = [own for own in self.rules if f"_{name}".endswith(f"_{own}")]
        return self.rules[max(known, key=len)].stage if known else name

    def files(self, start: str = "", end: str = "") -> list[str]:
        """Return the files that the target `all` makes, except runs, whose names start and end with these texts."""
        return [
            name
            for rule in self.requested()
            for name in files_of(rule)
            if name.startswith(start) and name.endswith(end)
        ]

    def paper_figures(self) -> list[Rule]:
        """Return the rules of the figures of the paper."""
        return [rule for rule in self.requested() if rule.stage == "figures" and rule.priority]

    @cached_property
    def all_files(self) -> dict[str, tuple[Rule, Wildcards]]:
        """{name: its job} of all files of the study except runs, including those that are made only by name."""
        return {
            form.format(**job): (rule, job)
            for rule in self.existing.values()
            if rule.make
            for job in rule.each
            for form in rule.files
        }

    def inputs(self, rule: Rule, job: Wildcards) -> dict[str, list[str]]:
        """Return {name: files of other rules} that a job reads, except points."""
        return {
            name: [form.format(**other) for form in forms for _, other in self._sources_of(form, job)]
            for name, forms in rule.inputs.items()
        }

    def _sources_of(self, form: str, job: Wildcards) -> Iterator[tuple[Rule, Wildcards]]:
        """Yield the jobs that make the files of a form that a job reads: those with equal common wildcards."""
        rule = self._made_by[form]
        for other in rule.each:
            if all(other[name] == value for name, value in job.items() if name in other):
                yield rule, other

    def point_files(self, rule: Rule, job: Wildcards) -> list[str]:
        """Return the points that a job reads, or the marks of their chunks if several parameters vary."""
        if rule.points is None:
            return []
        if "chunk" in self.existing:
            return files_of(self.existing["chunk"])
        points = rule.points(job)
        names = ("law", "initial", *points["parameters"])
        found = product(points["laws"], points["initial"], *points["parameters"].values())
        return [self.rules["simulate"].files[0].format(**dict(zip(names, one, strict=True))) for one in found]

    def config(self, rule: Rule, job: Wildcards) -> dict[str, Any]:
        """Return {key: value} of exactly those keys of the config on which the files of a job depend.

        Raises ConfigError, one line, for a value of a that is not on the grid.
        """
        if "a" in job:
            self.study.value(job["a"])
        return select(self.study.config, self.study.parameters, rule.keys(job))

    def command(self, name: str) -> str:
        """Return the `bk simulate` command of the run in a point file, by its name; empty for any other file."""
        for rule in self.runs():
            found = re.fullmatch(self.pattern(rule.files[0]), name)
            if found and (job := found.groupdict()) in list(rule.each):
                return self.study.command(**job)
        return ""

    def pattern(self, form: str) -> str:
        """Return a regular expression for the names of files, with a group for each wildcard."""
        literal, *parts = re.split(r"\{(\w+)\}", form)
        known = {**PATTERNS, **dict.fromkeys(self.study.wildcards, VALUE)}
        groups = (f"(?P<{name}>{known.get(name, PATTERNS['solver'])})" for name in parts[::2])
        return re.escape(literal) + "".join(
            group + re.escape(text) for group, text in zip(groups, parts[1::2], strict=True)
        )
