"""Claims on synchrony of the end blocks: initial states and a that lead to it, how fast, and ⟨J⟩ without it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np

from burridge_knopoff.claims.conventions import combine_readings, judge_conventions
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.for_all import Case, for_all
from burridge_knopoff.claims.judge import judge
from burridge_knopoff.claims.outcomes import reached_attractor, synchrony
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    NOT_TESTABLE,
    Measured,
    NotTestableError,
    Range,
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


@judge("mean_distance", "attractors")
def synchronizes(evidence: Evidence, initial: str, a: Range, synchronized: bool, loose_share: float) -> Verdict:
    """Judge whether an initial state always, or never, leads to synchrony, for all a of a range and both laws.

    loose_share : fraction of the values of a from which the claim holds loosely
    """
    runs = evidence.choose(evidence.state_summary("mean_distance", initial), a)
    here, elsewhere = ("synchrony", "no synchrony") if synchronized else ("no synchrony", "synchrony")
    verb = "synchronize" if synchronized else "do not synchronize"

    def cases(inside: xarray.Dataset | None = None) -> Iterator[Case]:
        found = synchrony(evidence, initial, a, inside)
        for law in PAPER_LAWS:
            state = found.sel(law=law).values
            few = f"too few runs from {initial} under the {law} law completed at {a}"
            yield Case(law, found["a"].values, state == synchronized, np.isfinite(state), few)

    def extreme(case: Case) -> Iterator[Measured]:
        mean = runs["mean_distance"].sel(law=case.name).values[case.right]
        if len(mean):
            value, name = (mean.max(), "largest") if synchronized else (mean.min(), "smallest")
            yield Measured(f"{name} ⟨J⟩ there, {case.name}", float(value))

    found = for_all(loose_share, cases())
    reason = f"From {initial} the end blocks {verb} at {found} of the values of a with {a}."
    measured = found.measured(f"share of a with {here}", extreme)
    return judge_conventions(
        evidence,
        found.verdict,
        reason,
        measured,
        found.exceptions(elsewhere),
        found.convention_judge(evidence, a, cases),
    )


@judge("attractors", "orbits", "proof")
def edge_of_synchrony(
    evidence: Evidence,
    initial: str,
    claimed: float,
    tolerance: float,
    loose: float,
    end: Literal["lower", "upper"] = "upper",
) -> Verdict:
    """Judge one end of the range of a in which an initial state synchronizes, under both laws.

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


def _judge_edge(low: float, high: float, claimed: float, tolerance: float, loose: float) -> str:
    """Return the verdict on an edge in (low, high], or at low if they are equal; «not testable» if it is open."""
    try:
        return judge_interval(low, high, claimed, tolerance, loose)
    except NotTestableError:
        return NOT_TESTABLE


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


@judge("mean_distance", "attractors")
def mean_distance_at(
    evidence: Evidence, initial: str, laws: Sequence[str], at: float, claimed: float, tolerance: float, loose: float
) -> Verdict:
    """Judge ⟨J⟩ from an initial state at one a, under some laws, and under each convention by the attractor reached."""
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
        found = {law: reached_attractor(attractors, at, initial, law, "mean_distance") for law in laws}
        means = {law: mean[0] for law, mean in found.items() if mean}
        if not means:
            return "", ""
        verdict = worst_verdict(judge_value(mean, claimed, tolerance, loose) for mean in means.values())
        return verdict, "⟨J⟩ = " + ", ".join(f"{mean:.4f} ({law})" for law, mean in means.items())

    reason = f"⟨J⟩ from {initial} at a = {at:g} is {join_words(texts)}; the paper says {claimed:g}."
    return judge_conventions(evidence, worst_verdict(verdicts), reason, measured, [], judge_attractors)


