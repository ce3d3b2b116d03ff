"""Trajectories of the runs in a few bytes each, from which the page draws the blocks as they move."""

from __future__ import annotations

import base64
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from burridge_knopoff.study.study import Study, all_points
from burridge_knopoff.summaries.points import read_point

#: A run has at most so many frames: each EVERY-th sample from the end of its stored trajectory.
FRAMES, EVERY = 300, 2

#: Largest number of positions in the page; a study with more has the runs at each n-th value of a.
LARGEST = 600_000

#: Resolution: the largest displacement between two frames of a run, in steps of one byte.
STEPS = 126


def embedded_trajectories(study: Study, results: Path) -> dict[str, Any] | None:
    """Return the last trajectory of each run for the page; None for a ring or a network, which are no line of blocks.

    `packed` is the base64 of compressed bytes, (run, block, frame) with the runs in the order law, initial state, a:
    displacements in the frame of the ground from one frame to the next, in units of `unit`. `first` are the positions
    in the first frame, in which the driver is at 0. A run without trajectory has unit 0 and no bytes.

    Raises BadFile as `read_point` does.
    """
    chain = study.chain
    if chain.ends == "ring" or chain.is_network:
        return None
    points = all_points(study)
    every = -(-len(points) * FRAMES * chain.blocks // LARGEST)
    values = list(study.grid)[::every]
    units, first, frames, packed = [], [], [], []
    interval = EVERY * study.settings(study.laws[0]).trajectory_sampling
    for point in points:
        if point["a"] not in values:
            continue
        run = read_point(study, results, point, ("position", "trajectory_time"))
        count = min(FRAMES, (len(run["position"]) - 1) // EVERY)
        position, time = (run[name][-1 - EVERY * count :: EVERY] for name in ("position", "trajectory_time"))
        ground = position + study.config["v"] * (time - time[:1])[:, None]
        unit, steps = _steps(ground)
        units.append(float(f"{unit:.6g}"))
        first.append([round(float(value), 5) for value in ground[0]] if unit else [])
        frames.append(len(steps))
        packed.append(steps.T.tobytes())
    return {
        "v": study.config["v"],
        "every": every,
        "interval": interval,
        "blocks": chain.blocks,
        "pulled": (chain.driving > 0.0).tolist(),
        "coupled": (chain.coupling_to_next[: chain.blocks - 1] > 0.0).tolist(),
        "units": units,
        "first": first,
        "frames": frames,
        "packed": base64.b64encode(zlib.compress(b"".join(packed), 9)).decode(),
    }


def _steps(ground: np.ndarray) -> tuple[float, np.ndarray]:
    """Return a unit and displacements in it as bytes, shape (frame, block); positions have the shape (frame, block)."""
    largest = float(np.abs(np.diff(ground, axis=0)).max(initial=0.0))
    if len(ground) < 2 or not np.isfinite(ground).all():
        return 0.0, np.zeros((0, ground.shape[-1]), "i1")
    unit = largest / STEPS or 1.0
    # Rounded positions, so that errors do not add up; a block at rest moves by exactly 0.
    return unit, np.diff(np.round((ground - ground[0]) / unit), axis=0).astype("i1")
