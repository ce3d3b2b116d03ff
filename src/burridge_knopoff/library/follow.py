"""A branch of periodic orbits in one call, from an orbit or from a state that settles on one."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from burridge_knopoff.library.keyword_settings import settings_of
from burridge_knopoff.library.state_forms import Initial, begun_state
from burridge_knopoff.messages import format_value, refusal
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.limit_cycle import limit_cycle
from burridge_knopoff.periodic_orbits.branch import Branch, follow_branch
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.following import ContinuationSettings, interval_ends
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit
from burridge_knopoff.values import instance_of

UNBOUNDED = (-math.inf, math.inf)

#: Times for a motion to settle on a periodic orbit, in the chain's own unit: the first that suffices is taken.
SETTLING = (1000.0, 10_000.0, 100_000.0)


def follow(
    orbit: PeriodicOrbit | Model,
    interval: Any = UNBOUNDED,
    settings: ContinuationSettings | None = None,
    *,
    parameter: str | None = None,
    upward: bool | None = None,
    is_complete: Callable[[list[BranchOrbit]], bool] = lambda points: False,
    initial: Initial | None = None,
    settling: float | None = None,
    start: str | None = None,
    **by_name: Any,
) -> Branch:
    """Return the branch of an orbit, continued in both directions until a parameter leaves an interval.

    orbit : stable or unstable, of any chain; first reduced to its minimal form. Or a `Model`: then the orbit on which
        the motion from `initial` settles; a parameter that it leaves open has the middle of the interval
    interval : (low, high) of the parameter; by default unbounded
    settings : lengths of steps, in fractions of the interval, and number of orbits; by_name : some or all of them by
        name (see `ContinuationSettings`)
    upward : follows only the side on which the parameter increases (true) or decreases (false) at first
    parameter : a, v, a parameter of the law such as sigma, one of the chain such as coupling, or that of one block or
        spring such as `mass[3]` (`Model.at`)
    is_complete : called with all orbits of a side so far after each orbit that does not graze; ends the side if true
    initial, start : the state, needed for a model, since several attractors coexist; see `simulate`
    settling : time for the motion to settle; by default as long as needed, up to 100 000

    A grazing orbit is on the branch with `is_grazing` set; the next orbit, if there is one, is on the other side. At
    most one orbit of each side lies beyond the interval. `Branch.ends` says why each side ended, which may be before an
    end of the interval, and `Branch.bifurcations` lists the bifurcations.

    Raises OrbitError if the motion settles on no periodic orbit, or if the continuation cannot start, for example if
    the orbit is outside the interval or if its return has no derivative (see `multipliers`). Raises ValueError for an
    invalid interval or a name that is not a parameter of the model, and for a model without `initial`.

    Source: E. J. Doedel, H. B. Keller and J. P. Kernevez, Int. J. Bifurcation Chaos 1 (1991) 493 (pseudo-arclength);
    docs/bifurcations.md explains how a branch continues where its orbit grazes.

    >>> from burridge_knopoff import Model, follow, synchronized_orbit
    >>> model = Model("linearized", a=0.0865)
    >>> orbit = synchronized_orbit(model)
    >>> branch = follow(orbit, (0.086, 0.0875), parameter="a")
    >>> [end.reason for end in branch.ends], [round(bifurcation.a, 4) for bifurcation in branch.bifurcations]
    (['bound', 'bound'], [0.087])
    >>> [branch[k].multipliers.unstable_count for k in (0, -1)]
    [0, 1]
    >>> branch = follow(orbit, (0.9, 1.0), parameter="coupling", upward=False)
    >>> round(branch[-1].value, 2) <= 0.9, branch[-1].orbit.a
    (True, 0.0865)
    >>> follow(model.at(a=0.08), (0.078, 0.084), parameter="a", initial="plus").ends[1].reason
    'closed'
    """
    if not isinstance(orbit, PeriodicOrbit):
        instance_of(orbit, Model, "orbit")
    if parameter is None:
        raise ValueError("parameter: missing, expected the name of a parameter of the model, such as a")
    settings = settings_of(ContinuationSettings, settings, by_name)
    if isinstance(orbit, Model):
        orbit = _settled_orbit(_within(orbit, parameter, interval), initial, start or "moving", settling)
    else:
        for name, value in {"initial": initial, "settling": settling, "start": start}.items():
            if value is not None:
                raise ValueError(f"{name}: got {format_value(value)} together with an orbit, expected none")
    if not callable(is_complete):
        raise refusal("is_complete", is_complete, "a function")
    return follow_branch(orbit, interval, settings, parameter, upward, is_complete)


def _within(model: Model, parameter: str, interval: Any) -> Model:
    """Return a model with a value of the parameter: if it leaves the parameter open, the middle of the interval."""
    if parameter not in model.law.missing:
        return model
    low, high = interval_ends(interval)
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