@judge("mean_distance", "agreement", "attractors")
def stationary_distance(evidence: Evidence, initial: str, law: str, at: float) -> Verdict:
    """Judge whether J fluctuates stationarily: the run is on its attractor, which is not synchronized.

    On an attractor all means are stationary; that of J has the error of its batch means.
    """
    run = evidence.at(evidence.state_summary("mean_distance", initial), at).sel(law=law)
    mean, error, synchronized = (run[name].item() for name in ("mean_distance", "mean_distance_error", "synchronized"))
    settled = evidence.at(evidence.state_summary("agreement", initial), at)["settled"].sel(law=law).item()
    if not np.isfinite(mean):
        raise NotTestableError(f"the run from {initial} at a = {at:g} under the {law} law did not complete")
    if not settled >= 0:
        raise NotTestableError(f"it is undetermined whether the run from {initial} at a = {at:g} is on its attractor")

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        if not (found := reached_attractor(attractors, at, initial, law, "branch")):
            return "", ""
        return (HOLDS, "no synchrony") if found[0] else (FAILS, "synchrony, J = 0")

    words = "is on its attractor" if settled else "is not on its attractor yet"
    reason = (
        f"The run from {initial} at a = {at:g} ({law}) {words}; its batch means give ⟨J⟩ = {with_error(mean, error)}."
    )
    own = HOLDS if settled and not synchronized else FAILS
    return judge_conventions(evidence, own, reason, [Measured("⟨J⟩", mean, error)], [], judge_attractors)


@judge("mean_distance", "orbits")
def distance_vanishes(
    evidence: Evidence, initial: str, law: str, at: float, by: float, level: float, loose: float
) -> Verdict:
    """Judge whether J falls below a level for good by a time, loosely by `loose` times that time.

    J falls exponentially and is never 0. When it reaches the rounding error, the lowest level, depends on the
    arithmetic, so that time is only reported.
    """
    runs = evidence.at(evidence.state_summary("mean_distance", initial), at).sel(law=law)
    if level not in runs["level"].values:
        raise NotTestableError(f"mean_distance.nc has no settling time for J < {level:g}")
    if not np.isfinite(runs["mean_distance"].item()):
        raise NotTestableError(f"the run from {initial} at a = {at:g} under the {law} law did not complete")
    measured = [
        Measured(f"time τ from which on J < {height:g}", float(value))
        for height, value in zip(runs["level"].values, runs["settling_time"].values, strict=True)
    ]
    settled = float(runs["settling_time"].sel(level=level).item())
    reached = runs["level"].values[(runs["level"].values <= level) & np.isfinite(runs["settling_time"].values)]
    times = [f"{height:g} from τ = {runs['settling_time'].sel(level=height).item():g} on" for height in reached]
    text = f"stays below {join_words(times)}" if np.isfinite(settled) else f"does not stay below {level:g}"
    verdict = HOLDS if settled <= by else LOOSELY if settled <= loose * by else FAILS
    rate, expected = _decay_rate(runs, level), _transverse_rate(evidence, law, at)
    decay = ""
    if np.isfinite(rate):
        measured.append(Measured("rate at which J falls", rate))
        decay = f" It falls as exp(−{rate:.3g} τ)."
    if np.isfinite(expected):
        measured.append(Measured("rate by the transverse multiplier of the synchronized orbit", expected))
        decay += f" The transverse multiplier of the synchronized orbit gives a rate of {expected:.3g}."
    reason = f"J from {initial} at a = {at:g} ({law}) {text}.{decay} The paper says τ = {by:g}."
    return Verdict(verdict, reason, measured)


def _decay_rate(runs: xarray.Dataset, least: float) -> float:
    """Return the decay rate of J between the two lowest levels from `least` on; NaN if it reaches only one of them."""
    levels = runs["level"].values
    times = runs["settling_time"].values
    above = np.flatnonzero((levels >= least) & np.isfinite(times))
    first, last = above[np.argsort(-levels[above])][-2:] if len(above) > 1 else (0, 0)
    time = times[last] - times[first]
    return float(np.log(levels[first] / levels[last]) / time) if time > 0.0 else np.nan


def _transverse_rate(evidence: Evidence, law: str, at: float) -> float:
    """Return the rate at which the end blocks approach each other near synchrony; NaN if no orbit is known."""
    orbits = evidence.summaries.get("orbits")
    if orbits is None or at not in orbits["a"].values:
        return np.nan
    orbit = orbits.sel(law=law, a=at)
    return float(-np.log(abs(orbit["transverse_multiplier"].item())) / orbit["period"].item())
