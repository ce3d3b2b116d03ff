"""What initial phases of the end blocks lead to, over (law, a, amplitude, phase difference): `stability.phases`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.summary import AXES, STATE, axes, summary
from burridge_knopoff.dataset.variables import Variable
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.stability.basins import KnownAttractors, known_attractors
from burridge_knopoff.stability.labels import UNDETERMINED, label_states
from burridge_knopoff.stability.phases import common_phases, oscillating_states, slipping_amplitude
from burridge_knopoff.stability.sampling import fraction_interval
from burridge_knopoff.stability.settings import MotionSettings, PhaseSettings, SearchSettings
from burridge_knopoff.summaries.correlation import correlation

#: Time for which each attractor is followed for the correlation of the velocities on it.
FOLLOWED = 1000.0

_V = Variable
_CELL = ("a", "amplitude", "phase_difference")
_STATE = (*_CELL, "state")
_DEGREE = {"units": "degree"}
#: What differs between the laws.
VARIABLES = {
    "branch": _V(_STATE, "i2", "branch of the attractor that the state reaches, -1 if undetermined"),
    "side": _V(_STATE, "i1", "side of that branch: 1 and -1 for mirror images, 0 for its own mirror image"),
    "velocity_correlation": _V(
        _STATE, "f8", "Pearson correlation of the velocities of the end blocks on that attractor, NaN if undetermined"
    ),
    "synchronized_fraction": _V(_CELL, "f8", "fraction of the states that synchronize"),
    "synchronized_low": _V(_CELL, "f8", "lower end of its 95 % Wilson interval"),
    "synchronized_high": _V(
        _CELL, "f8", "upper end of its 95 % Wilson interval, undetermined states counted as synchronized"
    ),
    "undetermined_count": _V(_CELL, "i4", "states that reach no attractor by label_limit"),
}
#: What is the same under each law.
COMMON_VARIABLES = {
    "common_phase": _V(_STATE, "f8", "phase theta of the first block at tau = 0", _DEGREE),
    "standing_count": _V(_CELL, "i4", "states with an end block that stands, as its velocity would be negative"),
}
COORDINATES = {
    "amplitude": _V(("amplitude",), "f8", "amplitude A of both end blocks about uniform sliding", coordinate=True),
    "phase_difference": _V(
        ("phase_difference",), "f8", "by how much the last block is ahead of the first", _DEGREE, coordinate=True
    ),
}


def one_law(
    attractors: xarray.Dataset,
    model: Model,
    grid: Sequence[float],
    phases: PhaseSettings,
    settings: SearchSettings,
    motion: MotionSettings,
) -> xarray.Dataset:
    """Label states by their phases under one law.

    attractors : the summary of that name, made with these settings of the search and of kinds of motion
    model : under that law, at any a; grid : values of a, of those of the summary
    """
    shape = (len(phases.amplitude), len(phases.phase_difference), phases.samples)
    amplitude, difference, _ = np.meshgrid(phases.amplitude, phases.phase_difference, range(shape[2]), indexing="ij")
    found: dict[str, list[np.ndarray]] = {name: [] for name in (*VARIABLES, *COMMON_VARIABLES)}
    for a in grid:
        known = known_attractors(attractors, model.at(a), settings, motion)
        common = common_phases(a, shape, phases.seed)
        states = oscillating_states(known.model, amplitude.ravel(), difference.ravel(), common.ravel())
        position, velocity, standing = states
        # Every block slips in the midst of its oscillation: there is no stick rule to apply at τ = 0.
        labels, _ = label_states(known.model, known.attractors, position, velocity, time_limit=settings.label_limit)
        values = {"common_phase": common, "standing_count": standing.reshape(shape).sum(axis=2)}
        values |= _reached(known, labels.reshape(shape))
        for name, value in values.items():
            found[name].append(value)
    coordinates: dict[str, Any] = {"a": ("a", np.array(grid, dtype=float), AXES["a"].all_attributes())}
    for name, item in COORDINATES.items():
        coordinates[name] = (name, np.array(getattr(phases, name)), item.all_attributes())
    coordinates["state"] = ("state", np.arange(1, shape[2] + 1, dtype=STATE.dtype), STATE.all_attributes())
    attributes = {
        "law": model.law.name,
        "history": "snakemake, from attractors.nc",
        "v": model.v,
        "contact": model.contact,
        "seed": phases.seed,
        "label_limit": settings.label_limit,
        "slipping_amplitude": slipping_amplitude(model),
    }
    variables = {**VARIABLES, **COMMON_VARIABLES}
    arrays = {name: np.array(values) for name, values in found.items()}
    return summary("Initial phases of the end blocks", variables, arrays, coordinates, attributes, module=__name__)


def merge(parts: Sequence[xarray.Dataset]) -> xarray.Dataset:
    """Return the files of all laws in one Dataset with the dimension law."""
    values = {name: np.stack([part[name].values for part in parts]) for name in VARIABLES}
    values |= {name: parts[0][name].values for name in COMMON_VARIABLES}
    variables = {name: replace(item, dimensions=("law", *item.dimensions)) for name, item in VARIABLES.items()}
    coordinates: dict[str, Any] = {str(name): parts[0][name].variable for name in parts[0].coords}
    coordinates["law"] = axes([], [], [part.attrs["law"] for part in parts])["law"]
    attributes = {
        name: parts[0].attrs[name] for name in ("history", "v", "contact", "seed", "label_limit", "slipping_amplitude")
    }
    title = "Initial phases of the end blocks"
    return summary(title, {**variables, **COMMON_VARIABLES}, values, coordinates, attributes, module=__name__)


def _reached(known: KnownAttractors, labels: np.ndarray) -> dict[str, np.ndarray]:
    """Return what states reach by their labels, shape (amplitude, phase_difference, state)."""
    # The last entry is that of the label −1.
    tables = {
        "branch": np.append(known.branch, UNDETERMINED),
        "side": np.append(known.side, 0),
        "velocity_correlation": np.append(
            [velocity_correlation(known.model, item.motion.instant()) for item in known.attractors], np.nan
        ),
    }
    values = {name: table[labels] for name, table in tables.items()}
    undetermined = (labels == UNDETERMINED).sum(axis=2)
    synchronized = (values["branch"] == 0).sum(axis=2)
    least, most = (_intervals(hits, labels.shape[2]) for hits in (synchronized, synchronized + undetermined))
    values |= dict(zip(("synchronized_fraction", "synchronized_low"), least[:2], strict=True))
    return {**values, "synchronized_high": most[2], "undetermined_count": undetermined}


def _intervals(hits: np.ndarray, count: int) -> np.ndarray:
    """Return fractions and the ends of their Wilson intervals, shape (3, *hits.shape)."""
    found = [fraction_interval(int(number), count) for number in hits.ravel()]
    return np.reshape(np.transpose(found), (3, *hits.shape))


def velocity_correlation(model: Model, start: Instant) -> float:
    """Return the Pearson correlation of the velocities of the end blocks from a state on; NaN if one is constant."""
    initial = InitialState("attractor", tuple(start.position + model.sliding_offset), tuple(start.velocity))
    settings = Settings(
        transient=0.0, window=FOLLOWED, batches=2, sampling=FOLLOWED, trajectory=FOLLOWED, events="none",
        lyapunov_exponents=0,
    )  # fmt: skip
    velocity = run(model, initial, settings, start).velocity
    return correlation(velocity[:, 0], velocity[:, -1])
