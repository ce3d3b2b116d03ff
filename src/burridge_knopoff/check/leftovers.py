"""Results that belong to no point of a study: of a law, a state or a value of a that its config had once."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from burridge_knopoff.figures.description import figure_descriptions
from burridge_knopoff.study import Study

_LAW, _STATE, _A = r"(?P<law>[a-z]\w*)", r"(?P<initial>[A-Za-z]\w*)", r"a(?P<a>\d+\.\d+)"
_POINT = rf"{_LAW}/{_STATE}/{_A}"
_SOLVER = rf"(?P<solver>\w+)/{_POINT}"
_MAP = rf"(?P<mapped>[a-z]\w*)/{_A}"

#: (files of results, their logs and benchmarks) that carry a law, a state or a value of a in their names, below the
#: results, without suffix; no other file is ever held for left over.
_NAMED = (
    (rf"points/{_POINT}", rf"simulate/{_POINT}"),
    (rf"solvers/{_SOLVER}", rf"simulate_solver/{_SOLVER}"),
    (rf"basins/{_MAP}/(?:pairs|tile(?P<tile>\d+))",) * 2,
    *((rf"{folder}/{_LAW}",) * 2 for folder in ("attractors", "refined", "edges", "phases")),
)


def leftovers(results: Path, study: Study) -> tuple[list[Path], list[Path]]:
    """Return the files of results that belong to no point of a study, and the logs and benchmarks that do not."""
    found: dict[bool, list[Path]] = {True: [], False: []}
    patterns = list(_patterns())
    # What a link leads to is not the study's own.
    for path in sorted(path for path in results.rglob("*") if path.is_file() and not path.is_symlink()):
        if not path.resolve().is_relative_to(results.resolve()):
            continue
        name = path.relative_to(results).as_posix()
        for pattern, is_result in patterns:
            if (match := pattern.fullmatch(name)) and not _belongs(study, match.groupdict()):
                found[is_result].append(path)
    return found[True], found[False]


def _patterns() -> Iterator[tuple[re.Pattern[str], bool]]:
    """Yield patterns of paths below the results, and whether they are of results or of logs and benchmarks."""
    # A picture of a single run is named for its state.
    pictures = [figure.file.replace("{initial}", _STATE) for figure in figure_descriptions() if "{" in figure.file]
    named = [*_NAMED, *((f"figures/{picture}", f"figure_{picture}") for picture in pictures)]
    for file, log in named:
        yield re.compile(rf"{file}\.(?:{'pdf|png' if file.startswith('figures') else 'nc'})"), True
        yield re.compile(rf"logs/{log}\.log"), False
        yield re.compile(rf"benchmarks/{log}\.tsv"), False


def _belongs(study: Study, named: Mapping[str, str | None]) -> bool:
    """Tell whether what stands in the name of a file is of the study."""
    a = study.grid.get(named.get("a") or "")
    if (mapped := named.get("mapped")) is not None:
        return (mapped, a) in study.basin_maps and int(named["tile"] or 0) < study.config["basins"]["tiles"]
    if named.get("law", study.laws[0]) not in study.laws or named.get("initial", study.initial[0]) not in study.initial:
        return False
    if (solver := named.get("solver")) is not None:
        return a in study.config["solvers"]["a"] and solver in study.other_solvers(str(named["law"]))
    return "a" not in named or a is not None


def delete(results: Path, paths: list[Path]) -> None:
    """Delete files of a study, and the folders in it that are empty without them; raises OSError if one cannot be."""
    for path in paths:
        path.unlink(missing_ok=True)
        for folder in path.parents:
            if folder == results or any(folder.iterdir()):
                break
            folder.rmdir()
