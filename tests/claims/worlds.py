"""Summaries of a world in which every statement of the paper is true: every claim should hold."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from functools import cache
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.continuation.branch_changes import Change
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.motion.kind import SYNCHRONOUS, MotionKind
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.paper import PAPER_LAWS as LAWS
from burridge_knopoff.summaries.judgement import excess, same_mean
from tests.grids import PAPER_MODELS
from tests.sections import AGREEMENT, MOTION

_, SYNCHRONIZED, PERIODIC, QUASIPERIODIC, CHAOTIC, *_ = MotionKind

# The grid is fine at the paper's edges of synchrony.
A = np.array(sorted([0.0, 0.0025, 0.0046, 0.084, *(round(0.005 * k, 3) for k in range(1, 61))]))
STATES = ("minus", "plus")
POINT = ("law", "initial", "a")
PAIR = ("other_law", "initial", "a")
PAIR_OF_STATES = ("chain", "other_law", "state", "a")
BLOCK = (*POINT, "block")
STATE = ("position", "velocity")
BLOCKS = np.array([1, 2, 3])
SYNCHRONY = (A >= 0.005) & (A <= 0.08)
# Kinds of motion of the runs, one row per state.
_PLUS = np.where(A > 0.1, CHAOTIC, QUASIPERIODIC)
KINDS = (np.where((A > 0.0) & (A < 0.1), SYNCHRONIZED, _PLUS), _PLUS)
MEANS = np.stack([np.where(SYNCHRONY, 0.0, 0.05), np.full(len(A), 0.14)])
CONFIG = {
    "v": 0.1,
    "contact": "one_sided",
    "start": "moving",
    "transient": 3000,
    "window": 7000,
    "motion": MOTION,
    **{key: PAPER_MODELS[key] for key in ("laws", "chain")},
    "initial": {name: {key: list(getattr(PAPER_STATES[name], key)) for key in STATE} for name in PAPER_STATES},
}

Summaries = dict[str, xarray.Dataset]

#: Selections from the summaries of the paper's world, which nothing alters.
_SELECTED: dict[Hashable, tuple[Any, object]] = {}


class World(Summaries):
    """Summaries of the paper's world, with read-only arrays; one that a test asks for is copied, to be altered."""

    def __getitem__(self, name: str) -> xarray.Dataset:
        if self.get(name) is _world().get(name):
            self[name] = _world()[name].copy(deep=True)
        return super().__getitem__(name)


def evidence(summaries: Summaries, **config: object) -> Evidence:
    """Return the summaries with the paper's setting, parts of which may be replaced."""
    if not isinstance(summaries, World):
        return Evidence(summaries, {**CONFIG, **config})
    is_altered = any(dataset is not _world().get(name) for name, dataset in summaries.items())
    return Evidence(dict(summaries), {**CONFIG, **config}, selected={**_SELECTED} if is_altered else _SELECTED)


def paper_world() -> Summaries:
    """Return all summaries; a test may alter them, see `World`."""
    return World(_world())


