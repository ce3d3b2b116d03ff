"""A rule: the declaration of jobs that differ only in the values of some wildcards."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any

#: {name of a wildcard: its value in a job}
Wildcards = Mapping[str, str]

#: {folder whose name is left out of the names of logs: prefix of these names}
_IN_LOGS = {"summary": "", "figures": "figure_"}


@dataclass(frozen=True)
class Shown:
    """How `snakemake --report` shows a file.

    caption, words : name of a file in workflow/report, and words that it quotes; paper : figures of the paper
    """

    title: str
    category: str
    caption: str
    paper: str = "none"
    words: str = ""


@dataclass(frozen=True)
class Rule:
    """What the jobs of a rule read and make, and what their files depend on; paths are relative to the results.

    name, purpose, message : Snakemake's name, docstring (a sentence) and message of a job
    files : the files that a job makes, with the names of wildcards in braces
    make : "package.module:function", which makes the content of the files, see `jobs.run`; empty for runs, which the
        workflow makes
    modules : modules that `make` loads by name, whose sources count as well
    reads : {name: files of other rules}; a wildcard that the job does not have stands for all its values
    optional_reads : whether files of `reads` that the study does not have are left out
    points : returns the part of `Study.points` with the points that a job reads; None if it reads none
    keys : returns exactly those keys of the config on which the files of a job depend, see `provenance.keys`
    figures : names of pictures to which its files refer
    each : the wildcards of all jobs
    stage : the part of the study to which the rule belongs; a config can leave out some
    over : the studies that can have the rule: over a alone, over `several` parameters, or over `any`
    exists : whether the study has the rule, provided that its stage is not left out
    refusal : the reason why the study does not have it, for those who request its files by name
    requested : whether the target `all` makes its files
    shown : {file: how `snakemake --report` shows it}
    cores : cores of a job; 0 for the cores of the machine, shared among the laws
    memory, minutes : memory of a job in MB, with 100 MB more for each of several cores, and time; 0 for the defaults
    priority : jobs with a higher priority start first
    group : group of jobs on a cluster
    log : name of the log of a job, without suffix, if it is not that of its first file
    work : amount of work of a job, in units of the rule, from which the display estimates the time
    """

    name: str
    purpose: str
    message: str
    files: tuple[str, ...]
    make: str = ""
    modules: tuple[str, ...] = ()
    reads: Mapping[str, str | Sequence[str]] = field(default_factory=dict)
    optional_reads: bool = False
    points: Callable[[Wildcards], Mapping[str, Any]] | None = None
    keys: Callable[[Wildcards], Sequence[str]] = lambda wildcards: ()
    figures: Sequence[str] = ()
    each: Sequence[Wildcards] = ({},)
    stage: str = "summary"
    over: str = "a"
    exists: bool = True
    refusal: str = ""
    requested: bool = True
    shown: Mapping[str, Shown] = field(default_factory=dict)
    cores: int = 1
    memory: int = 0
    minutes: int = 0
    priority: int = 0
    group: str = ""
    log: str = ""
    work: float = 0.0

    @property
    def inputs(self) -> dict[str, list[str]]:
        """{name: files of other rules that it reads}, except points."""
        return {name: [files] if isinstance(files, str) else list(files) for name, files in self.reads.items()}

    @property
    def sources(self) -> tuple[str, ...]:
        """Full names of the modules that make its files."""
        modules = (self.make.partition(":")[0] or "dataset.point", *self.modules)
        return tuple(f"burridge_knopoff.{module}" for module in modules)

    @property
    def log_name(self) -> str:
        """Name of the log and of the benchmark of a job, without suffix."""
        name = PurePosixPath(self.files[0]).with_suffix("")
        folder = name.parts[0]
        return self.log or (f"{_IN_LOGS[folder]}{name.relative_to(folder)}" if folder in _IN_LOGS else f"{name}")
