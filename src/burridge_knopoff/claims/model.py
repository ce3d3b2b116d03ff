"""Claims on the model itself: the equilibrium and its stability, the sign of friction, the form of the solution."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from burridge_knopoff.claims.conventions import combine_readings
from burridge_knopoff.claims.evidence import Evidence, finite
from burridge_knopoff.claims.judge import judge
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    Measured,
    NotTestableError,
    Range,
    Verdict,
    describe_where,
    extremes,
    judge_value,
    worst_verdict,
)
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.study.formatting import span, with_error
from burridge_knopoff.study.paper import PAPER_LAWS

PARTS = ("real", "imaginary")


@judge("equilibrium")
def equilibrium_position(evidence: Evidence, law: str, coefficients: Sequence[float], tolerance: float) -> Verdict:
    """Judge the formula U_i − vτ = −c_i (1 − av) for the unstable equilibrium, with given c_i, at all a."""
    evidence.check_blocks()
    equilibrium = evidence.summary("equilibrium").sel(law=law)
    v = evidence.config["v"]
    formula = -np.outer(1.0 - equilibrium["a"].values * v, coefficients)
    difference = float(np.abs(equilibrium["equilibrium_position"].values - formula).max())
    drift = float(equilibrium["equilibrium_drift"].max())
    measured = [
        Measured("largest difference from the formula", difference),
        Measured("largest distance reached by a simulation started there", drift),
    ]
    verdict = HOLDS if difference <= tolerance and drift <= tolerance else FAILS
    reason = (
        f"The equilibrium differs from the formula by at most {difference:.1e}, and a simulation started there stays "
        f"within {drift:.1e}."
    )
    return Verdict(verdict, reason, measured)


@judge("equilibrium")
def equilibrium_unstable(evidence: Evidence, a: Range) -> Verdict:
    """Judge whether some eigenvalues of the Jacobian at uniform sliding are positive, under both laws.

    A positive eigenvalue is a positive number. For instability a positive real part is enough.
    """
    evidence.check_blocks()
    equilibrium = evidence.choose(evidence.summary("equilibrium"), a)
    readings: dict[str, list[str]] = {"an eigenvalue is a positive number": [], "it has a positive real part": []}
    measured: list[Measured] = []
    for law in PAPER_LAWS:
        found = equilibrium.sel(law=law)
        real, imaginary = (found["eigenvalue"].sel(part=part).transpose("a", "mode").values for part in PARTS)
        for of_laws, chosen in zip(readings.values(), ((real > 0.0) & (imaginary == 0.0), real > 0.0), strict=True):
            of_laws.append(HOLDS if chosen.any(axis=1).all() else FAILS)
        growth = real.max(axis=1)
        difference = float(np.abs(growth - found["growth_rate"].values).max())
        measured += [
            Measured(f"smallest of the largest real parts, {law}", float(growth.min())),
            Measured(f"smallest modulus of an imaginary part, {law}", float(np.abs(imaginary).min())),
            Measured(f"largest difference from the growth seen in simulations, {law}", difference),
        ]
    verdicts = {reading: worst_verdict(of_laws) for reading, of_laws in readings.items()}
    least, slowest = (min(item.value for item in measured[k::3]) for k in (0, 1))
    reason = (
        f"For {a} the largest real part is at least {least:.3g}, and the imaginary parts are at least {slowest:.3g} in "
        f"modulus: {'; '.join(f'{reading} ({verdict})' for reading, verdict in verdicts.items())}."
    )
    whole = evidence.summary("equilibrium")
    stable = (whole["eigenvalue"].sel(part="real").max(dim="mode") <= 0.0).any(dim="law").values
    return combine_readings(verdicts, reason, measured, describe_where("no growth", whole["a"].values, stable))


@judge("equilibrium")
def growth_rate(evidence: Evidence, law: str, claimed: float, tolerance: float, loose: float, a: Range) -> Verdict:
    """Judge the growth rate of perturbations of uniform sliding in units of −F'(v), the slope of friction at v."""
    evidence.check_blocks()
    found = evidence.choose(evidence.summary("equilibrium").sel(law=law), a)
    values = found["a"].values
    ratio = found["growth_rate"].values / evidence.weakening(law, values)
    measured = extremes("growth rate over −F'(v), in simulations", ratio)
    verdict = worst_verdict(judge_value(item.value, claimed, tolerance, loose) for item in measured)
    rate = with_error(float(ratio.mean()), float(np.ptp(ratio)))
    reason = f"For {a} ({law}) perturbations grow at {rate} times −F'(v); the paper says {claimed:g}."
    return Verdict(verdict, reason, measured)


@judge("equilibrium", "stick_slip")
def near_equilibrium(
    evidence: Evidence, initial: tuple[str, str], law: str, at: float, near: float, loose: float
) -> Verdict:
    """Judge whether the first block of one state starts close to its equilibrium, and that of another state does not.

    initial : the state that is close, the state that is not
    near, loose : close means up to this many amplitudes of the block in the motion reached from the first state, and
        loosely close up to that many
    """
    for name in initial:
        evidence.check_state(name)
    position = evidence.at(evidence.summary("equilibrium").sel(law=law), at)["equilibrium_position"].values
    run = evidence.at(evidence.state_summary("stick_slip", initial[0]).sel(law=law), at)
    amplitude = run["position_amplitude"].values[0]
    if not np.isfinite(amplitude):
        raise NotTestableError(f"the run from {initial[0]} at a = {at:g} under the {law} law did not complete")
    distances = [abs(PAPER_STATES[name].coordinates(3)[0][0] - position[0]) for name in initial]
    close, far = (distance / amplitude for distance in distances)
    verdict = FAILS if close > loose or far <= near else HOLDS if close <= near else LOOSELY
    measured = [
        Measured(f"|U₁(0) − U₁ᵉ|, {name}", float(value)) for name, value in zip(initial, distances, strict=True)
    ]
    measured.append(Measured(f"amplitude of block 1 in the motion from {initial[0]}", float(amplitude)))
    reason = (
        f"At a = {at:g} ({law}) the first block begins {distances[0]:.3f} from its equilibrium in {initial[0]} and "
        f"{distances[1]:.3f} in {initial[1]}; in the motion reached from {initial[0]} its amplitude is "
        f"{amplitude:.3f}."
    )
    return Verdict(verdict, reason, measured)