@cache
def _world() -> Summaries:
    world = {
        "mean_distance": _mean_distance(),
        "lyapunov": _lyapunov(),
        "bifurcation_diagram": _bifurcation(),
        "agreement": _dataset(
            {
                **_compared(PAIR, 1e-4 * MEANS),
                **dict.fromkeys(("section_distance", "event_order_time", "event_order_count"), (PAIR, 1.0)),
                "settled": (POINT, np.int8(1)),
                "mean_distance": (POINT, MEANS),
                "mean_distance_error": (POINT, 1e-5),
                "kind": (POINT, np.stack(KINDS).astype("i1")),
            },
            other_law=["nonlinear"],
        ).assign_attrs(synchronization_threshold=1e-6, **AGREEMENT),
        "attractors": _attractors(),
        "refined": _refined(),
        "rotation": _rotation(),
        "bifurcations": _bifurcations(),
        "phases": _phases(),
        "orbits": _dataset(
            {
                "critical_a": (("law",), [0.0801, 0.0802]),
                "critical_a_error": (("law",), 1e-9),
                "transverse_multiplier": (("law", "a"), 0.96),
                "period": (("law", "a"), 5.7),
                "antiphase_difference": (("a",), -0.2 * A**2),
                "antiphase_difference_fixed_av": (("a",), -0.02 * A),
            }
        ),
        "stick_slip": _dataset(
            {
                "stop_rate": (BLOCK, [0.1, 0.2, 0.1]),
                "cycle_time": (BLOCK, 2.5),
                "position_amplitude": (BLOCK, 0.2),
                "velocity_frequency": (BLOCK, [0.17, 0.34, 0.17]),
                "velocity_frequency_error": (BLOCK, 0.01),
                "velocity_correlation": (POINT, -0.9),
                "stop_jump": (POINT, 0.1),
                "start_jump": (POINT, 0.2),
            },
            block=BLOCKS,
        ),
        "equilibrium": _equilibrium(),
        "solvers": _solvers(),
        "two_blocks": _dataset(
            {
                **_compared(PAIR_OF_STATES, 1e-5),
                "margin": (PAIR_OF_STATES, -40.0),
                "section_period": (("chain", "law", "state", "a"), np.int16(0)),
                "mean_distance": (("chain", "law", "state", "a"), 0.14),
                "mean_distance_error": (("chain", "law", "state", "a"), 1e-5),
                "kind": (("chain", "law", "state", "a"), np.int8(QUASIPERIODIC)),
                "one_block_kind": (("law", "a"), np.int8(PERIODIC)),
                "one_block_stop_rate": (("law", "a"), 0.15),
            },
            chain=["train", "both_pulled"],
            other_law=["nonlinear"],
            state=np.arange(4),
            a=np.linspace(0.02, 0.4, 20).round(2),
        ).assign_attrs(
            synchronization_threshold=1e-6, **{f"agreement_{name}": value for name, value in AGREEMENT.items()}
        ),
    }
    for name, dataset in world.items():
        # All numbers differ, so that a judge that reads the wrong one is noticed. The friction of slow slips, which
        # differs from 1 in the sixth digit, stays.
        numbers = (key for key in dataset.data_vars if dataset[key].dtype == float and key != "window_least_friction")
        for values in (dataset[key].values for key in numbers):
            if name != "equilibrium":
                values *= np.linspace(1.0, 1.001, values.size).reshape(values.shape)
    world = {"runs": _runs(world["mean_distance"], world["lyapunov"]), **world}
    count_sections(world)
    for variable in (variable for dataset in world.values() for variable in dataset.data_vars.values()):
        variable.values.flags.writeable = False
    return world


def count_sections(world: Summaries) -> None:
    """Determine the sections of the runs from their crossings; a run without any crossing did not complete."""
    crossings, runs = world["bifurcation_diagram"], world["runs"]
    velocity, upward = crossings["crossing_velocity"].values, crossings["crossing_direction"].values > 0
    place = tuple(runs.get_index(name).get_indexer(crossings[name].values) for name in POINT)
    shape = tuple(runs.sizes[name] for name in POINT)
    values = {name: np.full(shape, np.nan) for name in ("mean", "min", "max")}
    count, status = np.zeros(shape, "i4"), np.full(shape, Status.DIVERGED, "i1")
    ends = np.cumsum(crossings["crossing_count"].values)
    for *index, first, end in zip(*place, ends - crossings["crossing_count"].values, ends, strict=True):
        section = velocity[first:end][upward[first:end]]
        status[tuple(index)], count[tuple(index)] = Status.COMPLETED, len(np.unique(section))
        for name, value in values.items() if len(section) else ():
            value[tuple(index)] = getattr(section, name)()
    runs["status"], runs["section_count"] = (POINT, status), (POINT, count)
    for name, value in values.items():
        runs[f"section_velocity_{name}"] = POINT, value


def judge_means(world: Summaries) -> None:
    """Determine again whether ⟨J⟩ agrees, after a change of means or differences."""
    for name in ("agreement", "two_blocks"):
        if world.get(name) is _world()[name]:
            continue
        dataset = world[name]
        about = {key: dataset.attrs[key if name == "agreement" else f"agreement_{key}"] for key in AGREEMENT}
        synchronous = dataset["kind"].isin(SYNCHRONOUS).all("law")
        beyond = excess(dataset["difference"], dataset["mean_distance"].max("law", skipna=False), 1e-6, about)
        same = same_mean(beyond, dataset["difference_error"], synchronous, about)
        dataset["same_mean_distance"].values[...] = same.transpose(*dataset["difference"].dims)


