"""Claims on synchrony of the end blocks: initial states and a that lead to it, how fast, and ⟨J⟩ without it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.conventions import judge_conventions
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.for_all import Case, for_all
from burridge_knopoff.claims.judge import judge
from burridge_knopoff.claims.outcomes import reached_attractor, synchrony
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
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
def edge_of_synchrony(evidence: Evidence, initial: str, claimed: float, tolerance: float, loose: float) -> Verdict:
    """Judge the largest a at which an initial state synchronizes, under both laws.

    It lies between two neighbours of the grid. The attractor reached decides, since close to the loss of synchrony a
    run is too short to get there. If the synchronized orbit loses stability between the two values, the edge is a_c.
    """
    verdicts, measured, texts, losses = [], [], [], []
    for law, grid, synchronized in _reached_synchrony(evidence, initial):
        low, high = _edge(grid, synchronized)
        if not np.isfinite(low + high):
            raise NotTestableError(f"the grid does not hold the edge of synchrony from {initial}, {law} law")
        measured.append(Measured(f"largest a with synchrony, {law}", 0.5 * (low + high), 0.5 * (high - low)))
        texts.append(f"between {low:g} and {high:g} ({law})")
        proved = evidence.proved_critical_a(law)
        critical, error = proved or evidence.critical_a(law)
        if low <= critical <= high:
            name = f"a_c, at which the synchronized orbit loses stability, {law}"
            verdicts.append(judge_value(critical, claimed, tolerance, loose))
            measured.append(Measured(name, critical, error, proved=proved is not None))
            certain = ", proved" if proved else ""
            losses.append(f"a_c = {critical:.5g} ({law}{certain})")
        else:
            verdicts.append(judge_interval(low, high, claimed, tolerance, loose))
    reason = f"Synchrony from {initial} ends {join_words(texts)}; the paper says {claimed:g}."
    if losses:
        reason += f" There the synchronized orbit loses stability, at {join_words(losses)}."
    return Verdict(worst_verdict(verdicts), reason, measured)


@judge("attractors")
def beginning_of_synchrony(evidence: Evidence, initial: str, claimed: float, tolerance: float, loose: float) -> Verdict:
    """Judge whether there is synchrony from an initial state from one a on, under both laws, by the attractor reached.

    The smallest a with synchrony lies between a value of the grid and the one before, or 0, where friction is constant.
    The claim holds if it is not larger than the claimed one.
    """
    verdicts, measured, texts = [], [], []
    for law, grid, synchronized in _reached_synchrony(evidence, initial):
        if not synchronized.any():
            raise NotTestableError(f"no a with synchrony from {initial} is known, {law} law")
        first = int(np.argmax(synchronized))
        low, high = float(grid[first - 1]) if first else 0.0, float(grid[first])
        # Synchrony that begins earlier is there from the claimed value on.
        verdicts.append(judge_interval(max(low, claimed), max(high, claimed), claimed, tolerance, loose))
        measured.append(Measured(f"smallest a with synchrony, {law}", 0.5 * (low + high), 0.5 * (high - low)))
        texts.append(f"between {low:g} and {high:g} ({law})")
    reason = f"The smallest a with synchrony from {initial} lies {join_words(texts)}; the paper says {claimed:g}."
    return Verdict(worst_verdict(verdicts), reason, measured)


def _reached_synchrony(evidence: Evidence, initial: str) -> Iterator[tuple[str, np.ndarray, np.ndarray]]:
    """Yield (law, the values of a > 0 at which the branch reached from a state is known, whether it is synchrony)."""
    evidence.check_state(initial)
    attractors = evidence.choose(evidence.own_attractors(), Range(above=0.0))
    for law in PAPER_LAWS:
        branch = attractors["initial_branch"].sel(law=law, initial=initial).values
        yield law, attractors["a"].values[branch >= 0], branch[branch >= 0] == 0


def _edge(grid: np.ndarray, synchronized: np.ndarray) -> tuple[float, float]:
    """Return the neighbours in the grid between which synchrony ends; NaN if it does not end inside the grid."""
    index = np.flatnonzero(synchronized)
    return (grid[index[-1]], grid[index[-1] + 1]) if len(index) and index[-1] + 1 < len(grid) else (np.nan, np.nan)


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
    """Judge whether J falls below a level for good by a time, loosely by `loose` times that time."""
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
    text = (
        f"stays below {level:g} from τ = {settled:g} on" if np.isfinite(settled) else f"does not stay below {level:g}"
    )
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
    """Return the decay rate of J between the two lowest levels above `least`; NaN if it reaches only one of them."""
    levels = runs["level"].values
    times = runs["settling_time"].values
    above = np.flatnonzero((levels > least) & np.isfinite(times))
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
