"""The synchronized orbit over (law, a), its stability, the branching orbits, and a comparison of the laws.

On this orbit the end blocks stop once in a period. Where it repels mirror-symmetric perturbations, synchronized motion
of another period may attract, and neither the transverse multiplier nor a_c says where synchrony is stable.

`multiplier` has six modes: the transverse one; the flow, whose multiplier 1 is computed as a check; two of
mirror-symmetric perturbations, the larger modulus first, the second 0 to rounding if all blocks stick at once; and two
that are 0 because blocks 1 and 3 stop. `branch_multiplier` leaves out the flow. The power law of the amplitude is
fitted to asymmetries up to v/100, with the next order in a − a_c.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.decoding import decode_flags
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import ANSWER, Answer, Variable, flag
from burridge_knopoff.laws import law_of
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.model.model import Model, at_recorded_a
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.flow import OrbitError, rate
from burridge_knopoff.periodic_orbits.known_orbits import KnownOrbits
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.pitchfork import branching_orbit
from burridge_knopoff.periodic_orbits.synchronized_bifurcations import (
    bifurcations_of,
    critical_a,
    critical_a_error,
    grazing_a,
    symmetric_period_doubling_a,
    transverse_slope,
)
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries import antiphase_orbit
from burridge_knopoff.summaries.amplitude import fit_power_law, sweep
from burridge_knopoff.summaries.orbit_flags import BifurcationSide, CriticalStability, OrbitStatus
from burridge_knopoff.summaries.sentences import lines_of, values_where

BLOCKS = 3
MODES = ("transverse", "flow", "symmetric_1", "symmetric_2", "stick_1", "stick_2")
PARTS = ("real", "imaginary")
DIRECTIONS = ("upward", "downward")

#: Asymmetries x_1 − x_3 of the branching orbits, in units of v, and the largest one in the fit of the amplitude law.
ASYMMETRIES = tuple(float(f"{10 ** (k / 5 - 3):.3e}") for k in range(13))
LARGEST_FITTED = 1.0e-2

#: Distances from a_c of the runs of upward and downward sweeps, for the paper's springs and thresholds.
OFFSETS = (-2e-3, -1e-3, 1e-3, 2e-3, 4e-3, 8e-3, 1.6e-2)

#: What happens at a_c, in words.
CHANGES = {
    CriticalStability.UNDETERMINED: "the transverse multiplier of the synchronized orbit reaches the unit circle at "
    "a = {}",
    CriticalStability.UNSTABLE: "the synchronized orbit, unstable within synchrony, changes its transverse stability "
    "at a = {}: no end of synchrony",
    CriticalStability.LOST: "the synchronized orbit loses its transverse stability at a = {}",
    CriticalStability.GAINED: "the synchronized orbit gains its transverse stability at a = {}",
}

_CURVE = ("law", "a")
_BRANCH = ("law", "branch_asymmetry")
VARIABLES = {
    "status": Variable(_CURVE, "i1", "whether the synchronized orbit was found", flag("i1", OrbitStatus)),
    "period": Variable(_CURVE, "f8", "period T of the synchronized orbit"),
    "residual": Variable(
        _CURVE, "f8", "residual: largest difference between the state and its return after one period"
    ),
    "lateral_slip_time": Variable(_CURVE, "f8", "slip time T_s of blocks 1 and 3: in a period"),
    "center_stick_time": Variable(_CURVE, "f8", "stick time of block 2: in a period"),
    "transverse_multiplier": Variable(_CURVE, "f8", "Floquet multiplier mu of x_1 - x_3"),
    "multiplier": Variable((*_CURVE, "mode", "part"), "f8", "Floquet multipliers"),
    "attracts_within_synchrony": Variable(
        _CURVE, "i1", "attracts within synchrony: whether mirror-symmetric perturbations of the orbit decay", ANSWER
    ),
    "critical_a": Variable(("law",), "f8", "a_c, at which |mu| reaches 1"),
    "critical_stability": Variable(
        ("law",),
        "i1",
        "stability at a_c: as a grows; unstable on both sides if the orbit repels mirror-symmetric perturbations there",
        flag("i1", CriticalStability),
    ),
    "critical_a_error": Variable(
        ("law",), "f8", "error of a_c: change if mu is computed from finite differences of the flow"
    ),
    "grazing_a": Variable(("law",), "f8", "a at which block 2 begins to stick"),
    "symmetric_period_doubling_a": Variable(
        ("law",), "f8", "a of symmetric period doubling: at which a multiplier of symmetric perturbations reaches -1"
    ),
    "bifurcation_kind": Variable(
        ("law",), "i1", "bifurcation at a_c: from the sign of mu there", flag("i1", BifurcationKind)
    ),
    "bifurcation_side": Variable(("law",), "i1", "side of a_c with branching orbits", flag("i1", BifurcationSide)),
    "branch_offset": Variable(_BRANCH, "f8", "offset a - a_c: at which the asymmetric orbit exists"),
    "branch_period": Variable(_BRANCH, "f8", "period of the asymmetric orbit"),
    "branch_residual": Variable(
        _BRANCH, "f8", "residual: largest difference between the state and its return after one period"
    ),
    "branch_multiplier": Variable(_BRANCH, "f8", "largest modulus of a multiplier: of the asymmetric orbit"),
    "branch_mean_distance": Variable(_BRANCH, "f8", "<J> of the asymmetric orbit: over a period"),
    "amplitude_exponent": Variable(
        ("law",), "f8", "exponent of the amplitude: of a power law fitted to |x_1 - x_3| over a - a_c"
    ),
    "amplitude_exponent_error": Variable(
        ("law",),
        "f8",
        "error of the exponent: standard error, change with the range of a, and error of a_c",
        {"comment": "the fit has the next order of the expansion in a - a_c"},
    ),
    "amplitude_coefficient": Variable(("law",), "f8", "coefficient of that power law"),
    "amplitude_coefficient_error": Variable(("law",), "f8", "error of the coefficient: as that of the exponent"),
    "sweep_asymmetry": Variable(
        ("law", "direction", "sweep_offset"),
        "f8",
        "|x_1 - x_3| in a sweep: in the runs of a sweep of a through a_c, NaN if the orbit is unstable on both sides",
    ),
    "hysteresis": Variable(
        ("law",), "f8", "hysteresis: largest difference of |x_1 - x_3| between the upward and downward sweeps"
    ),
}

#: Differences between the paper's second law at a and the first law at the same slope; only in studies with both.
COMPARISON = {
    "effective_a": Variable(
        ("a",), "f8", "effective a: minus the slope of the nonlinear law at the driver velocity, a / (1 + a v)^2"
    ),
    "effective_period_difference": Variable(
        ("a",),
        "f8",
        "difference of the periods: that of the nonlinear law at a minus that of the linearized law at effective_a",
    ),
    "effective_multiplier_difference": Variable(
        ("a",), "f8", "difference of mu: that of the nonlinear law at a minus that of the linearized law at effective_a"
    ),
    "effective_critical_a_difference": Variable(
        (), "f8", "difference of a_c: effective_a of the nonlinear a_c minus the linearized a_c"
    ),
    "effective_grazing_a_difference": Variable(
        (), "f8", "difference of grazing_a: effective_a of the nonlinear grazing_a minus the linearized grazing_a"
    ),
    **antiphase_orbit.VARIABLES,
}
_COORDINATES = {
    "mode": Variable(("mode",), "O", "Floquet mode", coordinate=True),
    "branch_asymmetry": Variable(_BRANCH[1:], "f8", "x_1 - x_3 while both stick", coordinate=True),
    "direction": Variable(("direction",), "O", "direction of the sweep of a", coordinate=True),
    "sweep_offset": Variable(("sweep_offset",), "f8", "a - a_c of the runs of a sweep", coordinate=True),
}


def summarize(models: Sequence[Model], grid: Sequence[float]) -> xarray.Dataset:
    """Return the Dataset of the synchronized orbits of a chain of three blocks; other chains have none.

    models : one for each law, at any a, with the same chain, driver velocity and contact
    grid : values of a; the bifurcations do not depend on them
    """
    v, contact = models[0].v, models[0].contact
    asymmetry = v * np.array(ASYMMETRIES)
    laws = [model.law.name for model in models]
    coordinates = _coordinates(laws, grid, asymmetry)
    sizes = {name: len(coordinates[name][1]) for name in coordinates}
    pair = [model for law in PAPER_LAWS for model in models if model.law == law_of(law, a=recorded_a(model.law))]
    variables = {**VARIABLES, **(COMPARISON if len(pair) == len(PAPER_LAWS) else {})}
    values: dict[str, Any] = {
        name: np.full([sizes[dimension] for dimension in item.dimensions], -1 if item.dtype == "i1" else np.nan)
        for name, item in variables.items()
    }
    orbits: dict[str, KnownOrbits | None] = {}
    for i, model in enumerate(models):
        orbits[laws[i]] = _orbits_of_model(at_recorded_a(model, grid[-1]))
        _fill_curve(values, i, model, orbits[laws[i]], grid)
        _fill_transition(values, i, orbits[laws[i]], asymmetry)
    if len(pair) == len(PAPER_LAWS):
        _compare(values, laws, pair[1], orbits[PAPER_LAWS[0]], grid)
        if models[0].blocks == BLOCKS:
            differences = [antiphase_orbit.antiphase_differences(pair[0], pair[1], float(a)) for a in grid]
            values.update(zip(antiphase_orbit.VARIABLES, np.transpose(differences), strict=True))
    return summary(
        "The synchronized orbit of three blocks, its Floquet multipliers and its loss of stability",
        variables,
        values,
        coordinates,
        {"history": "snakemake, from the equations of motion", "v": v, "contact": contact},
        module=__name__,
    )


def _coordinates(laws: Sequence[str], grid: Sequence[float], asymmetry: np.ndarray) -> dict[str, Any]:
    return axes(
        _COORDINATES,
        law=laws,
        a=grid,
        mode=MODES,
        part=PARTS,
        branch_asymmetry=asymmetry,
        direction=DIRECTIONS,
        sweep_offset=OFFSETS,
    )


def _orbits_of_model(model: Model) -> KnownOrbits | None:
    """Return the synchronized orbits of a model; None, with a line in the log, if there are none."""
    try:
        # Variables and modes are defined for three blocks.
        return synchronized_orbits(model) if model.blocks == BLOCKS else None
    except OrbitError as error:
        print(f"{model.law.name}: {error}")
        return None


def _fill_curve(
    values: dict[str, Any], i: int, model: Model, orbits: KnownOrbits | None, grid: Sequence[float]
) -> None:
    """Fill in the orbits along the grid for the i-th law."""
    for k, a in enumerate(grid):
        values["status"][i, k] = OrbitStatus.NOT_FOUND if model.blocks == BLOCKS else OrbitStatus.NOT_THREE_BLOCKS
        if model.blocks == BLOCKS and _has_constant_friction(at_recorded_a(model, a)):
            values["status"][i, k] = OrbitStatus.NEUTRAL
        if orbits is None or ("a" in model.law.names and a == 0.0):
            continue
        try:
            orbit = orbits.at(a)
        except OrbitError as error:
            print(f"{model.law.name}: {error}")
            continue
        values["status"][i, k] = OrbitStatus.FOUND
        values["period"][i, k] = orbit.period
        values["residual"][i, k] = orbit.residual
        values["lateral_slip_time"][i, k] = orbit.period - orbit.stick_time(0)
        values["center_stick_time"][i, k] = orbit.stick_time(1)
        try:
            values["attracts_within_synchrony"][i, k] = multipliers(orbit).attracts_within_synchrony
        except OrbitError as error:
            print(f"{model.law.name}: {error}")
            continue
        # Without stops a perturbation of x_1 − x_3 has two multipliers.
        if not orbit.stop_counts[0]:
            continue
        spectrum = modes(orbit)
        values["transverse_multiplier"][i, k] = spectrum[0].real
        values["multiplier"][i, k] = np.stack([spectrum.real, spectrum.imag], axis=-1)


def modes(orbit: PeriodicOrbit) -> np.ndarray:
    """Return the multipliers of a synchronized orbit of three blocks in the order of MODES, complex.

    The multiplier of the flow is the component of the returned flow along the flow. Those of the velocities of blocks 1
    and 3 are 0, since these blocks stop.
    """
    spectrum, flow = multipliers(orbit), rate(orbit.model, orbit.reference)
    returned = flow @ orbit.monodromy @ flow / (flow @ flow)
    return np.array([spectrum.transverse, returned, *spectrum.symmetry_preserving[:2], 0.0, 0.0], dtype=complex)


def _has_constant_friction(model: Model) -> bool:
    """Return whether friction equals static friction at every speed."""
    law = model.law
    is_flat = (law.is_linear and law.initial_slope == 0.0) or not model.chain.weakenings.any()
    return is_flat and float(law(0.0)) == 1.0


def _fill_transition(values: dict[str, Any], i: int, orbits: KnownOrbits | None, asymmetry: np.ndarray) -> None:
    """Fill in the bifurcations of the orbit for the i-th law, and the branching orbits."""
    if orbits is None:
        return
    bifurcations = bifurcations_of(orbits)
    critical = critical_a(bifurcations)
    values["critical_a"][i] = critical
    values["grazing_a"][i] = grazing_a(bifurcations, block=1)
    values["symmetric_period_doubling_a"][i] = symmetric_period_doubling_a(bifurcations)
    if not np.isfinite(critical):
        return
    values["critical_a_error"][i] = critical_a_error(orbits, critical)
    kind = (
        BifurcationKind.PITCHFORK if transverse_multiplier(orbits, critical) > 0.0 else BifurcationKind.PERIOD_DOUBLING
    )
    values["bifurcation_kind"][i] = kind
    values["critical_stability"][i] = stability = critical_stability(orbits, critical)
    # Runs of a sweep would leave an orbit that is unstable on both sides.
    if stability != CriticalStability.UNSTABLE:
        runs = critical + orbits.model.chain.a_unit * np.array(OFFSETS)
        values["sweep_asymmetry"][i] = sweep(orbits, runs), sweep(orbits, runs[::-1])[::-1]
        values["hysteresis"][i] = np.abs(np.diff(values["sweep_asymmetry"][i], axis=0)).max()
    if kind == BifurcationKind.PITCHFORK:
        _fill_branch(values, i, orbits, critical, asymmetry)


def critical_stability(orbits: KnownOrbits, critical: float) -> CriticalStability:
    """Return how the stability of the synchronized orbit changes at a_c as a grows."""
    if not multipliers(orbits.at(critical)).attracts_within_synchrony:
        return CriticalStability.UNSTABLE
    slope = transverse_slope(orbits, critical)
    if np.isnan(slope):
        return CriticalStability.UNDETERMINED
    return CriticalStability.LOST if slope > 0.0 else CriticalStability.GAINED


def transverse_multiplier(orbits: KnownOrbits, a: float) -> float:
    """Return the transverse multiplier of the synchronized orbit at an a."""
    return multipliers(orbits.at(a)).transverse.real


def _fill_branch(values: dict[str, Any], i: int, orbits: KnownOrbits, critical: float, asymmetry: np.ndarray) -> None:
    """Fill in the orbits that branch off at a pitchfork, the side of a_c on which they exist, and the amplitude law."""
    orbit = None
    for k, d in enumerate(asymmetry):
        try:
            orbit = branching_orbit(orbits.at(critical), float(d), orbit)
        except OrbitError as error:
            print(f"{orbits.model.law.name}: {error}")
            continue
        values["branch_offset"][i, k] = orbit.a - critical
        values["branch_period"][i, k] = orbit.period
        values["branch_residual"][i, k] = orbit.residual
        values["branch_multiplier"][i, k] = round(float(abs(multipliers(orbit).whole[0])), 8)
        values["branch_mean_distance"][i, k] = orbit.mean_distance
    small = np.array(ASYMMETRIES) <= LARGEST_FITTED
    offset = values["branch_offset"][i, small]
    if (offset > 0.0).all() or (offset < 0.0).all():
        unstable = transverse_multiplier(orbits, critical + float(offset[-1])) > 1.0
        values["bifurcation_side"][i] = BifurcationSide.SUPERCRITICAL if unstable else BifurcationSide.SUBCRITICAL
        fit = fit_power_law(np.abs(offset), asymmetry[small], values["critical_a_error"][i])
        values["amplitude_exponent"][i] = fit.exponent
        values["amplitude_exponent_error"][i] = fit.error
        values["amplitude_coefficient"][i] = fit.coefficient
        values["amplitude_coefficient_error"][i] = fit.coefficient_error


def _compare(
    values: dict[str, Any], laws: Sequence[str], other: Model, first: KnownOrbits | None, grid: Sequence[float]
) -> None:
    """Fill in the differences between the paper's second law at a and the first law at the same slope.

    other : a model under the second law; first : the orbits under the first law, whose slope is −a at every speed
    """
    first_row, other_row = (laws.index(law) for law in PAPER_LAWS)
    values["effective_a"] = np.array([effective_a(other, a) for a in grid])
    for name in ("critical_a", "grazing_a"):
        values[f"effective_{name}_difference"] = effective_a(other, values[name][other_row]) - values[name][first_row]
    if first is None:
        return
    for k, a in enumerate(values["effective_a"]):
        try:
            orbit = first.at(float(a))
        except OrbitError:
            continue
        values["effective_period_difference"][k] = values["period"][other_row, k] - orbit.period
        difference = values["transverse_multiplier"][other_row, k] - multipliers(orbit).transverse.real
        values["effective_multiplier_difference"][k] = difference


def effective_a(model: Model, a: float) -> float:
    """Return minus the slope of a model's law, at this a, at the velocity of the driver; NaN for NaN."""
    return a if np.isnan(a) else -float(at_recorded_a(model, float(a)).law.slope(model.v))


def digest(data: xarray.Dataset) -> str:
    """Return where the synchronized orbit attracts within synchrony, and how its stability changes at a_c."""
    a = data["a"].values

    def sentence(part: xarray.Dataset) -> str:
        if (part["status"].values == OrbitStatus.NOT_THREE_BLOCKS).any():
            return "not computed, as the chain has not three blocks"
        critical, grazing = part["critical_a"].item(), part["grazing_a"].item()
        words = ["no a was found at which the transverse multiplier of the synchronized orbit reaches the unit circle"]
        if np.isfinite(critical):
            kind = BifurcationKind(part["bifurcation_kind"].item())
            side = decode_flags(part["bifurcation_side"]).item()
            how = f"{side} {kind.words}" if side != "undetermined" else kind.words
            words = [CHANGES[CriticalStability(part["critical_stability"].item())].format(f"{critical:.10g} ({how})")]
        if np.isfinite(grazing):
            words.append(f"block 2 begins to stick at a = {grazing:.10g}")
        if (repels := part["attracts_within_synchrony"].values == Answer.NO).any():
            words.append(f"it repels mirror-symmetric perturbations {values_where(repels, a)}")
        return "; ".join(words)

    return lines_of(data, ["law"], sentence)
