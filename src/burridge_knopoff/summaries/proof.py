"""What is proved of the synchronized orbit: its existence, its multipliers, and where it is lost.

The numbers are enclosures: ends between which the true value lies, whatever rounding did. See docs/synchronization.md.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import xarray
from flint import arb, fmpq

from burridge_knopoff.dataset.summary import summary
from burridge_knopoff.dataset.variables import Variable
from burridge_knopoff.model.model import Model
from burridge_knopoff.proof.balls import BITS, ProofError, arithmetic, decimal, digits, limits, width
from burridge_knopoff.proof.critical import Critical, Piece, prove_branch, prove_critical
from burridge_knopoff.proof.orbit import PLACES, ProvedOrbit, prove_orbit
from burridge_knopoff.proof.scope import is_covered
from burridge_knopoff.stability.family import Family
from burridge_knopoff.stability.transition import critical_a

#: Number of blocks of the chain.
CHAIN_BLOCKS = 3
#: The friction parameter of the orbit that is proved besides the critical one, as a fraction: the paper's 0.08.
GIVEN = (8, 100)
#: Ends of the range of a in which a_c is shown to be the only one.
RANGE = ((8, 100), (10, 100))
#: At this v the proofs are guessed by a simulation; they do not contain v.
GUESSED_AT = 0.1
#: The interval of a_c is narrower than this.
NARROW = 1e-15

ORBITS = ("given", "critical")
END = ("low", "high")
EVENTS = ("lateral_start", "lateral_stop", "center_stop", "center_start")
MODES = ("transverse", "symmetric")
BLOCKS = (1, 2)

#: What the proof takes for granted.
ASSUMED = (
    "Assumed: the model of docs/model.md, with the linearized law and the chain of the paper; v is only a scale.",
    "Shown by hand, in docs/synchronization.md: mirror-symmetric motion stays so; its closed forms; what stops and",
    "starts do to perturbations. Taken for granted: Arb's balls hold what they say, and the machine computes as told.",
)

_ORBIT = ("orbit", "end")
VARIABLES = {
    "critical_a": Variable(("end",), "f8", "a_c, at which the transverse multiplier mu is 1"),
    "critical_a_digits": Variable((), "O", "a_c with all digits, and how far it may be off"),
    "critical_a_width": Variable((), "f8", "width of the interval of those digits"),
    "only_between": Variable(("end",), "f8", "range of a in which the orbit exists and mu is 1 at a_c only"),
    "pieces": Variable((), "i4", "balls of a that cover that range"),
    "a": Variable(_ORBIT, "f8", "friction parameter a of an orbit"),
    "period": Variable(_ORBIT, "f8", "period T"),
    "event_time": Variable(
        ("orbit", "event", "end"), "f8", "time of an event since the first start of the period, when block 2 starts"
    ),
    "position": Variable(("orbit", "block", "end"), "f8", "U - v tau - e of blocks 1 and 2 at that first start"),
    "multiplier": Variable(("orbit", "mode", "end"), "f8", "Floquet multipliers that are not 0, but that of the flow"),
    "multiplier_slope": Variable(_ORBIT, "f8", "d mu/d a, of the transverse one"),
    "least_friction": Variable(("orbit",), "f8", "lower bound of the friction on slipping blocks"),
    "least_spring_force": Variable(("orbit",), "f8", "lower bound of the spring force on blocks that stick"),
}
_COORDINATES = {
    "orbit": (ORBITS, "O", "orbit: at the given a, or at a_c"),
    "end": (END, "O", "end of the interval that holds the number"),
    "event": (EVENTS, "O", "event of a period: blocks 1 and 3 are lateral, block 2 is the center"),
    "mode": (MODES, "O", "Floquet mode"),
    "block": (BLOCKS, "i4", "number of the block"),
}


def summarize(model: Model) -> xarray.Dataset:
    """Return the Dataset of what is proved of a model of the paper's chain under its linearized law, at any a.

    Raises ProofError, one line, for another model, and where a proof fails.
    """
    if not is_covered(model):
        raise ProofError(f"law {model.law.name}: not covered: the paper's linearized law and chain of 3 blocks")
    family = Family(replace(model, v=GUESSED_AT, contact="one_sided"))
    given = prove_orbit(family.at(GIVEN[0] / GIVEN[1]), decimal(*GIVEN))
    critical = prove_critical(family.at(critical_a(family)))
    low, high = (fmpq(*end) for end in RANGE)
    branch = prove_branch(family.at(RANGE[0][0] / RANGE[0][1]), low, high)
    _check(model, given, critical, branch)
    values: dict[str, Any] = {
        "critical_a": limits(critical.a),
        "critical_a_digits": digits(critical.a),
        "critical_a_width": width(critical.a),
        "only_between": [end[0] / end[1] for end in RANGE],
        "pieces": len(branch),
    }
    each = [_of_orbit(orbit, model) for orbit in (given, critical.orbit)]
    values |= {name: [one[name] for one in each] for name in each[0]}
    return summary(
        "What is proved of the synchronized orbit of three blocks, as intervals that hold the true numbers",
        VARIABLES,
        values,
        {
            name: (name, np.array(named, dtype=dtype), Variable((name,), dtype, long_name).all_attributes())
            for name, (named, dtype, long_name) in _COORDINATES.items()
        },
        {
            "history": "snakemake, from the equations of motion",
            "law": model.law.name,
            "v": model.v,
            "contact": model.contact,
            "bits": BITS,
        },
        module=__name__,
    )


def _check(model: Model, given: ProvedOrbit, critical: Critical, branch: list[Piece]) -> None:
    """Prove what is left: the family has both orbits, stuck blocks hold, the given orbit attracts, a_c is narrow.

    Raises ProofError, one line, if that fails.
    """
    branch[0].check_holds(given.enclosure, arb(fmpq(*GIVEN)))
    for piece in branch:
        if piece.orbit.a.overlaps(critical.a):
            piece.check_holds(critical.orbit.enclosure, critical.a)
    low, high = (decimal(*end) for end in RANGE)
    if not low < critical.a < high:
        raise ProofError(f"a_c = {critical.a}: not in the range of a that is covered")
    if model.contact == "symmetric":
        for orbit in (given, critical.orbit, *(piece.orbit for piece in branch)):
            if not model.v * orbit.tightest() < 2:
                raise ProofError(f"a = {orbit.a}, v = {model.v!r}: stuck blocks are not known to hold a pull back")
    for orbit in (given, critical.orbit):
        if not abs(orbit.symmetric_multiplier) < 1:
            raise ProofError(f"a = {orbit.a}: symmetric perturbations are not known to fade")
    if not abs(given.multiplier) < 1:
        raise ProofError(f"a = {given.a}: transverse perturbations are not known to fade")
    if not width(critical.a) < NARROW:
        raise ProofError(f"a_c: an interval of width {width(critical.a)!r} is not allowed: below {NARROW!r}")


def _of_orbit(orbit: ProvedOrbit, model: Model) -> dict[str, Any]:
    """Return the variables over orbits, for one; raises ProofError if its events are others."""
    names = [f"{('lateral', 'center')[arc.ends]}_{'stop' if arc.slips[arc.ends] else 'start'}" for arc in orbit.arcs]
    if tuple(names) != EVENTS:
        raise ProofError(f"events: {', '.join(names)} is not allowed: {', '.join(EVENTS)}")
    with arithmetic():
        positions = [limits(model.v * place) for place in orbit.enclosure.inner[:PLACES]]
        friction = limits(1 - model.v * orbit.a * orbit.fastest())[0]
        force = limits(1 - model.v * orbit.tightest())[0]
    return {
        "a": limits(orbit.a),
        "period": limits(orbit.period),
        "event_time": [limits(time) for time in orbit.event_times],
        "position": positions,
        "multiplier": [limits(orbit.multiplier), limits(orbit.symmetric_multiplier)],
        "multiplier_slope": limits(orbit.slope),
        "least_friction": friction,
        "least_spring_force": force,
    }


def digest(dataset: xarray.Dataset) -> str:
    """Return the summary in words: what is proved, with its numbers, and what is assumed."""
    low, high = dataset["only_between"].values
    lines = [
        "Proved by Krawczyk's operator in ball arithmetic, and by bounds over whole arcs of the motion:",
        "",
        f"a_c = {dataset['critical_a_digits'].item()}",
        f"    lies between the doubles {_between(dataset['critical_a'])}.",
        f"    For every a from {low:g} to {high:g} there is a synchronized orbit, and each block stops once a period.",
        "    Its transverse multiplier mu rises with a: below 1 before a_c, 1 there and nowhere else, above 1 beyond.",
        f"    At a_c it passes 1 with d mu/d a between {_between(dataset['multiplier_slope'].sel(orbit='critical'))}.",
    ]
    for name, one in zip(("At a = 0.08, where the orbit attracts", "At a_c"), dataset["orbit"].values, strict=True):
        orbit = dataset.sel(orbit=one)
        lines += ["", f"{name}, these lie between"]
        lines += [f"    period              {_between(orbit['period'])}"]
        lines += [f"    {event:<19} {_between(orbit['event_time'].sel(event=event))}" for event in EVENTS]
        lines += [f"    mu, {mode:<15} {_between(orbit['multiplier'].sel(mode=mode))}" for mode in MODES]
        lines += ["    All other multipliers but that of the flow are 0. No block stops or starts in between."]
        friction, force = orbit["least_friction"].item(), orbit["least_spring_force"].item()
        lines += [f"    Friction is above {friction!r}, the spring force on stuck blocks above {force!r}."]
    lines += ["", *ASSUMED]
    return "\n".join(lines) + "\n"


def _between(ends: xarray.DataArray) -> str:
    """Return two ends with all digits of their doubles: rounding would make them ends of something else."""
    low, high = (float(end) for end in ends.values)
    return f"{low!r} and {high!r}"
