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
    patterns, belongs = list(_patterns()), _Names(study).belong
    whole = results.resolve()
    for path in sorted(results.rglob("*")):
        name = path.relative_to(results).as_posix()
        for pattern, is_result in patterns:
            match = pattern.fullmatch(name)
            # What a link leads to is not the study's own.
            if match and not belongs(match.groupdict()) and path.resolve() == whole / name and path.is_file():
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


class _Names:
    """What stands in the names of the files of a study."""

    def __init__(self, study: Study) -> None:
        self.laws, self.states, self.grid = set(study.laws), set(study.initial), set(study.grid)
        names = {value: name for name, value in study.grid.items()}
        compared = study.config["solvers"]["a"]
        self.compared = {names.get(value) for value in compared}
        self.solvers = {(law, solver) for law in study.laws if compared for solver in study.other_solvers(law)}
        self.maps = {(law, names.get(a)) for law, a in study.basin_maps}
        self.tiles = study.config["basins"]["tiles"]

    def belong(self, named: Mapping[str, str | None]) -> bool:
        """Tell whether what stands in a name is of the study."""
        law, a = named.get("law"), named.get("a")
        if (mapped := named.get("mapped")) is not None:
            return (mapped, a) in self.maps and int(named["tile"] or 0) < self.tiles
        if "solver" in named:
            fits = (law, named["solver"]) in self.solvers and a in self.compared
        else:
            fits = (law is None or law in self.laws) and (a is None or a in self.grid)
        return fits and ("initial" not in named or named["initial"] in self.states)


def delete(results: Path, paths: list[Path]) -> None:
    """Delete files of a study, and the folders in it that are empty without them; raises OSError if one cannot be."""
    for path in paths:
        path.unlink(missing_ok=True)
        for folder in path.parents:
            if folder == results or any(folder.iterdir()):
                break
            folder.rmdir()
