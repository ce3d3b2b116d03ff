"""A branch of periodic orbits in one call, from an orbit or from a state that settles on one."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from burridge_knopoff.laws import Law
from burridge_knopoff.library.keyword_settings import divide, settings_of
from burridge_knopoff.library.model_forms import GivenLaw, model_of
from burridge_knopoff.library.state_forms import Initial, begun_state, state_blocks
from burridge_knopoff.messages import format_value, refusal
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.limit_cycle import limit_cycle
from burridge_knopoff.periodic_orbits.branch import Branch, follow_branch
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.following import ContinuationSettings
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit
from burridge_knopoff.values import is_sequence

UNBOUNDED = (-math.inf, math.inf)

#: Times for a motion to settle on a periodic orbit, in the chain's own unit: the first that suffices is taken.
SETTLING = (1000.0, 10_000.0, 100_000.0)


def follow(
    orbit: PeriodicOrbit | Model | GivenLaw,
    a: Any = None,
    interval: Any = UNBOUNDED,
    settings: ContinuationSettings | None = None,
    *,
    parameter: str = "a",
    upward: bool | None = None,
    is_complete: Callable[[list[BranchOrbit]], bool] = lambda points: False,
    initial: Initial | None = None,
    settling: float | None = None,
    start: str = "moving",
    chain: Chain | None = None,
    blocks: int | None = None,
    v: float | None = None,
    contact: str | None = None,
    **parameters: Any,
) -> Branch:
    """Return the branch of an orbit, continued in both directions until a parameter leaves an interval.

    orbit : stable or unstable, of any chain; first reduced to its minimal form. Or a `Model` or a law: then the orbit
        on which the motion from `initial` settles
    a : of a law, as for `simulate`; left out after an orbit or a `Model`
    interval : (low, high) of the parameter; by default unbounded
    settings : lengths of steps, in fractions of the interval, and number of orbits; also by name, see
        `ContinuationSettings`
    upward : follows only the side on which the parameter increases (true) or decreases (false) at first
    parameter : a, v, a parameter of the law such as sigma, one of the chain such as coupling, or that of one block or
        spring such as `mass[3]` (`Model.at`)
    is_complete : called with all orbits of a side so far after each orbit that does not graze; ends the side if true
    initial, start : the state, needed for a model or a law, since several attractors coexist; see `simulate`
    settling : time for the motion to settle; by default as long as needed, up to 100 000
    chain, blocks, v, contact, parameters : of a law, as for `simulate`

    A grazing orbit is on the branch with `is_grazing` set; the next orbit, if there is one, is on the other side. At
    most one orbit of each side lies beyond the interval. `Branch.ends` says why each side ended, which may be before an
    end of the interval, and `Branch.bifurcations` lists the bifurcations.

    Raises OrbitError if the motion settles on no periodic orbit, or if the continuation cannot start, for example if
    the orbit is outside the interval or if its return has no derivative (see `multipliers`). Raises ValueError for an
    invalid interval or a name that is not a parameter of the model, and for a model or a law without `initial`.

    Source: E. J. Doedel, H. B. Keller and J. P. Kernevez, Int. J. Bifurcation Chaos 1 (1991) 493 (pseudo-arclength);
    docs/bifurcations.md explains how a branch continues where its orbit grazes.

    >>> from burridge_knopoff import Chain, Model, follow, law_of, locate_bifurcations, synchronized_orbit
    >>> orbit = synchronized_orbit(Model(Chain(3), law_of("linearized", 0.0865)))
    >>> branch = follow(orbit, (0.086, 0.0875))
    >>> [end.reason for end in branch.ends], [round(bifurcation.a, 4) for bifurcation in branch.bifurcations]
    (['bound', 'bound'], [0.087])
    >>> [branch[k].multipliers.unstable_count for k in (0, -1)]
    [0, 1]
    >>> branch = follow(orbit, (0.9, 1.0), parameter="coupling", upward=False)
    >>> round(branch[-1].value, 2) <= 0.9, branch[-1].orbit.a
    (True, 0.0865)
    >>> follow("linearized", 0.08, (0.078, 0.084), initial="plus").ends[1].reason
    'closed'
    """
    if is_sequence(a) or not (a is None or isinstance(orbit, Model | Law | str | Mapping)):
        # An interval follows an orbit or a model at once.
        if isinstance(interval, ContinuationSettings):
            settings = interval
        elif interval is not UNBOUNDED:
            raise ValueError("interval: got two, expected one")
        a, interval = None, a
    named, parameters = divide(parameters, ContinuationSettings)
    settings = settings_of(ContinuationSettings, settings, named)
    if isinstance(orbit, Model | Law | str | Mapping):
        of_model = {"chain": chain, "blocks": blocks, "contact": contact, "parameters": {"v": v, **parameters}}
        orbit = _settled_orbit(orbit, a, initial, start, settling, of_model)
    else:
        given = {"initial": initial, "settling": settling, "chain": chain, "blocks": blocks, "v": v, "contact": contact}
        for name, value in {**given, **parameters}.items():
            if value is not None:
                raise ValueError(f"{name}: got {format_value(value)} together with an orbit, expected none")
    if not callable(is_complete):
        raise refusal("is_complete", is_complete, "a function")
    return follow_branch(orbit, interval, settings, parameter, upward, is_complete)


def _settled_orbit(
    law: Model | GivenLaw,
    a: float | None,
    initial: Initial | None,
    start: str,
    settling: float | None,
    of_model: Mapping[str, Any],
) -> PeriodicOrbit:
    """Return the orbit on which a motion settles, after the given time or the first of SETTLING that suffices."""
    if initial is None:
        raise ValueError("initial: missing, expected a state: several attractors may coexist")
    model = model_of(law, a, state_blocks=state_blocks(initial), **of_model)
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
