"""The single runs of a study: results, paths of the files, and the commands that recompute them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.messages import command
from burridge_knopoff.motion.kind import Motion, MotionKind, format_motion
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.report.numbers import format_measured, json_number
from burridge_knopoff.running.status import STATUS_WORDS, Status
from burridge_knopoff.study.paths import POINT
from burridge_knopoff.study.study import Study


@dataclass(frozen=True)
class Commands:
    """The commands that recompute a run, to be typed in the repository.

    arguments : arguments of `snakemake` that select the study; none for the default study
    """

    study: Study
    arguments: Sequence[str] = ()

    def point_path(self, law: str, initial: str, a: str) -> str:
        """Return the path of a point file in the results of the study."""
        return f"points/{POINT.format(law=law, initial=initial, a=a)}"

    def snakemake(self, law: str, initial: str, a: str) -> str:
        """Return the command that recomputes the point file. The target comes before --config."""
        return self.study_command("-c1", "--force", f"results/{self.study.name}/{self.point_path(law, initial, a)}")

    def study_command(self, *words: str) -> str:
        """Return a Snakemake command with these words for the study."""
        return command("snakemake", *words, *self.arguments)

    def simulate(self, law: str, initial: str, a: str) -> str:
        """Return the command of the same run without Snakemake, which writes the point file to the current folder."""
        return f"{self.study.command(law, initial, a)} --out {law}_{initial}_a{a}.nc"


def embedded_runs(
    commands: Commands, mean_distance: xarray.Dataset, lyapunov: xarray.Dataset, agreement: xarray.Dataset
) -> dict[str, Any]:
    """Return the page's data of every run, with exact values; arrays over (law, initial, a).

    `agrees` says whether the other laws agree, over (other law, initial, a). Kinds of motion and periods are those of
    the attractor that the run has reached, from `agreement`.

    `has_a` says whether any law contains a, `has_end_blocks` whether there is a distance J.
    `first` are the indices of the run that the page shows first, which is that of the figures of single runs.
    `simulate` has the command for each law and initial state in two parts, with `--a` and its value between them.
    """
    study = commands.study
    names = list(study.grid)
    exponent, error = lyapunov["lyapunov_exponent"].values, lyapunov["lyapunov_error"].values
    return {
        "laws": list(study.laws),
        "initial": list(study.initial),
        "a": list(study.grid.values()),
        "texts": [repr(value) for value in study.grid.values()],
        "names": names,
        "has_a": study.has_a,
        "has_end_blocks": study.has_end_blocks,
        "first": [study.laws.index(study.shown_law), 0, names.index(study.shown_point)],
        "mean_distance": _nested_lists(mean_distance["mean_distance"].values),
        "status": mean_distance["status"].values.tolist(),
        "kind_text": _kind_texts(study, agreement, lyapunov),
        "mean_distance_text": _format_errors(*(mean_distance[f"mean_distance{end}"].values for end in ("", "_error"))),
        "exponent_texts": _format_errors(exponent, error),
        "agrees": agreement["agrees"].values.tolist(),
        "simulate": [[_split_command(commands, law, initial) for initial in study.initial] for law in study.laws],
        "arguments": command(*commands.arguments),
        "results": f"results/{study.name}",
        "statuses": list(STATUS_WORDS.values()),
    }


def _nested_lists(values: np.ndarray) -> Any:
    return json_number(values.item()) if values.ndim == 0 else [_nested_lists(np.asarray(item)) for item in values]


def _kind_texts(study: Study, agreement: xarray.Dataset, lyapunov: xarray.Dataset) -> Any:
    """Return kinds of motion in words, in nested lists."""
    settings = MotionSettings(**study.config["motion"]).scaled_to_velocity(study.config["v"])
    kind, period, points = agreement["kind"].values, agreement["period"].values, lyapunov["section_period"].values
    texts = [
        format_motion(Motion(MotionKind(code), count, time), settings).replace(
            "quasiperiodic within", "quasiperiodic: no repetition was found within"
        )
        for code, count, time in zip(kind.flat, points.flat, period.flat, strict=True)
    ]
    return np.array(texts, dtype=object).reshape(kind.shape).tolist()


def _format_errors(values: np.ndarray, errors: np.ndarray) -> Any:
    """Return values with their errors as text, in nested lists."""
    return (
        np.array([format_measured(*pair) for pair in zip(values.flat, errors.flat, strict=True)], dtype=object)
        .reshape(values.shape)
        .tolist()
    )


def _split_command(commands: Commands, law: str, initial: str) -> list[str]:
    """Return the command of a run in two parts, before and after its value of a; in one part under a law without a."""
    name, value = next(iter(commands.study.grid.items()))
    command = commands.simulate(law, initial, name).removesuffix(f"{name}.nc")
    return command.split(f" --a {value!r} ", 1)


def unclear_runs(commands: Commands, mean_distance: xarray.Dataset, agreement: xarray.Dataset) -> list[dict[str, str]]:
    """Return the runs that did not complete, followed by those whose kind of motion is undetermined."""
    failed, undetermined = [], []
    for i, law in enumerate(commands.study.laws):
        for j, initial in enumerate(commands.study.initial):
            for k, a in enumerate(commands.study.grid):
                status = int(mean_distance["status"].values[i, j, k])
                if status == Status.COMPLETED and int(agreement["kind"].values[i, j, k]) != MotionKind.UNDETERMINED:
                    continue
                run = {
                    "law": law,
                    "initial": initial,
                    "a": repr(commands.study.grid[a]),
                    "path": commands.point_path(law, initial, a),
                    "command": commands.snakemake(law, initial, a),
                }
                if status == Status.COMPLETED:
                    undetermined.append({**run, "what": "kind of motion undetermined"})
                else:
                    failed.append({**run, "what": f"did not complete: {STATUS_WORDS[status]}"})
    return [*failed, *undetermined]
