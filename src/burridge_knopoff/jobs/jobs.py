"""The jobs of a study: its rules, the files that follow from them, and what these must be made from."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import product
from typing import Any

from burridge_knopoff.dataset.point_identity import point_identity
from burridge_knopoff.jobs import shown, stages
from burridge_knopoff.jobs.rule import Rule, Wildcards
from burridge_knopoff.provenance.seal import digest_of
from burridge_knopoff.provenance.sources import source_fingerprint
from burridge_knopoff.study.paths import VALUE
from burridge_knopoff.study.study import Study

#: Patterns of wildcards in the names of files; parameters of the grid have that of a.
PATTERNS = {
    "law": r"[a-z]\w*",
    "initial": r"[A-Za-z]\w*",
    "a": VALUE,
    "values": rf"[A-Za-z]\w*?{VALUE}(?:_[A-Za-z]\w*?{VALUE})*",
    "solver": r"\w+",
    "stretch": r"\d+",
    "tile": r"(?:0|[1-9]\d*)",
    "blocks": r"[1-9]\d*",
}


def made(rule: Rule) -> list[str]:
    """Return the files of all jobs of a rule."""
    return [form.format(**job) for job in rule.each for form in rule.files]


class Jobs:
    """The jobs of a study.

    rules : all rules by name, in the order of a study; also those that this study does not have
    there : those that it has
    defined : those, and others whose files may be asked for by name, which is refused with a reason
    """

    def __init__(self, study: Study) -> None:
        self.study = study
        self.rules: dict[str, Rule] = {}
        self.there: dict[str, Rule] = {}
        self.defined: dict[str, Rule] = {}
        self._made_by: dict[str, Rule] = {}
        self._abouts: dict[str, dict[str, Any]] = {}
        for declared in (*stages.STAGES, shown.summaries, shown.figures):
            self._add(declared(study))
        pictures = [name.removeprefix("figures/").removesuffix(".png") for name in self.files("figures/", ".png")]
        self._add(shown.claims(study, sorted(pictures)))
        self._add(shown.report(study, [form for rule in self.asked() for form in rule.files]))

    def _add(self, rules: Sequence[Rule]) -> None:
        """Take rules, after those whose files they read; raises ValueError, one line, if none makes such a file."""
        for declared in rules:
            inputs = declared.inputs
            for form in (form for forms in inputs.values() for form in forms):
                if not any(form in rule.files for rule in self.rules.values()):
                    raise ValueError(f"rule {declared.name}: reads {form}, which no rule declared before it makes")
            reads = {name: [form for form in forms if form in self._made_by] for name, forms in inputs.items()}
            makers = [self._made_by[form] for forms in reads.values() for form in forms]
            possible = (
                declared.over in ("any", "several" if self.study.is_plane else "a")
                and declared.stage not in self.study.left_out
                and (declared.if_there or reads == inputs)
            )
            rule = replace(
                declared,
                reads=reads,
                there=possible and declared.there and bool(declared.each),
                asked=declared.asked and all(maker.asked for maker in makers),
            )
            self.rules[rule.name] = rule
            if rule.there:
                self.there[rule.name] = rule
                self._made_by.update(dict.fromkeys(rule.files, rule))
            if rule.there or (possible and rule.refused):
                self.defined[rule.name] = rule

    def asked(self) -> list[Rule]:
        """Return the rules of the files that the target `all` makes, besides runs."""
        return [rule for rule in self.there.values() if rule.asked and rule.make]

    def runs(self) -> list[Rule]:
        """Return the rules of the point files, whose wildcards are arguments of `Study.command`."""
        return [self.there[name] for name in ("simulate", "simulate_solver") if name in self.there]

    def stage_of(self, name: str) -> str:
        """Return the stage of a rule, whose name a workflow that imports this one has put a word before."""
        known = [own for own in self.rules if f"_{name}".endswith(f"_{own}")]
        return self.rules[max(known, key=len)].stage if known else name

    def files(self, start: str = "", end: str = "") -> list[str]:
        """Return the files that the target `all` makes, besides runs, whose names start and end so."""
        return [name for rule in self.asked() for name in made(rule) if name.startswith(start) and name.endswith(end)]

    def of_paper(self) -> list[Rule]:
        """Return the rules of the figures of the paper."""
        return [rule for rule in self.asked() if rule.stage == "figures" and rule.priority]

    @cached_property
    def all_files(self) -> dict[str, tuple[Rule, Wildcards]]:
        """{name: its job} of all files of the study besides runs, also of those that are made by name only."""
        return {
            form.format(**job): (rule, job)
            for rule in self.there.values()
            if rule.make
            for job in rule.each
            for form in rule.files
        }

    def inputs(self, rule: Rule, job: Wildcards) -> dict[str, list[str]]:
        """Return {name: files of other rules} that a job reads, besides points."""
        return {
            name: [form.format(**other) for form in forms for _, other in self._sources_of(form, job)]
            for name, forms in rule.inputs.items()
        }

    def _sources_of(self, form: str, job: Wildcards) -> Iterator[tuple[Rule, Wildcards]]:
        """Yield the jobs that make the files of a form that a job reads, with the same values of common wildcards."""
        rule = self._made_by[form]
        for other in rule.each:
            if all(other[name] == value for name, value in job.items() if name in other):
                yield rule, other

    def point_files(self, rule: Rule, job: Wildcards) -> list[str]:
        """Return the points that a job reads; of a grid over several parameters, the marks of their stretches."""
        if rule.points is None:
            return []
        if "stretch" in self.there:
            return made(self.there["stretch"])
        points = rule.points(job)
        names = ("law", "initial", *points["parameters"])
        found = product(points["laws"], points["initial"], *points["parameters"].values())
        return [self.rules["simulate"].files[0].format(**dict(zip(names, one, strict=True))) for one in found]

    def abouts(self, rule: Rule, job: Wildcards) -> dict[str, dict[str, Any]]:
        """Return {file: what it must be made from} of a job, for seals.

        Its name, the function that makes it, the parts of the config that decide it, the sources of the function, and a
        digest of the same of each file that the job reads. Points are described by the config and by their sources.
        """
        return {form.format(**job): self._about(rule, job, form.format(**job)) for form in rule.files}

    def _about(self, rule: Rule, job: Wildcards, name: str) -> dict[str, Any]:
        if name not in self._abouts:
            runs = self.rules["simulate"]
            points = {"points": rule.points(job), "of_points": source_fingerprint(*runs.sources)} if rule.points else {}
            read = [
                (form.format(**other), maker, other)
                for forms in rule.inputs.values()
                for form in forms
                for maker, other in self._sources_of(form, job)
                if maker.make
            ]
            self._abouts[name] = {
                "file": name,
                "make": rule.make,
                **points,
                **rule.params(job),
                "sources": source_fingerprint(*rule.sources),
                "inputs": {file: digest_of(self._about(maker, other, file)) for file, maker, other in read},
            }
        return self._abouts[name]

    def expected(self, name: str) -> dict[str, Any] | None:
        """Return what a file must be made from, by its name in the results; None if the study has no such file."""
        if name in self.all_files:
            return self._about(*self.all_files[name], name)
        for rule in self.runs():
            found = re.fullmatch(self.pattern(rule.files[0]), name)
            if found and (job := found.groupdict()) in list(rule.each):
                return point_identity(self.study.command(**job))
        return None

    def pattern(self, form: str) -> str:
        """Return a regular expression for the names of files, with a group for each wildcard."""
        literal, *parts = re.split(r"\{(\w+)\}", form)
        known = {**PATTERNS, **dict.fromkeys(self.study.wildcards, VALUE)}
        groups = (f"(?P<{name}>{known.get(name, PATTERNS['solver'])})" for name in parts[::2])
        return re.escape(literal) + "".join(
            group + re.escape(text) for group, text in zip(groups, parts[1::2], strict=True)
        )
