"""The files of a study by name: existing, missing, and left over from an earlier config."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from burridge_knopoff.figures.description import figure_descriptions, study_figures
from burridge_knopoff.provenance.seal import seal_path
from burridge_knopoff.study.paths import STRETCH, VALUE
from burridge_knopoff.study.stages import OPTIONAL_SUMMARIES, SUMMARIES
from burridge_knopoff.study.stretches import stretches
from burridge_knopoff.study.study import Study, all_points, solver_points
from burridge_knopoff.study.summary_rows import SUMMARY_ROWS, TEXTS

#: Patterns of the parts of file names; a file with any other name never counts as leftover.
_WILDCARDS = {
    "law": r"[a-z]\w*",
    "initial": r"[A-Za-z]\w*",
    "a": r"\d+\.\d+",
    "values": rf"[A-Za-z]\w*?{VALUE}(?:_[A-Za-z]\w*?{VALUE})*",
    "stretch": r"\d+",
    "solver": r"\w+",
    "tile": r"(?:0|[1-9]\d*)",
    "blocks": r"[1-9]\d*",
}

#: The stage whose job makes a file, if it differs from the stage in the file's name.
_STAGE_OF = {name: stage for stage, names in SUMMARIES.items() for name in names}

#: The name patterns of the files that a job makes and, without suffix, of its log; and all combinations of wildcards in
#: the study: one empty combination for a file without wildcards, none if the study does not have the file.
Named = tuple[list[str], str, list[dict[str, str]]]


def leftovers(results: Path, study: Study) -> list[Path]:
    """Return results, logs and benchmarks of points, stages and figures that the study does not have."""
    patterns: list[str] = []
    known: set[str] = set()
    point = study.point_file.removesuffix(".nc")
    marks = [{"stretch": stretch} for stretch in stretches(study)]
    for files, log, named in (*run_files(study), ([STRETCH], "stretch/{stretch}", marks), *_other_files(study)):
        for form in (*files, f"logs/{log}.log", f"benchmarks/{log}.tsv"):
            # A point of another study may be one of other parameters.
            general = form.replace(point, "{law}/{initial}/{values}")
            patterns.append(general.replace(".", r"\.").format(**_WILDCARDS))
            known.update(form.format(**wildcards) for wildcards in named)
    pattern, whole = re.compile("|".join(patterns)), results.resolve()
    names = {path: path.relative_to(results).as_posix() for path in sorted(results.rglob("*"))}
    return [
        path
        for path, name in names.items()
        if pattern.fullmatch(name)
        and name not in known
        # The target of a link does not belong to the study.
        and path.resolve() == whole / name
        and path.is_file()
    ]


def study_files(study: Study) -> list[str]:
    """Return the names, relative to its results, of all files of a study except points and their logs."""
    return [
        file.format(**wildcards) for files, _, named in _other_files(study) for wildcards in named for file in files
    ]


def unmade(results: Path, study: Study) -> dict[Path, Path]:
    """Return {file: log} of missing files, except points, whose job has started, as its log shows.

    A file without a log was not requested yet, or waits for other missing files.
    """
    made = {
        results / file.format(**wildcards): results / f"logs/{log}.log".format(**wildcards)
        for files, log, named in _other_files(study)
        for wildcards in named
        for file in files
    }
    return {path: log for path, log in made.items() if log.exists() and not path.exists()}


def run_files(study: Study) -> list[Named]:
    """Return the point files of all runs, with the wildcards of each as arguments of `Study.command`."""
    file = study.point_file
    log = file.removesuffix(".nc")
    return [
        ([f"points/{file}"], f"simulate/{log}", all_points(study)),
        ([f"solvers/{{solver}}/{file}"], f"simulate_solver/{{solver}}/{log}", solver_points(study)),
    ]


def _other_files(study: Study) -> Iterator[Named]:
    maps = [{"law": law, "a": a} for law, a in study.basin_maps]
    tiles = [{**one, "tile": str(tile)} for one in maps for tile in range(study.config["basins"]["tiles"])]
    runs = [{"law": law, "a": a} for law in study.laws for a in study.catalogue_a]
    for form, known in (
        ("basins/{law}/a{a}/pairs", maps),
        ("basins/{law}/a{a}/tile{tile}", tiles),
        ("catalogues/{law}/a{a}", runs),
    ):
        yield [f"{form}.nc"], form, known
    for folder in ("attractors", "refined", "returns", "bifurcations", "phases"):
        stage = "attractors" if folder == "returns" else folder
        laws = study.laws if stage in study.stage_summaries else ()
        yield [f"{folder}/{{law}}.nc"], f"{_STAGE_OF.get(stage, stage)}/{{law}}", [{"law": law} for law in laws]
    numbers = study.config["chains"]["blocks"] if study.chain_summaries else []
    yield ["chains/blocks{blocks}.nc"], "chains/blocks{blocks}", [{"blocks": str(number)} for number in numbers]
    for name in sorted(OPTIONAL_SUMMARIES | SUMMARY_ROWS.keys()):
        files = [f"summary/{name}.{suffix}" for suffix in ("nc", *TEXTS.get(name, ()))]
        yield files, _STAGE_OF.get(name, name), [{}] if study.has_summary(name) else []
    files = [f"summary/claims.{suffix}" for suffix in ("json", "csv", "md")]
    yield files, "claims", [{}] if "claims" in study.stages else []
    # A picture of a single run has the name of its state.
    drawn = {figure.file for figure in study_figures(study, study.chain_summaries)}
    for figure in figure_descriptions():
        states = study.initial if figure.file in drawn else ()
        files = [f"figures/{figure.file}.{suffix}" for suffix in ("pdf", "png")]
        yield files, f"figure_{figure.file}", [{"initial": initial} for initial in states]
    yield ["report.html"], "report", [{}]


def delete(results: Path, paths: list[Path]) -> None:
    """Delete files of a study, and folders that this leaves empty; raises OSError if a file cannot be deleted."""
    for path in paths:
        path.unlink(missing_ok=True)
        seal_path(path).unlink(missing_ok=True)
        for folder in path.parents:
            if folder == results or any(folder.iterdir()):
                break
            folder.rmdir()