def _runs(mean_distance: xarray.Dataset, lyapunov: xarray.Dataset) -> xarray.Dataset:
    """Return the scalars of runs of these mean distances, exponents and periods."""
    kept = ["lyapunov_exponent", "lyapunov_error", "lyapunov_infinite_count"]
    repetition = {"repetition_points": lyapunov["section_period"], "repetition_period": lyapunov["period"]}
    runs = mean_distance.drop_vars("synchronized").assign(lyapunov[kept]).assign(repetition).copy(deep=True)
    runs["repetition_divergence"] = xarray.zeros_like(runs["mean_distance"])
    for name, value in (("mirror_symmetric", 1), ("event_count", 100)):
        runs[name] = xarray.full_like(runs["status"], value)
    runs["window_least_spring_force"] = xarray.full_like(runs["mean_distance"], 0.1)
    return runs.assign_coords(v=0.1)


def _dataset(variables: dict, **coordinates: object) -> xarray.Dataset:
    """Return a Dataset of variables over named dimensions; values are broadcast along the leading ones."""
    known = {"law": list(LAWS), "initial": list(STATES), "a": A, **coordinates}
    used = {name for dimensions, _ in variables.values() for name in dimensions}
    sizes = {name: len(values) for name, values in {"exponent": range(3), "attractor": range(3), **known}.items()}
    data = {
        name: (dimensions, np.array(np.broadcast_to(values, [sizes[dimension] for dimension in dimensions])))
        for name, (dimensions, values) in variables.items()
    }
    return xarray.Dataset(data, {name: values for name, values in known.items() if name in used or name not in POINT})


def _compared(pair: tuple[str, ...], difference: object) -> dict:
    """Return the variables of laws that agree."""
    return {
        "agrees": (pair, np.int8(1)),
        "same_kind": (pair, np.int8(1)),
        "same_mean_distance": (pair, np.int8(1)),
        "difference": (pair, difference),
        "difference_error": (pair, 1e-6),
        "parting_a": (pair[:-1], np.nan),
    }


def _mean_distance() -> xarray.Dataset:
    """Return slips whose speed over v grows with a, as (aU')² requires at a fixed velocity of the driver."""
    return _dataset(
        {
            "mean_distance": (POINT, MEANS),
            "mean_distance_error": (POINT, 1e-4),
            "synchronized": (POINT, (MEANS < 1e-6).astype("i1")),
            "least_friction": (POINT, 0.9),
            "window_least_friction": (POINT, 1.0 - A**2),
            "settling_time": ((*POINT, "level"), [100.0, 200.0, 1100.0, 2000.0, 3900.0]),
            "distance_rounding": (POINT, 1e-13),
            "status": (POINT, np.int8(0)),
        },
        level=[0.01, 0.001, 1e-6, 1e-9, 1e-12],
    )


def _lyapunov() -> xarray.Dataset:
    exponent = np.zeros((len(A), 3))
    exponent[:, 0] = np.where(A > 0.1, 0.05, 1e-5)
    return _dataset(
        {
            "run_kind": (POINT, np.stack(KINDS).astype("i1")),
            "mean_distance": (POINT, MEANS),
            "period": (POINT, np.stack([np.where(A < 0.1, 7.5, np.nan), np.full(len(A), np.nan)])),
            "section_period": (POINT, np.stack([A < 0.1, np.zeros(len(A))]).astype("i2")),
            "lyapunov_exponent": ((*POINT, "exponent"), exponent),
            "lyapunov_error": ((*POINT, "exponent"), 1e-4),
            "lyapunov_infinite_count": (POINT, np.int16(0)),
            "status": (POINT, np.int8(0)),
        }
    )


def _bifurcation() -> xarray.Dataset:
    """Return a hundred section points for each law, initial state and a: one for minus, a cloud below it for plus.

    Above 0.1 the cloud reaches up to it.
    """
    law, initial, a = (part.ravel() for part in np.meshgrid(LAWS, STATES, A, indexing="ij"))
    cloud = np.where(a[:, None] > 0.1, np.linspace(0.2, 0.5, 100), np.linspace(0.2, 0.4, 100))
    velocity = np.where(initial[:, None] == "plus", cloud, 0.5)
    return xarray.Dataset(
        {
            "crossing_velocity": ("crossing", velocity.ravel()),
            "crossing_direction": ("crossing", np.ones(velocity.size, "i1")),
            "crossing_count": ("point", np.full(len(a), 100, "i4")),
        },
        {"law": ("point", law), "initial": ("point", initial), "a": ("point", a)},
    )