@judge("mean_distance")
def friction_keeps_sign(evidence: Evidence, initial: Sequence[str], law: str, a: Range) -> Verdict:
    """Judge whether the friction on a slipping block stays positive in every run."""
    least, where = np.inf, ""
    negative = []
    for state in initial:
        runs = evidence.choose(evidence.state_summary("mean_distance", state), a).sel(law=law)
        friction = runs["least_friction"].values
        if not len(finite(friction)):
            raise NotTestableError(f"no run from {state} completed with {a}")
        lowest = int(np.nanargmin(friction))
        if friction[lowest] < least:
            least, where = float(friction[lowest]), f"{state}, a = {runs['a'].values[lowest]:g}"
        negative += describe_where("not positive", runs["a"].values, friction <= 0.0, state)
    reason = f"The smallest friction on a slipping block for {a} ({law}) is {least:.3f}, in the run {where}."
    return Verdict(HOLDS if least > 0.0 else FAILS, reason, [Measured("smallest Φ(U')", least)], "; ".join(negative))


@judge("equilibrium")
def exponentials(evidence: Evidence, law: str, claimed: int, a: Range) -> Verdict:
    """Judge the number of exponentials in the solution while all blocks slip; complex pairs count loosely as one."""
    evidence.check_blocks()
    found = evidence.choose(evidence.summary("equilibrium").sel(law=law), a)["eigenvalue"]
    real, imaginary = (found.sel(part=part).values for part in PARTS)
    counts, pairs = (
        np.array([len({*zip(x.round(12), y.round(12), strict=True)}) for x, y in zip(real, part, strict=True)])
        for part in (imaginary, np.abs(imaginary))
    )
    measured = [
        *extremes("number of exponentials", counts),
        Measured("largest number of complex pairs", float(max(pairs))),
    ]
    verdict = HOLDS if (counts == claimed).all() else LOOSELY if (pairs == claimed).all() else FAILS
    reason = (
        f"For {a} a position has at most {max(counts)} exponentials, in {max(pairs)} complex pairs; "
        f"the paper says {claimed}."
    )
    return Verdict(verdict, reason, measured)


@judge("lyapunov", "equilibrium")
def map_dimension(evidence: Evidence, initial: Sequence[str], law: str, claimed: int, a: Range) -> Verdict:
    """Judge the dimension of the map from event to event; the claim holds loosely if some directions vanish.

    A state has two components per block: position relative to the driver, and velocity. Each Lyapunov exponent of −∞
    is a direction that sticking has removed permanently.
    """
    evidence.check_blocks()
    lost = np.concatenate(
        [
            finite(evidence.choose(evidence.state_summary("lyapunov", name), a)["lyapunov_infinite_count"].sel(law=law))
            for name in initial
        ]
    )
    # Without exponents the count is −1.
    lost = lost[lost >= 0.0]
    if not len(lost):
        raise NotTestableError(f"the Lyapunov exponents are not known with {a}")
    numbers = 2 * len(evidence.summary("equilibrium")["block"])
    left = numbers - lost
    measured = [
        Measured("components of a state", float(numbers)),
        *extremes("number of exponents of −∞", lost),
    ]
    verdict = FAILS if numbers != claimed else HOLDS if left.min() == claimed else LOOSELY
    removed, remaining = (span(f"{found.min():.0f}", f"{found.max():.0f}") for found in (lost, left))
    reason = (
        f"A state has {numbers} components. Sticking permanently removes {removed} of these dimensions ({law}), "
        f"so that the map acts on {remaining}."
    )
    return Verdict(verdict, reason, measured)


@judge("equilibrium")
def stable_where_friction_grows(evidence: Evidence, law: str, a: Range) -> Verdict:
    """Judge whether uniform sliding is stable in simulations if friction grows with velocity.

    Uses the mirror image of a law at the driver velocity: the same friction there, and the opposite slope.
    """
    evidence.check_blocks()
    found = evidence.choose(evidence.summary("equilibrium").sel(law=law), a)
    growth = found["strengthening_growth_rate"].values
    if not len(finite(growth)):
        raise NotTestableError(f"the mirror image of the {law} law is not a friction law with {a}")
    largest = float(np.nanmax(growth))
    words = f"decay at a rate of {-largest:.3g} or more" if largest < 0.0 else f"grow, at a rate of up to {largest:.3g}"
    reason = f"For {a} perturbations {words} if the slope of the {law} law is reversed."
    changes = "".join(describe_where("growth", found["a"].values, growth >= 0.0))
    return Verdict(HOLDS if largest < 0.0 else FAILS, reason, [Measured("largest growth rate", largest)], changes)
