"""Claims on synchrony of the end blocks: initial states and a that lead to it, how fast, and ⟨J⟩ without it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Literal

import numpy as np

from burridge_knopoff.claims.choice import Level, LooseShare, LooseTolerance, Tolerance
from burridge_knopoff.claims.claim import claim
from burridge_knopoff.claims.conventions import combine_readings, judge_conventions
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.outcomes import Reached, Runs, reached_attractor
from burridge_knopoff.claims.range import BELOW, SYNCHRONY, Range
from burridge_knopoff.claims.statement import Case, Truth, for_all
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    UNDECIDED,
    Measured,
    NotTestableError,
    UndecidedError,
    Verdict,
    join_words,
    judge_interval,
    judge_value,
    worst_verdict,
)
from burridge_knopoff.study.formatting import with_error
from burridge_knopoff.study.paper import PAPER_LAWS

if TYPE_CHECKING:
    import xarray


def _synchronizes(evidence: Evidence, initial: str, a: Range, loose_share: float, *, synchronized: bool) -> Verdict:
    """Judge whether an initial state always, or never, leads to synchrony, for all a of a range and both laws."""

    def truth(motion: Runs | Reached) -> Truth:
        synchrony = motion.synchronized.sel(initial=initial)
        return Truth(synchrony == synchronized, synchrony.notnull())

    unknown = f"too few runs from {initial} under the {{law}} law completed at {a}"
    share = for_all(evidence, [initial], a, loose_share, truth, unknown, truth)
    claimed, otherwise = ("synchrony", "no synchrony") if synchronized else ("no synchrony", "synchrony")
    mean = Runs(evidence, [initial], a).of("mean_distance", "mean_distance").isel(initial=0)

    def extreme(case: Case) -> Iterator[Measured]:
        values = mean.sel(law=case.name).values[case.is_true]
        if len(values):
            value, name = (values.max(), "largest") if synchronized else (values.min(), "smallest")
            yield Measured(f"{name} ⟨J⟩ there, {case.name}", float(value))

    verb = "synchronize" if synchronized else "do not synchronize"
    return share.conclude(
        f"From {initial} the end blocks {verb} {share.at(a)}.",
        share.measured(f"share of a with {claimed}", extreme),
        otherwise,
    )


@claim("Results, Fig. 3", "mean_distance", "mean_distance", "attractors")
def minus_synchronizes(
    evidence: Evidence,
    *,
    initial: str = "minus",
    a: Range = SYNCHRONY,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """From the state minus the end blocks synchronize, ⟨J⟩ = 0, for every a between 0.005 and 0.08, under both laws."""
    return _synchronizes(evidence, initial, a, loose_share, synchronized=True)


@claim("Results, Fig. 3", "mean_distance", "mean_distance", "attractors")
def plus_does_not_synchronize(
    evidence: Evidence,
    *,
    initial: str = "plus",
    a: Range = SYNCHRONY,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """From the state plus the end blocks do not synchronize, ⟨J⟩ > 0, for any a between 0.005 and 0.08, under both
    laws.
    """
    return _synchronizes(evidence, initial, a, loose_share, synchronized=False)


def edge_of_synchrony(
    evidence: Evidence,
    initial: str,
    claimed: float,
    tolerance: float,
    loose: float,
    a: Range,
    end: Literal["lower", "upper"] = "upper",
) -> Verdict:
    """Judge one end of the range of a in which an initial state synchronizes, under both laws.

    a : range that has to be covered by values of a, so that no other end of synchrony is missed there
    end : lower or upper

    It lies between two neighbours of the grid; the lower end may lie between 0, where friction is constant, and the
    first of them. The attractor reached decides, since close to the loss of synchrony a run is too short to get there.
    If the synchronized orbit loses stability between the two values, the edge is a_c.

    Synchrony that appears between two values of a may appear only there, or at least there.
    """
    is_upper = end == "upper"
    side = "up to there" if is_upper else "from there on"
    readings: dict[str, list[str]] = {f"only {side}": [], f"at least {side}": []}
    measured, texts, losses = [], [], []
    evidence.choose(evidence.own_attractors(), a)
    for law, grid, synchronized in _reached_synchrony(evidence, initial):
        if not synchronized.any():
            raise NotTestableError(f"no a with synchrony from {initial} is known, {law} law")
        low, high = _edge(grid, synchronized, is_upper)
        texts.append(f"{f'between {low:g} and {high:g}' if np.isfinite(high) else f'not before {low:g}'} ({law})")
        if np.isfinite(high):
            quantity = f"{'largest' if is_upper else 'smallest'} a with synchrony, {law}"
            measured.append(Measured(quantity, 0.5 * (low + high), 0.5 * (high - low)))
        proved = evidence.proved_critical_a(law)
        critical, error = proved or evidence.critical_a(law)
        if low <= critical <= high:
            name = f"a_c, at which the synchronized orbit loses stability, {law}"
            measured.append(Measured(name, critical, error, proved=proved is not None))
            losses.append(f"a_c = {critical:.5g} ({law}{', proved' if proved else ''})")
            low = high = critical
        # Under "at least", an edge beyond the claimed one counts as the claimed one.
        clip = min if is_upper else max
        ends = (low, high), (clip(low, claimed), clip(high, claimed))
        for of_laws, (first, last) in zip(readings.values(), ends, strict=True):
            of_laws.append(_judge_edge(first, last, claimed, tolerance, loose))
    verdicts = {reading: worst_verdict(of_laws) for reading, of_laws in readings.items()}
    reason = (
        f"Synchrony from {initial} {'ends' if is_upper else 'begins'} {join_words(texts)}. The paper says {claimed:g}: "
        f"{' or '.join(f'{reading} ({verdict})' for reading, verdict in verdicts.items())}."
    )
    if losses:
        reason += f" At the edge the synchronized orbit loses stability, at {join_words(losses)}."
    return combine_readings(verdicts, reason, measured)


@claim("Results, Fig. 3", "orbits", "attractors", "orbits", "proof")
def upper_edge(
    evidence: Evidence,
    *,
    initial: str = "minus",
    claimed: float = 0.08,
    tolerance: Tolerance = 0.005,
    loose: LooseTolerance = 0.01,
    a: Range = BELOW,
) -> Verdict:
    """From minus, there is synchrony up to a = 0.08.

    Holds if synchrony ends within {tolerance:g} of {claimed:g} under both laws, and loosely within {loose:g}. An end
    that is known to lie between two values of a is undecided unless the verdict is the same for all between them.

    "The synchronization appears for the parameter a between 0.005 and 0.08": only there, or at least there.
    """
    return edge_of_synchrony(evidence, initial, claimed, tolerance, loose, a, "upper")


@claim("Results, Fig. 3", "mean_distance", "attractors", "orbits", "proof")
def lower_edge(
    evidence: Evidence,
    *,
    initial: str = "minus",
    claimed: float = 0.005,
    tolerance: Tolerance = 0.0005,
    loose: LooseTolerance = 0.001,
    a: Range = BELOW,
) -> Verdict:
    """From minus, synchrony appears from a = 0.005 on.

    Holds if synchrony begins within {tolerance:g} of {claimed:g} under both laws, and loosely within {loose:g}. An end
    that is known to lie between two values of a is undecided unless the verdict is the same for all between them.

    The lower end of the range in `upper_edge`.
    """
    return edge_of_synchrony(evidence, initial, claimed, tolerance, loose, a, "lower")


def _judge_edge(low: float, high: float, claimed: float, tolerance: float, loose: float) -> str:
    """Return the verdict on an edge in (low, high], or at low if they are equal; «undecided» if it is open."""
    try:
        return judge_interval(low, high, claimed, tolerance, loose)
    except UndecidedError:
        return UNDECIDED


def _reached_synchrony(evidence: Evidence, initial: str) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Yield (law, the values of a > 0 at which the branch reached from a state is known, whether it is synchrony)."""
    evidence.check_state(initial)
    attractors = evidence.choose(evidence.own_attractors(), Range(above=0.0))
    for law in PAPER_LAWS:
        branch = attractors["initial_branch"].sel(law=law, initial=initial).values
        yield law, attractors["a"].values[branch >= 0], branch[branch >= 0] == 0


