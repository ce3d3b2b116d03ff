"""Proved statements on the synchronized orbit: its existence, its multipliers and its loss of stability.

The numbers are enclosures: the true value lies between their ends despite rounding. See docs/synchronization.md.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray
from flint import arb, fmpq

from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.periodic_orbits.synchronized_bifurcations import bifurcations_of, critical_a
from burridge_knopoff.proof.balls import BITS, ProofError, arithmetic, decimal, digits, limits, width
from burridge_knopoff.proof.critical import CriticalOrbit, Piece, prove_branch, prove_critical
from burridge_knopoff.proof.orbit import POSITIONS, ProvedOrbit, prove_orbit
from burridge_knopoff.proof.scope import NONLINEAR_V, is_covered, is_linearized
from burridge_knopoff.study.model import models_of

#: Number of blocks of the chain.
CHAIN_BLOCKS = 3
#: The paper's a = 0.08 as a fraction, at which an orbit is proved in addition to the critical one.
GIVEN_A = (8, 100)
#: Ends of the range of a over which the family of orbits is proved under the linearized law.
RANGE = ((8, 100), (10, 100))
#: Largest width of the interval of a_c.
LARGEST_WIDTH = 1e-15

ORBITS = ("given", "critical")
END = ("low", "high")
#: {event, in the order of a period: words for a text}
EVENTS = {
    "lateral_start": "end blocks start",
    "lateral_stop": "end blocks stop",
    "center_stop": "middle block stops",
    "center_start": "middle block starts",
}
MODES = ("transverse", "symmetric")
BLOCKS = (1, 2)

#: Assumptions of the proof.
ASSUMPTIONS = (
    "Assumed: the model of docs/model.md, with the laws and the chain of the paper. Linearized: v is only a scale.",
    "Nonlinear: v is the decimal. Shown by hand, in docs/synchronization.md: mirror-symmetric motion stays symmetric;",
    "the closed forms; the effect of stops and starts on perturbations. Taken for granted: Arb's balls contain the",
    "exact results, and the machine computes correctly.",
)

_LAW, _ORBIT = ("law", "end"), ("law", "orbit", "end")
VARIABLES = {
    "critical_a": Variable(_LAW, "f8", "a_c: at which the transverse multiplier mu is 1"),
    "critical_a_digits": Variable(("law",), "O", "a_c with all digits and its error bound"),
    "critical_a_width": Variable(("law",), "f8", "width of the interval of a_c: with all digits"),
    "only_between": Variable(
        _LAW,
        "f8",
        "range without another a_c: range of a in which a_c is the only a with mu = 1, for orbits near this one",
    ),
    "family_between": Variable(
        _LAW, "f8", "range with growing mu: range of a in which the orbit exists at every a and mu increases with a"
    ),
    "pieces": Variable(("law",), "i4", "number of balls: balls of a that cover that range"),
    "a": Variable(_ORBIT, "f8", "friction parameter a of an orbit"),
    "period": Variable(_ORBIT, "f8", "period T"),
    "event_time": Variable(
        ("law", "orbit", "event", "end"),
        "f8",
        "time of an event: after the start of block 2, the first event of the period",
    ),
    "position": Variable(
        ("law", "orbit", "block", "end"), "f8", "position of blocks 1 and 2: U - v tau - e at this start"
    ),
    "multiplier": Variable(
        ("law", "orbit", "mode", "end"), "f8", "Floquet multipliers: except those that are 0 and that of the flow"
    ),
    "multiplier_slope": Variable(_ORBIT, "f8", "derivative d mu/d a: of the transverse multiplier"),
    "least_friction": Variable(("law", "orbit"), "f8", "lower bound of friction: on slipping blocks"),
    "least_spring_force": Variable(("law", "orbit"), "f8", "lower bound of spring force: on stuck blocks"),
}
_COORDINATES = {
    "orbit": Variable(("orbit",), "O", "orbit: at the given a, or at a_c"),
    "end": Variable(("end",), "O", "end of the interval: that contains the number"),
    "event": Variable(("event",), "O", "event of a period: blocks 1 and 3 are lateral, block 2 is the center"),
    "mode": Variable(("mode",), "O", "Floquet mode"),
}


def prove(config: Mapping[str, Any]) -> xarray.Dataset:
    """Return the proofs under all laws of a config; errors as in `summarize`."""
    return summarize(models_of(config, GIVEN_A[0] / GIVEN_A[1], CHAIN_BLOCKS))


def summarize(models: Sequence[Model]) -> xarray.Dataset:
    """Return the Dataset of proved statements; models : of the paper's chain, one for each law, at any a.

    Raises ProofError, one line, for a model that is not covered, and if a proof fails.
    """
    proofs = [_law_values(model) for model in models]
    return summary(
        "Proved statements on the synchronized orbit of three blocks, as intervals that contain the true numbers",
        VARIABLES,
        {name: np.array([proof[name] for proof in proofs], dtype=item.dtype) for name, item in VARIABLES.items()},
        axes(
            _COORDINATES,
            law=[model.law.name for model in models],
            orbit=ORBITS,
            end=END,
            event=list(EVENTS),
            mode=MODES,
            block=BLOCKS,
        ),
        {
            "history": "snakemake, from the equations of motion",
            "v": models[0].v,
            "contact": models[0].contact,
            "bits": BITS,
        },
        module=__name__,
    )


def _law_values(model: Model) -> dict[str, Any]:
    """Return the variables for one law; raises ProofError as `summarize` does."""
    if not is_covered(model):
        raise ProofError(f"law {model.law.name}: not covered: the paper's laws and chain of {CHAIN_BLOCKS} blocks")
    # Only the initial guess comes from a simulation. Under the linearized law it is valid for every v.
    orbits = synchronized_orbits(replace(model, v=NONLINEAR_V, contact="one_sided"))
    attracting = prove_orbit(orbits.at(GIVEN_A[0] / GIVEN_A[1]), decimal(*GIVEN_A))
    critical = prove_critical(orbits.at(critical_a(bifurcations_of(orbits))))
    branch: list[Piece] = []
    between = np.nan, np.nan
    if is_linearized(model):
        low, high = (fmpq(*end) for end in RANGE)
        branch = prove_branch(orbits.at(RANGE[0][0] / RANGE[0][1]), low, high)
        _check_branch(attracting, critical, branch)
        between = RANGE[0][0] / RANGE[0][1], RANGE[1][0] / RANGE[1][1]
    _check(model, attracting, critical, branch)
    rows = [_orbit_values(orbit, model) for orbit in (attracting, critical.orbit)]
    return {
        "critical_a": limits(critical.a),
        "critical_a_digits": digits(critical.a),
        "critical_a_width": width(critical.a),
        "only_between": between if branch else _inner_limits(critical.uniqueness_range),
        "family_between": between,
        "pieces": len(branch),
        **{name: [row[name] for row in rows] for name in rows[0]},
    }


def _inner_limits(ball: arb) -> tuple[float, float]:
    """Return doubles that lie in a ball, next to its ends."""
    low, high = limits(ball)
    return float(np.nextafter(low, np.inf)), float(np.nextafter(high, -np.inf))


def _check_branch(attracting: ProvedOrbit, critical: CriticalOrbit, branch: Sequence[Piece]) -> None:
    """Prove that the family contains both orbits; raises ProofError, one line, if that fails."""
    branch[0].check_contains(attracting.enclosure, arb(fmpq(*GIVEN_A)))
    for piece in branch:
        if piece.orbit.a.overlaps(critical.a):
            piece.check_contains(critical.orbit.enclosure, critical.a)
    low, high = (decimal(*end) for end in RANGE)
    if not low < critical.a < high:
        raise ProofError(f"a_c = {critical.a}: not in the range of a that is covered")


def _check(model: Model, attracting: ProvedOrbit, critical: CriticalOrbit, branch: Sequence[Piece]) -> None:
    """Prove that stuck blocks stay stuck, that the given orbit attracts, and that the interval of a_c is narrow.

    Raises ProofError, one line, if that fails.
    """
    if model.contact == "symmetric":
        for orbit in (attracting, critical.orbit, *(piece.orbit for piece in branch)):
            if not model.v * orbit.force_margin_range() < 2:
                raise ProofError(
                    f"a = {orbit.a}, v = {model.v!r}: not proved that stuck blocks resist the backward pull"
                )
    for orbit in (attracting, critical.orbit):
        if not abs(orbit.symmetric_multiplier) < 1:
            raise ProofError(f"a = {orbit.a}: not proved that symmetric perturbations decay")
    if not abs(attracting.multiplier) < 1:
        raise ProofError(f"a = {attracting.a}: not proved that transverse perturbations decay")
    if not width(critical.a) < LARGEST_WIDTH:
        raise ProofError(f"a_c: got an interval of width {width(critical.a)!r}, expected below {LARGEST_WIDTH!r}")


def _orbit_values(orbit: ProvedOrbit, model: Model) -> dict[str, Any]:
    """Return the variables of one orbit; raises ProofError if its events differ from EVENTS."""
    names = [
        f"{('lateral', 'center')[arc.event_block]}_{'stop' if arc.slips[arc.event_block] else 'start'}"
        for arc in orbit.arcs
    ]
    if names != list(EVENTS):
        raise ProofError(f"events: got {', '.join(names)}, expected {', '.join(EVENTS)}")
    with arithmetic():
        positions = [limits(model.v * place) for place in orbit.enclosure.inner[:POSITIONS]]
        force = limits(1 - model.v * orbit.force_margin_range())[0]
    return {
        "a": limits(orbit.a),
        "period": limits(orbit.period),
        "event_time": [limits(time) for time in orbit.event_times],
        "position": positions,
        "multiplier": [limits(orbit.multiplier), limits(orbit.symmetric_multiplier)],
        "multiplier_slope": limits(orbit.slope),
        "least_friction": limits(orbit.friction_range(model.v))[0],
        "least_spring_force": force,
    }


def digest(dataset: xarray.Dataset) -> str:
    """Return the summary as text: the proved statements with their numbers, and the assumptions."""
    lines = ["Proved by Krawczyk's operator in ball arithmetic, and by bounds over whole arcs of the motion.", ""]
    for law in dataset["law"].values:
        lines += [*_law_lines(dataset.sel(law=law), f"{law} law"), ""]
    return "\n".join([*lines, *ASSUMPTIONS]) + "\n"


def _law_lines(dataset: xarray.Dataset, name: str) -> list[str]:
    """Return the lines on one law."""
    low, high = dataset["family_between"].values
    slope = dataset["multiplier_slope"].sel(orbit="critical")
    lines = [
        f"{name}: a_c = {dataset['critical_a_digits'].item()}",
        f"    lies between the doubles {_format_ends(dataset['critical_a'])}.",
        f"    It is the only a between {_format_ends(dataset['only_between'])} with mu = 1 on orbits near this one.",
        f"    There mu passes 1 with d mu/d a between {_format_ends(slope)}.",
    ]
    if np.isfinite(low):
        lines += [
            f"    For every a from {low:g} to {high:g} there is such an orbit; each block stops once a period.",
            "    Its transverse multiplier mu rises with a: below 1 before a_c, 1 there, above 1 beyond.",
        ]
    for title, label in zip(("At a = 0.08, where the orbit attracts", "At a_c"), dataset["orbit"].values, strict=True):
        orbit = dataset.sel(orbit=label)
        lines += ["", f"{name}: {title}, these lie between"]
        lines += [f"    period              {_format_ends(orbit['period'])}"]
        lines += [
            f"    {words:<19} {_format_ends(orbit['event_time'].sel(event=event))}" for event, words in EVENTS.items()
        ]
        lines += [f"    mu, {mode:<15} {_format_ends(orbit['multiplier'].sel(mode=mode))}" for mode in MODES]
        lines += ["    All other multipliers except that of the flow are 0. No block stops or starts in between."]
        friction, force = orbit["least_friction"].item(), orbit["least_spring_force"].item()
        lines += [f"    Friction is above {friction!r}, the spring force on stuck blocks above {force!r}."]
    return lines


def _format_ends(ends: xarray.DataArray) -> str:
    """Return both ends with all digits of their doubles: rounded ends would not enclose the interval."""
    low, high = (float(end) for end in ends.values)
    return f"{low!r} and {high!r}"
