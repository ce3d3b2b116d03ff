"""The attractors reached from initial phases, over (law, a, inner share, amplitude, phase difference).

See `basins.initial_phases` for the initial states.

Phases are in degrees, uniform in [0, 360). They are the same under each law and with each `inner_share`, and different
at each a. `slipping_amplitude` is v/ω, or v/(share·ω_i) of an inner block if that is smaller. The correlation is taken
over 1000 time units.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.attractors.labels import UNDETERMINED, label_states
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.attractors.stored_returns import KnownAttractors, known_attractors
from burridge_knopoff.basins.initial_phases import common_phases, inner_phases, oscillating_states, slipping_amplitude
from burridge_knopoff.basins.settings import PhaseSettings
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.model.fields import settings_from_config
from burridge_knopoff.model.sampling import fraction_interval
from burridge_knopoff.running.processes import parallel_map
from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries.attractor_observables import follow_attractor
from burridge_knopoff.summaries.sentences import lines_of

TITLE = "Initial phases of the blocks"

_V = Variable
_CELL = ("a", "inner_share", "amplitude", "phase_difference")
_STATE = (*_CELL, "state")
# Dimensions of the phases, which are the same for all shares: these change only the amplitude of the inner blocks.
_PHASE = ("a", "amplitude", "phase_difference", "state")
_DEGREE = {"units": "degree"}
#: Variables that differ between the laws.
VARIABLES = {
    "branch": _V(_STATE, "i2", "branch reached: branch of the attractor that the state reaches, -1 if undetermined"),
    "side": _V(_STATE, "i1", "side of that branch: 1 and -1 for mirror images, 0 for its own mirror image"),
    "velocity_correlation": _V(
        _STATE,
        "f8",
        "velocity correlation: Pearson correlation of the velocities of the end blocks on that "
        "attractor, NaN if undetermined",
    ),
    "synchronized_fraction": _V(_CELL, "f8", "synchronized fraction: fraction of the states that synchronize"),
    "synchronized_low": _V(_CELL, "f8", "lower end of its interval: 95 % Wilson interval"),
    "synchronized_high": _V(
        _CELL, "f8", "upper end of its interval: 95 % Wilson interval, undetermined states counted as synchronized"
    ),
    "undetermined_count": _V(
        _CELL, "i4", "number of undetermined states: states that reach no attractor by label_limit"
    ),
}
#: Variables that are the same under all laws.
COMMON_VARIABLES = {
    "common_phase": _V(_PHASE, "f8", "phase theta of the first block: at tau = 0", _DEGREE),
    "inner_phase": _V((*_PHASE, "inner_block"), "f8", "phase of an inner block at tau = 0", _DEGREE),
    "standing_count": _V(_CELL, "i4", "number of states with a block at rest: because its velocity would be negative"),
    "slipping_amplitude": _V(
        ("inner_share",), "f8", "largest amplitude A of slip: for which all velocities are positive at all phases"
    ),
}
COORDINATES = {
    "inner_block": _V(("inner_block",), "i4", "block number: 2 to N - 1 along the chain", coordinate=True),
    "inner_share": _V(
        ("inner_share",),
        "f8",
        "share of the inner blocks: their amplitude relative to A; at 0 they slide uniformly",
        coordinate=True,
    ),
    "amplitude": _V(("amplitude",), "f8", "amplitude A: of both end blocks about uniform sliding", coordinate=True),
    "phase_difference": _V(
        ("phase_difference",),
        "f8",
        "phase difference: phase of the last block minus phase of the first",
        _DEGREE,
        coordinate=True,
    ),
}
ATTRIBUTES = ("history", "v", "contact", "seed", "label_limit")


def phases_of_law(
    config: Mapping[str, Any], law: str, attractors: xarray.Dataset, returns: xarray.Dataset, cores: int
) -> xarray.Dataset:
    """Return the outcomes under one law.

    config : the keys of a study's config that decide them
    attractors, returns : of all laws, and of the law, on the grid
    """
    phases, limit = config["phases"], SearchSettings(**config["attractors"]).label_limit
    candidates = [known_attractors(attractors, returns, model_of(config, law, a)) for a in phases["a"]]
    return one_law(candidates, settings_from_config(PhaseSettings, phases), limit, cores)


def one_law(
    candidates: Sequence[KnownAttractors], phases: PhaseSettings, label_limit: float, processes: int = 1
) -> xarray.Dataset:
    """Return the attractors that states with given phases reach under one law.

    candidates : the attractors at each a
    label_limit : time by which a state has to reach one of them
    processes : number of parallel processes; no result depends on it
    """
    with parallel_map(processes) as apply:
        rows = apply("phases", partial(_values_at, phases=phases, label_limit=label_limit), candidates, span=(0.0, 1.0))
    model, grid = candidates[0].model, [recorded_a(item.model.law) for item in candidates]
    inner = model.chain.blocks - 2
    coordinates = axes(
        COORDINATES,
        a=grid,
        **{name: getattr(phases, name) for name in ("inner_share", "amplitude", "phase_difference")},
        state=range(1, phases.samples + 1),
        inner_block=range(2, inner + 2),
    )
    attributes = {
        "law": model.law.name,
        "history": "snakemake, from attractors.nc",
        "v": model.v,
        "contact": model.contact,
        "seed": phases.seed,
        "label_limit": label_limit,
    }
    variables = {**VARIABLES, **COMMON_VARIABLES}
    arrays = {name: np.array([values[name] for values in rows]) for name in rows[0]}
    arrays["slipping_amplitude"] = np.array([slipping_amplitude(model, share) for share in phases.inner_share])
    return summary(TITLE, variables, arrays, coordinates, attributes, module=__name__)


def _values_at(candidates: KnownAttractors, phases: PhaseSettings, label_limit: float) -> dict[str, np.ndarray]:
    """Return the values of all variables at one a, except the slipping amplitude."""
    shape = (len(phases.amplitude), len(phases.phase_difference), phases.samples)
    amplitude, difference, _ = np.meshgrid(phases.amplitude, phases.phase_difference, range(shape[2]), indexing="ij")
    model = candidates.model
    inner = model.chain.blocks - 2
    correlations = [follow_attractor(model, item.motion.state()).velocity_correlation for item in candidates.attractors]
    common = common_phases(recorded_a(model.law), shape, phases.seed)
    of_inner = inner_phases(recorded_a(model.law), (*shape, inner), phases.seed)
    phases_of_states = amplitude.ravel(), difference.ravel(), common.ravel()
    cells = []
    for share in phases.inner_share:
        position, velocity, standing = oscillating_states(model, *phases_of_states, share, of_inner.reshape(-1, inner))
        # Every block is in the middle of an oscillation, so that no convention for the start applies at τ = 0.
        labels, _ = label_states(model, candidates.attractors, position, velocity, time_limit=label_limit, cores=1)
        cell = {"standing_count": standing.reshape(shape).sum(axis=2)}
        cells.append({**cell, **_outcomes(candidates, correlations, labels.reshape(shape))})
    values = {name: np.array([cell[name] for cell in cells]) for name in cells[0]}
    return {"common_phase": common, "inner_phase": of_inner, **values}


def merge(parts: Sequence[xarray.Dataset]) -> xarray.Dataset:
    """Return the files of all laws in one Dataset with the dimension law."""
    of_laws = xarray.concat([part[list(VARIABLES)] for part in parts], "law", join="exact")
    values = of_laws.assign(parts[0][list(COMMON_VARIABLES)])
    coordinates: dict[Any, Any] = {**parts[0].coords, **axes(law=[part.attrs["law"] for part in parts])}
    attributes = {name: parts[0].attrs[name] for name in ATTRIBUTES}
    return summary(TITLE, {**VARIABLES, **COMMON_VARIABLES}, values, coordinates, attributes, module=__name__)


def _outcomes(candidates: KnownAttractors, correlations: Sequence[float], labels: np.ndarray) -> dict[str, np.ndarray]:
    """Return the variables of the states from their labels, of shape (amplitude, phase_difference, state).

    correlations : of the velocities of the end blocks on each attractor
    """
    # The last entry is that of the label −1, undetermined.
    tables = {
        "branch": np.append(candidates.branch, UNDETERMINED),
        "side": np.append(candidates.side, 0),
        "velocity_correlation": np.append(correlations, np.nan),
    }
    values = {name: table[labels] for name, table in tables.items()}
    undetermined = (labels == UNDETERMINED).sum(axis=2)
    synchronized = (values["branch"] == 0).sum(axis=2)
    least, most = (_intervals(hits, labels.shape[2]) for hits in (synchronized, synchronized + undetermined))
    values |= dict(zip(("synchronized_fraction", "synchronized_low"), least[:2], strict=True))
    return {**values, "synchronized_high": most[2], "undetermined_count": undetermined}


def _intervals(hits: np.ndarray, count: int) -> np.ndarray:
    """Return fractions and the ends of their Wilson intervals, shape (3, *hits.shape)."""
    intervals = [fraction_interval(int(number), count) for number in hits.ravel()]
    return np.reshape(np.transpose(intervals), (3, *hits.shape))


def digest(data: xarray.Dataset) -> str:
    """Return the fraction of the initial phases that lead to synchrony, and the a where it is smallest and largest."""

    def sentence(part: xarray.Dataset) -> str:
        a = part["a"].values
        branch = part["branch"].transpose("a", ...).values.reshape(len(a), -1)
        share = (branch == 0).mean(axis=1)
        words = f"{100.0 * (branch == 0).mean():.1f} % of {branch.size} initial states synchronize"
        if share.min() < share.max():
            low, high = share.argmin(), share.argmax()
            words += f", from {100.0 * share[low]:.1f} % at a = {a[low]:g} to {100.0 * share[high]:.1f} % at a = "
            words += f"{a[high]:g}"
        return f"{words}; {np.count_nonzero(branch < 0)} undetermined"

    return lines_of(data, ["law"], sentence)