def _edge(grid: np.ndarray, synchronized: np.ndarray, is_upper: bool) -> tuple[float, float]:
    """Return the neighbours in the grid between which synchrony ends or begins.

    The grid has no values beyond its last, so that an upper end there may be anywhere above; at 0 nothing synchronizes.
    """
    index = np.flatnonzero(synchronized)
    if is_upper:
        last = index[-1]
        return float(grid[last]), float(grid[last + 1]) if last + 1 < len(grid) else np.inf
    return float(grid[index[0] - 1]) if index[0] else 0.0, float(grid[index[0]])


@claim("Results, Fig. 5b", "distance", "mean_distance", "attractors")
def plus_mean_distance(
    evidence: Evidence,
    *,
    initial: str = "plus",
    laws: tuple[str, ...] = ("linearized",),
    at: float = 0.08,
    claimed: float = 0.14,
    tolerance: Tolerance = 0.005,
    loose: LooseTolerance = 0.01,
) -> Verdict:
    """From plus, J fluctuates around 0.14 at a = 0.08.

    Under each other convention ⟨J⟩ is that of the attractor reached.
    """
    runs = evidence.at(evidence.state_summary("mean_distance", initial), at)
    verdicts, measured, texts = [], [], []
    for law in laws:
        value, error = (runs[name].sel(law=law).item() for name in ("mean_distance", "mean_distance_error"))
        if not np.isfinite(value):
            raise NotTestableError(f"the run from {initial} at a = {at:g} under the {law} law did not complete")
        verdicts.append(judge_value(value, claimed, tolerance, loose))
        measured.append(Measured(f"⟨J⟩, {law}", value, error))
        texts.append(f"{with_error(value, error)} ({law})")

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        reached = {law: reached_attractor(attractors, at, initial, law, "mean_distance") for law in laws}
        means = {law: mean[0] for law, mean in reached.items() if mean}
        if not means:
            return "", ""
        verdict = worst_verdict(judge_value(mean, claimed, tolerance, loose) for mean in means.values())
        return verdict, "⟨J⟩ = " + ", ".join(f"{mean:.4f} ({law})" for law, mean in means.items())

    reason = f"⟨J⟩ from {initial} at a = {at:g} is {join_words(texts)}; the paper says {claimed:g}."
    return judge_conventions(evidence, worst_verdict(verdicts), reason, measured, [], judge_attractors)