def _attractors() -> xarray.Dataset:
    """Return three attractors at each a: synchrony, a second, which plus reaches, and a third; only one above 0.1.

    minus reaches the third where it does not synchronize, and the second above 0.1.
    """
    slots = ("law", "a", "attractor")
    conventions = ("law", "contact", "start", "initial", "a")
    branch = np.array([np.select([SYNCHRONY, A < 0.1], [0, 2], 1), A * 0 + 1], "i2")
    kind = [np.full(len(A), SYNCHRONIZED), np.where(A > 0.1, CHAOTIC, QUASIPERIODIC), np.full(len(A), PERIODIC)]
    return _dataset(
        {
            "branch": (slots, np.array([0, 1, 2], "i2")),
            "side": (slots, np.int8(0)),
            "kind": (slots, np.stack(kind, axis=1).astype("i1")),
            "mean_distance": (slots, [0.0, 0.14, 0.1]),
            "mean_distance_error": (slots, 1e-5),
            "period": (slots, [7.5, np.nan, 7.5]),
            "basin_count": (slots, np.where(A[:, None] > 0.1, [0, 100, 0], 100).astype("i4")),
            "undetermined_count": (slots[:2], np.int32(0)),
            "basin_fraction": (slots, 0.5),
            "stop_rate": ((*slots, "block"), [0.17, 0.34, 0.17]),
            "section_count": (slots, np.array([1, 100, 1], "i4")),
            "section_velocity_mean": (slots, [0.5, 0.3, 0.5]),
            "velocity_correlation": (slots, [1.0, -0.9, -0.9]),
            "velocity_frequency": ((*slots, "block"), [0.17, 0.34, 0.17]),
            "initial_branch": (conventions, branch),
            "rounded_branch": (("law", "initial", "a", "corner"), np.repeat(branch[..., None], 2, axis=-1)),
            "initial_side": (conventions, np.int8(0)),
        },
        contact=["one_sided", "symmetric"],
        start=["moving", "tested"],
        corner=[0, 1],
        block=BLOCKS,
    ).assign_attrs(contact="one_sided", start="moving", resolution=1e-4, v=0.1)


def _refined() -> xarray.Dataset:
    """Return the second of the attractors at the values of the grid and, for the second law, at one inserted value."""
    rows = [A, np.sort(np.append(A, 0.1001))]
    a = np.full((2, len(A) + 1), np.nan)
    for law, row in enumerate(rows):
        a[law, : len(row)] = row
    slots = ("law", "value", "attractor")
    there = np.isfinite(a)[..., None]
    data = {
        "a": (slots[:2], a),
        "in_grid": (slots[:2], np.isin(a, A).astype("i1")),
        "branch": (slots, np.where(there, 1, -1).astype("i2")),
        "kind": (slots, np.where(there, np.where(a > 0.1, CHAOTIC, QUASIPERIODIC)[..., None], -1).astype("i1")),
        "period": (slots, np.full((*a.shape, 1), np.nan)),
    }
    depth = {"fraction_width": 0.02, "refine_resolution": 6e-4, "refine_longest_period": 500.0}
    return xarray.Dataset(data, {"law": list(LAWS)}, depth)


def _rotation() -> xarray.Dataset:
    """Return a plateau at 1/2 over all values of a of both laws, and end blocks that stay locked if detuned."""
    refined = _refined()
    there = np.isfinite(refined["a"].values)

    def detuned(values: Sequence[float]) -> np.ndarray:
        return np.where(there[..., None, None, None], np.ones((2, 3, 1)) * values, np.nan)

    axes = ("law", "value", "branch", "detuning")
    data = {
        "a": refined["a"],
        "in_grid": refined["in_grid"],
        "rotation_number": (("law", "value"), np.where(there, 0.5, np.nan)),
        "rotation_error": (("law", "value"), np.where(there, 1e-3, np.nan)),
        "locked": (("law", "value"), np.where(there, 1, -1).astype("i1")),
        "detuned_frequency": ((*axes, "block"), detuned([0.22, 0.34, 0.22])),
        "detuned_exponent": ((*axes, "exponent"), detuned([0.0, 0.0, -0.02])),
        "detuned_exponent_error": ((*axes, "exponent"), detuned([0.0005] * 3)),
        "detuned_mode_share": ((*axes, "mode"), detuned([0.2, 0.8, 0.0])),
        "detuned_end_ratio": (axes, detuned([1.0])[..., 0]),
        "detuned_end_phase": (axes, detuned([180.0])[..., 0]),
        "mode_end_ratio": (("detuning", "mode"), np.array([[1.1, -0.8, 0.9], [1.4, -0.5, 0.6], [3.0, -0.3, 0.2]])),
    }
    coordinates = {"law": list(LAWS), "branch": [1, 2], "detuning": [0.1, 0.3, 0.8], "block": BLOCKS}
    return xarray.Dataset(data, coordinates, {"detuned_transient": 4000.0, "detuned_window": 4000.0})


