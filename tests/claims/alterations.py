"""Alterations of data for which the paper is right, and the verdict on a claim from altered data."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import xarray

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.ledger import judge
from burridge_knopoff.claims.paper import CLAIMS
from burridge_knopoff.claims.verdict import Verdict
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.running.status import Status
from tests.claims.worlds import Summaries, count_sections, evidence, judge_means, paper_world

UNDETERMINED, _, PERIODIC, QUASIPERIODIC, CHAOTIC, TRANSIENT, *_ = MotionKind
ONE_OF_MANY = 0.03
Alteration = Callable[[Summaries], None]


def judge_altered(name: str, alteration: Alteration) -> Verdict:
    """Return the verdict on a claim from altered data for which the paper would otherwise be right."""
    world = paper_world()
    alteration(world)
    judge_means(world)
    return judge_claim(name, evidence(world))


def judge_claim(name: str, data: Evidence) -> Verdict:
    """Return the verdict on a claim; a claim about other claims is judged by their verdicts."""
    verdicts = {other: judge(CLAIMS[other], data) for other in CLAIMS[name].parameters.get("claims", ())}
    return judge(CLAIMS[name], replace(data, verdicts=verdicts))


def at(dataset: xarray.Dataset, name: str, value: object, **where: object) -> None:
    """Set a variable where its coordinates are those given; `a` may be a predicate."""
    if callable(where.get("a")):
        where["a"] = dataset["a"].values[where["a"](dataset["a"].values)]
    dataset[name].loc[where] = value


def alter(summary: str, name: str, value: object, **where: object) -> Alteration:
    return lambda world: at(world[summary], name, value, **where)


def both(*alterations: Alteration) -> Alteration:
    def all_of(world: Summaries) -> None:
        for alteration in alterations:
            alteration(world)

    return all_of


def reached(branch: int, **where: object) -> Alteration:
    return alter("attractors", "initial_branch", branch, **where)


def synchronized(value: int, **where: object) -> Alteration:
    return alter("mean_distance", "synchronized", value, **where)


def cloud(scale: float, shift: float) -> Alteration:
    """Change the section points from plus."""

    def move(world: Summaries) -> None:
        bifurcation = world["bifurcation_diagram"]
        from_plus = np.repeat(bifurcation["initial"].values, bifurcation["crossing_count"].values) == "plus"
        bifurcation["crossing_velocity"].values[from_plus] *= scale
        bifurcation["crossing_velocity"].values[from_plus] += shift
        count_sections(world)

    return move


def few_points(where: Callable[[np.ndarray], np.ndarray]) -> Alteration:
    """Let the section points from plus be one, and those of the attractors."""

    def move(world: Summaries) -> None:
        bifurcation = world["bifurcation_diagram"]
        chosen = np.repeat(
            (bifurcation["initial"].values == "plus") & where(bifurcation["a"].values),
            bifurcation["crossing_count"].values,
        )
        bifurcation["crossing_velocity"].values[chosen] = 0.3
        count_sections(world)

    return move


def repeating(points: int) -> Alteration:
    """Make the runs from plus repeat after so many section points."""
    return both(
        alter("agreement", "kind", PERIODIC, initial="plus"),
        alter("lyapunov", "section_period", points, initial="plus"),
    )


def attracting(points: int) -> Alteration:
    """Make the attractor that plus reaches repeat after so many section points."""
    return both(
        alter("attractors", "kind", PERIODIC, attractor=1), alter("attractors", "section_count", points, attractor=1)
    )


def line_from(first: float) -> Alteration:
    """Put the section points from plus on the line of minus from a value of a on, and below it before."""

    def move(world: Summaries) -> None:
        bifurcation = world["bifurcation_diagram"]
        count = bifurcation["crossing_count"].values
        a, initial = (np.repeat(bifurcation[name].values, count) for name in ("a", "initial"))
        velocity = bifurcation["crossing_velocity"].values
        velocity[initial == "plus"] = np.where(a >= first, 0.5, 0.3)[initial == "plus"]
        count_sections(world)

    return move


def no_crossings(world: Summaries) -> None:
    """Let the runs from plus cross the section downward only."""
    bifurcation = world["bifurcation_diagram"]
    from_plus = np.repeat(bifurcation["initial"].values, bifurcation["crossing_count"].values) == "plus"
    bifurcation["crossing_direction"].values[from_plus] = -1
    count_sections(world)


def crossing(chosen: Callable[[np.ndarray], np.ndarray]) -> Alteration:
    """Keep only the section points at some values of a."""

    def leave(world: Summaries) -> None:
        points = world["bifurcation_diagram"]
        there = chosen(points["a"].values)
        each = np.repeat(there, points["crossing_count"].values)
        world["bifurcation_diagram"] = points.isel(point=there, crossing=each)
        count_sections(world)

    return leave


def slips(power: float) -> Alteration:
    """Let the fastest slips in the window grow with that power of a."""

    def set_friction(world: Summaries) -> None:
        friction = world["mean_distance"]["window_least_friction"]
        friction.values[...] = 1.0 - 0.1 * world["mean_distance"]["a"].values ** (1.0 + power)

    return set_friction


def results_apart(fixed_v: float, fixed_av: float) -> Alteration:
    """Let the difference of ⟨J⟩ on the antiphase orbit fall with these powers of a."""

    def set_differences(world: Summaries) -> None:
        orbits = world["orbits"]
        for name, power in (("", fixed_v), ("_fixed_av", fixed_av)):
            orbits[f"antiphase_difference{name}"].values[1:] = -0.01 * orbits["a"].values[1:] ** power

    return set_differences


def third_exponent(value: float, error: float, a: Callable[[np.ndarray], np.ndarray] = np.isfinite) -> Alteration:
    """Give detuned motion a third exponent with this error, at the values of a that satisfy a condition."""

    def change(world: Summaries) -> None:
        rotation = world["rotation"]
        for name, number in (("detuned_exponent", value), ("detuned_exponent_error", error)):
            other = rotation[name].copy(deep=True)
            other.loc[{"exponent": 2} if "exponent" in other.coords else {}] = number
            other.values[..., :2] = rotation[name].values[..., :2]
            rotation[name] = rotation[name].where(~a(rotation["a"]), other)

    return change


def means_apart(a: object, **where: object) -> Alteration:
    return alter("agreement", "difference", 0.1, a=a, **where)


def few(summary: str, **counts: int) -> Alteration:
    """Keep only the first entries along a dimension."""
    first = {name: slice(count) for name, count in counts.items()}
    return lambda world: world.update({summary: world[summary].isel(first)})


def exponents(value: float, error: float) -> Alteration:
    values = {"lyapunov_exponent": value, "lyapunov_error": error}
    return both(*(alter("lyapunov", name, item, exponent=0) for name, item in values.items()))


def solutions(difference: float, mean: float = 0.14, error: float = 1e-5) -> Alteration:
    values = {"difference": difference, "mean_distance": mean, "difference_error": error}
    return both(*(alter("solvers", name, item, solver="rk4") for name, item in values.items()))


def failed(solver: str, **where: object) -> Alteration:
    values = {"status": Status.DIVERGED, "difference": np.nan, "mean_distance": np.nan}
    return both(*(alter("solvers", name, item, solver=solver, **where) for name, item in values.items()))


def chaos_from(first: float) -> Alteration:
    def set_kinds(world: Summaries) -> None:
        refined = world["refined"]
        refined["kind"].values[...] = np.where(refined["a"].values >= first, CHAOTIC, QUASIPERIODIC)[..., None]

    return set_kinds


def locked(
    value: int, law: int | slice = slice(None), a: Callable[[np.ndarray], np.ndarray] = np.isfinite
) -> Alteration:
    """Change branch 1 at the values of a that satisfy a condition."""

    def change(world: Summaries) -> None:
        rotation = world["rotation"]
        found = np.zeros(rotation["a"].shape, dtype=bool)
        found[law] = True
        rotation["locked"].values[found & a(rotation["a"].values)] = value

    return change


def parted(a: Callable[[np.ndarray], np.ndarray] = np.isfinite, **where: object) -> Alteration:
    """Give the end blocks of branch 1 two frequencies after detuning, at the values of a that satisfy a condition."""

    def change(world: Summaries) -> None:
        rotation = world["rotation"]
        other = rotation["detuned_frequency"].copy(deep=True)
        other.loc[{"block": 3, **where}] = 0.15
        rotation["detuned_frequency"] = rotation["detuned_frequency"].where(~a(rotation["a"]), other)

    return change


def growing(rate: float) -> Alteration:
    """Let perturbations of uniform sliding grow at a rate in units of −F'(v)."""
    return lambda world: world["equilibrium"].update({"growth_rate": rate * world["equilibrium"]["growth_rate"]})


def everywhere(summary: str, name: str, value: float, **where: object) -> Alteration:
    """Set a variable for all runs and attractors."""
    return both(alter(summary, name, value, **where), alter("attractors", name, value, **where))


def lost_at(a: float) -> Alteration:
    """Let the synchronized orbit lose stability there."""
    return alter("orbits", "critical_a", a)