@claim("Results, Fig. 5b", "distance", "mean_distance", "agreement", "attractors")
def plus_stationary(evidence: Evidence, *, initial: str = "plus", law: str = "linearized", at: float = 0.08) -> Verdict:
    """From plus, J displays stationary fluctuations at a = 0.08.

    Holds if the run is on its attractor, where all means are stationary, and this is not synchronized. ⟨J⟩ has the
    error of its batch means.
    """
    run = evidence.at(evidence.state_summary("mean_distance", initial), at).sel(law=law)
    mean, error, synchronized = (run[name].item() for name in ("mean_distance", "mean_distance_error", "synchronized"))
    settled = evidence.at(evidence.state_summary("agreement", initial), at)["settled"].sel(law=law).item()
    if not np.isfinite(mean):
        raise NotTestableError(f"the run from {initial} at a = {at:g} under the {law} law did not complete")
    if not settled >= 0:
        raise NotTestableError(f"it is undetermined whether the run from {initial} at a = {at:g} is on its attractor")

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        if not (reached := reached_attractor(attractors, at, initial, law, "branch")):
            return "", ""
        return (HOLDS, "no synchrony") if reached[0] else (FAILS, "synchrony, J = 0")

    words = "is on its attractor" if settled else "is not on its attractor yet"
    reason = (
        f"The run from {initial} at a = {at:g} ({law}) {words}; its batch means give ⟨J⟩ = {with_error(mean, error)}."
    )
    verdict = HOLDS if settled and not synchronized else FAILS
    return judge_conventions(evidence, verdict, reason, [Measured("⟨J⟩", mean, error)], [], judge_attractors)


