"""Claims on the model itself: the equilibrium and its stability, the sign of friction, the form of the solution."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.choice import LooseTolerance, Near, Tolerance
from burridge_knopoff.claims.claim import claim
from burridge_knopoff.claims.conventions import combine_readings
from burridge_knopoff.claims.equations import equation_difference
from burridge_knopoff.claims.evidence import Evidence, finite
from burridge_knopoff.claims.range import POSITIVE, WEAKENING, Range
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    Measured,
    NotTestableError,
    Verdict,
    describe_where,
    extremes,
    join_words,
    judge_value,
    worst_verdict,
)
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.study.formatting import format_values, span, with_error
from burridge_knopoff.study.paper import PAPER_LAWS

if TYPE_CHECKING:
    import xarray

PARTS = ("real", "imaginary")


def format_range(dataset: xarray.Dataset) -> str:
    """Return the values of a of a summary as text: «at a = 0.0025 to 0.3»."""
    values = dataset["a"].values
    return format_values(values, np.ones(len(values), dtype=bool))


# Random states, units and friction at which the equations of motion are compared.
COMPARISONS = 100


@claim("Eqs. 1 and 2", "friction_laws")
def dimensionless_equations(evidence: Evidence, *, law: str = "nonlinear") -> Verdict:
    """In the units 1/ω of time and F(0)/k of position, Eq. 1 becomes Eq. 2, with v = V√(km)/F(0) and a = cF(0)/√(km).

    Holds if both are equal, in exact fractions, at a hundred random values of the state, the time and √k, √m, F(0), c
    and V. They are rational functions of these, of a few degrees, so that they are then the same.
    """
    evidence.check_blocks()
    differences = evidence.cached(
        "Eqs. 1 and 2",
        lambda: [equation_difference(Chain(3), np.random.default_rng(seed)) for seed in range(COMPARISONS)],
    )
    same = sum(difference == 0 for difference in differences)
    largest = float(max(differences))
    reason = f"Eq. 1 in these units is Eq. 2, in exact fractions, at {same} of {COMPARISONS} random states and units."
    return Verdict(HOLDS if same == COMPARISONS else FAILS, reason, [Measured("largest difference", largest)])


@claim("Results, below Eq. 5", "equilibrium", "equilibrium")
def equilibrium(
    evidence: Evidence,
    *,
    law: str = "linearized",
    coefficients: tuple[float, ...] = (0.8333333333333334, 0.6666666666666666, 0.8333333333333334),
    tolerance: Tolerance = 1e-10,
) -> Verdict:
    """The unstable equilibrium lies at vτ − 5(1 − av)/6, vτ − 2(1 − av)/3 and vτ − 5(1 − av)/6 (linearized law).

    Holds if no position differs by more than {tolerance:g}, and a simulation started there stays as near, at all a.

    U_i − vτ = −c_i (1 − av); coefficients : c_i
    """
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


@claim("Results", "equilibrium", "equilibrium")
def equilibrium_unstable(evidence: Evidence, *, a: Range = WEAKENING) -> Verdict:
    """As long as friction decreases with velocity, some eigenvalues of the stability matrix of uniform motion are
    positive.

    Holds if the largest real part is positive at every a > 0, under both laws.

    A positive eigenvalue of a real matrix with complex pairs is one with a positive real part, as is usual where
    stability is meant. The eigenvalues follow from the springs and from F'(v) alone, whatever the grid of a.
    """
    evidence.check_blocks()
    equilibrium = evidence.choose(evidence.summary("equilibrium"), a)
    verdicts, measured, are_complex = [], [], True
    for law in PAPER_LAWS:
        sliding = equilibrium.sel(law=law)
        real, imaginary = (sliding["eigenvalue"].sel(part=part).transpose("a", "mode").values for part in PARTS)
        verdicts.append(HOLDS if (real > 0.0).any(axis=1).all() else FAILS)
        are_complex &= bool((imaginary != 0.0).all())
        growth = real.max(axis=1)
        difference = float(np.abs(growth - sliding["growth_rate"].values).max())
        measured += [
            Measured(f"smallest of the largest real parts, {law}", float(growth.min())),
            Measured(f"smallest modulus of an imaginary part, {law}", float(np.abs(imaginary).min())),
            Measured(f"largest difference from the growth seen in simulations, {law}", difference),
        ]
    least, slowest = (min(item.value for item in measured[k::3]) for k in (0, 1))
    reason = f"The largest real part is at least {least:.3g} {format_range(equilibrium)}."
    if are_complex:
        reason += f" All eigenvalues are complex, with imaginary parts of at least {slowest:.3g} in modulus."
    whole = evidence.summary("equilibrium")
    stable = (whole["eigenvalue"].sel(part="real").max(dim="mode") <= 0.0).any(dim="law").values
    changes = "; ".join(describe_where("no growth", whole["a"].values, stable))
    return Verdict(worst_verdict(verdicts), reason, measured, changes)


@claim("Results", "equilibrium", "equilibrium", depends_on=("equilibrium_unstable",))
def oscillations_grow(evidence: Evidence, *, law: str = "linearized", a: Range = WEAKENING) -> Verdict:
    """Where the slope F' of the friction law is negative, the amplitude of the velocity oscillations grows with time.

    Holds if perturbations of uniform sliding grow in simulations at every a > 0.
    """
    sliding, ratio, measured = _growth(evidence, law, a)
    reason = f"{format_range(sliding).capitalize()} ({law}) perturbations {'grow' if (ratio > 0.0).all() else 'decay'}."
    return Verdict(HOLDS if (ratio > 0.0).all() else FAILS, reason, measured)


@claim("Results", "equilibrium", "equilibrium")
def growth_rate(
    evidence: Evidence,
    *,
    law: str = "linearized",
    claimed: float = 1.0,
    tolerance: Tolerance = 0.05,
    loose: LooseTolerance = 0.1,
    a: Range = WEAKENING,
) -> Verdict:
    """The solution contains exp(−F'(v) t), with the slope F' of the friction law.

    Holds if perturbations of uniform sliding grow in simulations at {claimed:g} times −F'(v), within {tolerance:g} at
    every a > 0, and loosely within {loose:g}.
    """
    sliding, ratio, measured = _growth(evidence, law, a)
    verdict = worst_verdict(judge_value(item.value, claimed, tolerance, loose) for item in measured)
    rate = with_error(float(ratio.mean()), float(np.ptp(ratio)))
    reason = (
        f"{format_range(sliding).capitalize()} ({law}) perturbations grow at {rate} times −F'(v); the paper says "
        f"{claimed:g}."
    )
    return Verdict(verdict, reason, measured)


def _growth(evidence: Evidence, law: str, a: Range) -> tuple[xarray.Dataset, np.ndarray, list[Measured]]:
    """Return uniform sliding in a range of a, the growth rates of its perturbations over −F'(v), and their extremes.

    The rates follow from the springs and from F'(v) alone, whatever the grid of a.
    """
    evidence.check_blocks()
    sliding = evidence.choose(evidence.summary("equilibrium").sel(law=law), a)
    ratio = sliding["growth_rate"].values / evidence.negative_damping(law, sliding["a"].values)
    return sliding, ratio, extremes("growth rate over −F'(v), in simulations", ratio)


@claim("Results", "motion_minus")
def velocities_near_driver(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    law: str = "linearized",
    claimed: float = 1.0,
    tolerance: Tolerance = 0.05,
    loose: LooseTolerance = 0.1,
) -> Verdict:
    """The initial velocities are very close to the velocity v of the driver.

    Holds if each is {claimed:g} times v within {tolerance:g}, and loosely within {loose:g}.

    Both are numbers of the paper, so that neither the grid of a nor the convention matters.

    law : which a study needs; the numbers do not depend on it
    """
    evidence.check_blocks()
    for name in initial:
        evidence.check_state(name)
    ratios = np.concatenate([np.array(PAPER_STATES[name].coordinates(3)[1]) for name in initial]) / evidence.config["v"]
    measured = extremes("initial velocity over v", ratios)
    verdict = worst_verdict(judge_value(item.value, claimed, tolerance, loose) for item in measured)
    least, most = (f"{item.value:.4g}" for item in measured)
    reason = f"The initial velocities of {join_words(initial)} are {span(least, most)} times v."
    return Verdict(verdict, reason, measured)


@claim("Results", "motion_minus", "equilibrium", "stick_slip")
def minus_near_equilibrium(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    law: str = "linearized",
    at: float = 0.08,
    near: Near = 1.0,
    loose: LooseTolerance = 2.0,
) -> Verdict:
    """In minus the first block begins close to its stationary position; in plus it does not.

    Holds if it begins within {near:g} amplitude of the block, in the motion reached from minus, and in plus farther
    away than that; and loosely if it begins within {loose:g} amplitudes.

    initial : the state that is close, the state that is not
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


@claim("The linearization", "friction_laws", "mean_distance")
def friction_keeps_sign(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    law: str = "linearized",
    a: Range = POSITIVE,
) -> Verdict:
    """The linearized friction does not change its sign, which would be an artefact.

    Holds if the friction on a slipping block stays positive in every run.
    """
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


@claim("Eq. 3", "equilibrium", "equilibrium")
def exponentials(evidence: Evidence, *, law: str = "linearized", claimed: int = 3, a: Range = WEAKENING) -> Verdict:
    """Between two events a position is a sum of three exponentials and a linear function of time.

    Holds if there are {claimed:g} exponentials at every a > 0. A complex pair may count as one, with a complex
    amplitude, or as two.

    The eigenvalues follow from the springs and from F'(v) alone, whatever the grid of a.
    """
    evidence.check_blocks()
    sliding = evidence.choose(evidence.summary("equilibrium").sel(law=law), a)
    eigenvalue = sliding["eigenvalue"]
    real, imaginary = (eigenvalue.sel(part=part).values for part in PARTS)
    counts, pairs = (
        np.array([len({*zip(x.round(12), y.round(12), strict=True)}) for x, y in zip(real, part, strict=True)])
        for part in (imaginary, np.abs(imaginary))
    )
    measured = [
        *extremes("number of exponentials", counts),
        Measured("largest number of complex pairs", float(max(pairs))),
    ]
    readings = {
        f"a complex pair counts as {words}": HOLDS if (number == claimed).all() else FAILS
        for words, number in (("one", pairs), ("two", counts))
    }
    reason = (
        f"{format_range(sliding).capitalize()} a position has at most {max(counts)} exponentials, in {max(pairs)} "
        f"complex pairs; the paper says {claimed}: "
        f"{'; '.join(f'{reading} ({verdict})' for reading, verdict in readings.items())}."
    )
    return combine_readings(readings, reason, measured)


@claim("Abstract", "lyapunov", "lyapunov", "equilibrium")
def map_dimension(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    law: str = "linearized",
    claimed: int = 6,
    a: Range = POSITIVE,
) -> Verdict:
    """The model is transformed into a six-dimensional mapping from one stop or start to the next.

    Holds if a state has {claimed:g} components and the map acts on all of them but the direction along the flow, in
    which no map from event to event acts; and loosely if sticking removes further directions. A state has two
    components per block: position relative to the driver, and velocity. Each Lyapunov exponent of −∞ is a direction
    that sticking has removed permanently.
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
    left = numbers - 1 - lost
    measured = [
        Measured("components of a state", float(numbers)),
        *extremes("number of exponents of −∞", lost),
    ]
    verdict = FAILS if numbers != claimed else LOOSELY if lost.any() else HOLDS
    removed, remaining = (span(f"{count.min():.0f}", f"{count.max():.0f}") for count in (lost, left))
    reason = (
        f"A state has {numbers} components. The map has no direction along the flow, and sticking destroys {removed} "
        f"further ones for good ({law}), so that it acts on {remaining} dimensions."
    )
    return Verdict(verdict, reason, measured)


@claim("Results", "equilibrium", "equilibrium")
def stable_where_friction_grows(evidence: Evidence, *, law: str = "linearized", a: Range = WEAKENING) -> Verdict:
    """Uniform sliding is unstable because friction decreases with velocity; where it grows with velocity it is
    stable.

    Holds if perturbations of uniform sliding decay at every a > 0 in simulations with the mirror image of a law at the
    driver velocity: the same friction there, and the opposite slope.

    The rates follow from the springs and from this slope alone, whatever the grid of a.
    """
    evidence.check_blocks()
    sliding = evidence.choose(evidence.summary("equilibrium").sel(law=law), a)
    growth = sliding["strengthening_growth_rate"].values
    if not len(finite(growth)):
        raise NotTestableError(f"the mirror image of the {law} law is not a friction law with {a}")
    largest = float(np.nanmax(growth))
    words = f"decay at a rate of {-largest:.3g} or more" if largest < 0.0 else f"grow, at a rate of up to {largest:.3g}"
    reason = f"{format_range(sliding).capitalize()} perturbations {words} if the slope of the {law} law is reversed."
    changes = "".join(describe_where("growth", sliding["a"].values, growth >= 0.0))
    return Verdict(HOLDS if largest < 0.0 else FAILS, reason, [Measured("largest growth rate", largest)], changes)