def _bifurcations() -> xarray.Dataset:
    """Return twelve bifurcations of each law at which a locked orbit becomes chaotic at a grazing."""
    columns = {
        "law": np.repeat(LAWS, 12),
        "kind": 0,
        "motion_before": PERIODIC,
        "motion_after": CHAOTIC,
        "from_branch": 1,
        "to_branch": 1,
    }
    # There `refined` has a torus, to which the orbit has locked.
    low = np.tile(A[A <= 0.1][-12:], 2)
    columns |= {"change": Change.CHANGE, "grid_low": low, "grid_high": low + 0.002, "a": low + 0.001}
    columns |= {"turns": 0, "period": 34.3}
    values = {name: ("bifurcation", np.array(np.broadcast_to(value, 24))) for name, value in columns.items()}
    values["multiplier_beyond"] = ("bifurcation", "part"), np.tile([0.3, 0.0], (24, 1))
    return xarray.Dataset(values, attrs={"laws": " ".join(LAWS)})


def _phases() -> xarray.Dataset:
    """Return states that synchronize from phases up to 90° apart and end in antiphase from larger differences."""
    states = ("law", "a", "inner_share", "amplitude", "phase_difference", "state")
    opposite = np.array([False, False, True, True])[:, None]
    return _dataset(
        {
            "branch": (states, np.where(opposite, 2, 0).astype("i2")),
            "velocity_correlation": (states, np.where(opposite, -0.9, 1.0)),
            "slipping_amplitude": (("inner_share",), [0.07, 0.07, 0.05]),
        },
        inner_share=[0.0, 0.3, 1.0],
        amplitude=[0.01, 0.05, 0.2],
        phase_difference=[15.0, 30.0, 150.0, 180.0],
        state=np.arange(1, 41),
    )


def _equilibrium() -> xarray.Dataset:
    """Return e = −(5/6, 2/3, 5/6)(1 − av) and the growth rate a, twice the true one; some eigenvalues are real."""
    pairs = np.stack(np.broadcast_arrays(A[:, None], [0.0, 0.0, 2.0, 2.0, 3.0, 3.0]), axis=-1)
    return _dataset(
        {
            "equilibrium_position": (("law", "a", "block"), -np.outer(1.0 - 0.1 * A, [5 / 6, 2 / 3, 5 / 6])),
            "equilibrium_drift": (("law", "a"), 1e-15),
            "eigenvalue": (("law", "a", "mode", "part"), pairs),
            "growth_rate": (("law", "a"), A),
            "strengthening_growth_rate": (("law", "a"), -A),
        },
        block=BLOCKS,
        part=["real", "imaginary"],
        mode=np.arange(1, 7),
    )


def _solvers() -> xarray.Dataset:
    axes = ("law", "solver", "initial", "a")
    found = _dataset(
        {
            "mean_distance": (axes, 0.14),
            "difference": (axes, 1e-7),
            "difference_error": (axes, 1e-5),
            "step_count": (axes, np.array([10_000, 20_000_000, 40_000_000])[:, None, None]),
            "end_time": (axes, 10_000.0),
            "status": (axes, np.int8(Status.COMPLETED)),
        },
        solver=["map", "series", "rk4"],
        a=[0.02, 0.05, 0.08],
    )
    # The map cannot treat the nonlinear law.
    found["step_count"].values[1, 0] = -1
    found["status"].values[1, 0] = -1
    found["difference"].values[1, 0] = np.nan
    return found