@claim("Results, Fig. 5a", "distance", "mean_distance", "orbits")
def minus_distance_vanishes(
    evidence: Evidence,
    *,
    initial: str = "minus",
    law: str = "linearized",
    at: float = 0.08,
    by: float = 4000.0,
    level: Level = 1e-06,
) -> Verdict:
    """From minus, J has gone to zero by τ = 4000 at a = 0.08.

    Holds if J stays below {level:g}, the threshold of synchrony, from τ = {by:g} or earlier on. J falls exponentially
    and is never 0. A level of rounding is not judged: when J is below it depends on the arithmetic.
    """
    runs = evidence.at(evidence.state_summary("mean_distance", initial), at).sel(law=law)
    if level not in runs["level"].values:
        raise NotTestableError(f"mean_distance.nc has no settling time for J < {level:g}")
    if not np.isfinite(runs["mean_distance"].item()):
        raise NotTestableError(f"the run from {initial} at a = {at:g} under the {law} law did not complete")
    if not level > (rounding := runs["distance_rounding"].item()):
        raise NotTestableError(f"J < {level:g} is no more than rounding, {rounding:.1g}")
    runs = runs.sel(level=runs["level"] > rounding)
    times = dict(zip(runs["level"].values.tolist(), runs["settling_time"].values.tolist(), strict=True))
    measured = [Measured(f"time τ from which on J < {height:g}", time) for height, time in times.items()]
    settled = times[level]
    reached = [
        f"{height:g} from τ = {time:.2f} on" for height, time in times.items() if height <= level and np.isfinite(time)
    ]
    text = f"stays below {join_words(reached)}" if np.isfinite(settled) else f"does not stay below {level:g}"
    verdict = HOLDS if settled <= by else FAILS
    expected, period = _transverse_rate(evidence, law, at)
    rate, error = _decay_rate(runs, level, 2.0 * period)
    decay = ""
    if np.isfinite(rate):
        measured.append(Measured("rate at which J falls", rate, error if np.isfinite(error) else None))
        decay = f" It falls as exp(−κτ) with κ = {with_error(rate, error)}."
    if np.isfinite(expected):
        measured.append(Measured("rate by the transverse multiplier of the synchronized orbit", expected))
        decay += f" The transverse multiplier of the synchronized orbit gives a rate of {expected:.3g}."
    reason = f"J from {initial} at a = {at:g} ({law}) {text}.{decay} The paper says τ = {by:g}."
    return Verdict(verdict, reason, measured)


def _decay_rate(runs: xarray.Dataset, least: float, resolution: float) -> tuple[float, float]:
    """Return the decay rate of J between the two lowest levels from `least` on, with its error.

    resolution : uncertainty of the time between the levels, since J oscillates while it falls

    Both are NaN if J reaches only one level.
    """
    levels = runs["level"].values
    times = runs["settling_time"].values
    above = np.flatnonzero((levels >= least) & np.isfinite(times))
    first, last = above[np.argsort(-levels[above])][-2:] if len(above) > 1 else (0, 0)
    time = times[last] - times[first]
    rate = float(np.log(levels[first] / levels[last]) / time) if time > 0.0 else np.nan
    return rate, rate * resolution / float(time) if time > 0.0 else np.nan


def _transverse_rate(evidence: Evidence, law: str, at: float) -> tuple[float, float]:
    """Return the rate at which the end blocks approach each other near synchrony, and the period of the synchronized
    orbit; NaN if no orbit is known.
    """
    orbits = evidence.summaries.get("orbits")
    if orbits is None or at not in orbits["a"].values:
        return np.nan, np.nan
    orbit = orbits.sel(law=law, a=at)
    period = orbit["period"].item()
    return float(-np.log(abs(orbit["transverse_multiplier"].item())) / period), period
