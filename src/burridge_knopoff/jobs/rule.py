"""A rule: the declaration of alike jobs, which differ in the values of some wildcards."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any

#: {name of a wildcard: its value in a job}
Wildcards = Mapping[str, str]

#: Folders whose files have logs without the folder's name, and what stands there instead.
_IN_LOGS = {"summary": "", "figures": "figure_"}


@dataclass(frozen=True)
class Shown:
    """How `snakemake --report` shows a file.

    caption : name of a file in workflow/report, and words that it quotes; paper : figures of the paper
    """

    title: str
    category: str
    caption: str
    paper: str = "none"
    words: str = ""


@dataclass(frozen=True)
class Rule:
    """What the jobs of a rule read and make, and what decides their files; files are named relative to the results.

    name, purpose, message : Snakemake's name, docstring (a sentence) and message of a job
    files : that a job makes, with the names of wildcards in braces
    make : "room.module:function", which makes the content of the files, see `jobs.run`; empty for runs, which the
        workflow makes
    modules : that `make` loads by name: their sources count, too
    reads : {name: files of other rules}; a wildcard that the job does not have stands for all its values
    if_there : whether it reads those only that the study has
    points : returns what `Study.points` says of the points that a job reads; None if it reads none
    params : returns the parts of the config that decide what a job makes, and no others
    each : the wildcards of all jobs
    stage : the name of its part of the study; the config can leave out some
    over : the studies that can have it: of a alone, of `several` parameters, or of `any`
    there : whether the study has it, if it can and the stage is not left out
    refused : why not, for those who ask for its files by name
    asked : whether the target `all` makes it
    shown : {file: how `snakemake --report` shows it}
    cores : of a job; 0 for the cores of the machine, shared among the laws
    memory, minutes : that a job needs, in MB, and 100 MB more for each core if it has several; 0 for the usual
    priority : jobs with a higher one start first
    group : its group of jobs on a cluster
    log : name of the log of a job, without suffix, if it is not that of its first file
    work : what one of its jobs has to do, in units of its own, from which the display tells its time
    """

    name: str
    purpose: str
    message: str
    files: tuple[str, ...]
    make: str = ""
    modules: tuple[str, ...] = ()
    reads: Mapping[str, str | Sequence[str]] = field(default_factory=dict)
    if_there: bool = False
    points: Callable[[Wildcards], Mapping[str, Any]] | None = None
    params: Callable[[Wildcards], Mapping[str, Any]] = lambda wildcards: {}
    each: Sequence[Wildcards] = ({},)
    stage: str = "summary"
    over: str = "a"
    there: bool = True
    refused: str = ""
    asked: bool = True
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
        """{name: files of other rules that it reads}, besides points."""
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
