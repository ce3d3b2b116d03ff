"""A branch of periodic orbits in one call, from an orbit or from a state that settles on one."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

from burridge_knopoff.library.keyword_settings import settings_of
from burridge_knopoff.library.state_forms import Initial, begun_state
from burridge_knopoff.messages import format_value, refusal
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.limit_cycle import limit_cycle
from burridge_knopoff.periodic_orbits import following
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.following import CONTINUATION, ContinuationSettings
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit

UNBOUNDED = (-math.inf, math.inf)

# Largest difference from the period of the first orbit, as a fraction of the range on the branch, where it is closed.
CLOSED = 1e-3

#: Times for a motion to settle on a periodic orbit, in the chain's own unit: the first that suffices is taken.
SETTLING = (1000.0, 10_000.0, 100_000.0)


def follow(
    orbit: PeriodicOrbit | Model,
    interval: Any = UNBOUNDED,
    settings: ContinuationSettings = CONTINUATION,
    *,
    parameter: str,
    upward: bool = True,
    is_complete: Callable[[list[BranchOrbit]], bool] = lambda points: False,
    initial: Initial | None = None,
    settling: float | None = None,
    start: str = "moving",
    **by_name: Any,
) -> list[BranchOrbit]:
    """Return the orbits of a branch, continued from one of them until a parameter leaves an interval.

    orbit : stable or unstable, of any chain; first reduced to its minimal form. Or a `Model`: then the orbit on which
        the motion from `initial` settles; a parameter that it leaves open has the middle of the interval
    interval : (low, high) of the parameter; by default unbounded
    settings : lengths of steps; by_name : some or all of them by name (see `ContinuationSettings`)
    upward : whether the parameter increases at first
    parameter : a, v, a parameter of the law such as sigma, one of the chain such as coupling, or that of one block or
        spring such as `mass[3]` (`Model.at`)
    is_complete : called with all orbits so far after each orbit that does not graze; ends the branch if true
    initial, start : the state, needed for a model, since several attractors coexist; see `simulate`
    settling : time for the motion to settle; by default as long as needed, up to 100 000

    A grazing orbit is in the list with `is_grazing` set; the next orbit, if there is one, is on the other side. The
    branch also ends where it has returned to its first orbit, where it joins a branch of simpler orbits, where steps
    become too short, and at the `settings.max_orbits`-th orbit, or at the next one if that one grazes. If the parameter
    is then still within the interval, the rest of an open branch has not been followed.

    Raises OrbitError if the motion settles on no periodic orbit, or if the continuation cannot start, for example if
    the orbit is outside the interval or if its return has no derivative (see `multipliers`). Raises ValueError for an
    invalid interval or a name that is not a parameter of the model, and for a model without `initial`.

    Source: E. J. Doedel, H. B. Keller and J. P. Kernevez, Int. J. Bifurcation Chaos 1 (1991) 493 (pseudo-arclength);
    docs/bifurcations.md explains how a branch continues where its orbit grazes.

    >>> from burridge_knopoff import Chain, Model, follow, law_of, locate_bifurcations, synchronized_orbit
    >>> orbit = synchronized_orbit(Model(Chain(3), law_of("linearized", 0.0865)))
    >>> branch = follow(orbit, (0.086, 0.0875))
    >>> [round(point.orbit.a, 4) for point in branch]
    [0.0865, 0.0866, 0.0868, 0.0872, 0.0877]
    >>> [point.multipliers.unstable_count for point in branch]
    [0, 0, 0, 1, 1]
    >>> branch = follow(orbit, (0.9, 1.0), parameter="coupling", upward=False)
    >>> round(branch[-1].value, 3) <= 0.9, branch[-1].orbit.a
    (True, 0.0865)
    >>> branch = follow("linearized", 0.0865, (0.086, 0.0875), initial="minus")
    >>> [round(bifurcation.a, 4) for bifurcation in locate_bifurcations(branch)]
    [0.087]
    """
    settings = settings_of(ContinuationSettings, settings, by_name)
    if isinstance(orbit, Model):
        orbit = _settled_orbit(_within(orbit, parameter, interval), initial, start, settling)
    else:
        for name, value in {"initial": initial, "settling": settling}.items():
            if value is not None:
                raise ValueError(f"{name}: got {format_value(value)} together with an orbit, expected none")
    if not callable(is_complete):
        raise refusal("is_complete", is_complete, "a function")
    return following.follow(
        orbit,
        interval,
        settings,
        parameter=parameter,
        upward=upward,
        is_complete=lambda points: is_complete(points) or _has_closed(points),
    )


def _has_closed(branch: Sequence[BranchOrbit]) -> bool:
    """Return whether the last step of a branch has passed its first orbit, in the direction in which it began."""
    if len(branch) < 3:
        return False
    first, before, last = branch[0], branch[-2], branch[-1]
    low, high = before.value - first.value, last.value - first.value
    upward = {point.tangent[-1] > 0.0 for point in (first, before, last)}
    if low * high >= 0.0 or len(upward) > 1 or last.orbit.stop_counts != first.orbit.stop_counts:
        return False
    periods = [point.orbit.period for point in branch]
    between = periods[-2] + low / (low - high) * (periods[-1] - periods[-2])
    return abs(between - periods[0]) <= CLOSED * (max(periods) - min(periods))


def _within(model: Model, parameter: str, interval: Any) -> Model:
    """Return a model with a value of the parameter: if it leaves the parameter open, the middle of the interval."""
    if parameter not in model.law.missing:
        return model
    low, high = following.interval_ends(interval)
    if not math.isfinite(high - low):
        raise refusal("interval", interval, f"finite ends, since the model leaves {parameter} open")
    return model.at(**{parameter: 0.5 * (low + high)})


def _settled_orbit(model: Model, initial: Initial | None, start: str, settling: float | None) -> PeriodicOrbit:
    """Return the orbit on which a motion settles, after the given time or the first of SETTLING that suffices."""
    if initial is None:
        raise ValueError("initial: missing, expected a state: several attractors may coexist")
    state = begun_state(model, initial, start=start)
    if settling is not None:
        return limit_cycle(model, state, settling)
    *earlier, last = (model.chain.own_units.time * time for time in SETTLING)
    for time in earlier:
        try:
            return limit_cycle(model, state, time)
        except OrbitError:
            continue
    return limit_cycle(model, state, last)
