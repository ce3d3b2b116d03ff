"""Event times against a 40-digit computation, and against SciPy for random chains."""

from itertools import product

import numpy as np
import pytest
from hypothesis import assume
from hypothesis import strategies as st

from burridge_knopoff import InitialState, Model, simulate
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import CONTACTS, STARTS
from tests.conftest import quick_first, random_examples
from tests.flows import check_events, listed
from tests.reference import reference_events
from tests.scipy_flow import scipy_events

SOLVERS = {"linearized": ("map", "series"), "nonlinear": ("series",)}
FRICTION = {"linearized": lambda a: lambda u: 1.0 - a * u, "nonlinear": lambda a: lambda u: 1.0 / (1.0 + a * u)}

# A double-precision run cannot be better than a few ulp times what the motion amplifies an error until τ = 200; these
# amplify it by less than a thousand.
REGULAR = [
    *(("linearized", "minus", a) for a in (0.02, 0.08, 0.1, 0.2)),
    *(("linearized", "plus", a) for a in (0.02, 0.08, 0.1, 0.3)),
    *(("nonlinear", "minus", a) for a in (0.02, 0.08, 0.1, 0.2, 0.3)),
    *(("nonlinear", "plus", a) for a in (0.02, 0.08, 0.1, 0.3)),
]
# Until τ = 200 these amplify an error several thousand times: 1e-12 is beyond double precision.
CHAOTIC = [("linearized", "minus", 0.3, 1e-10), ("linearized", "plus", 0.2, 1e-10), ("nonlinear", "plus", 0.2, 1e-11)]

# Values of a on either side of a grazing, beyond which a touch has become a stick as short as 0.0013, which a search on
# samples misses: (law, initial, a before, a after).
GRAZES = [
    ("linearized", "minus", 0.0318743, 0.031875),
    ("linearized", "plus", 0.2900093, 0.29001),
    ("nonlinear", "plus", 0.0743741, 0.074375),
    ("nonlinear", "plus", 0.0625, 0.062502),
]


def check(law, initial, a, tolerance=1e-12, end=200.0, contact="one_sided", start="moving"):
    """Compare all solvers with the reference; return its events."""
    state = PAPER_STATES[initial]
    expected = reference_events(law, a, state.position, state.velocity, end=end, contact=contact, start=start)
    options = {"transient": 0.0, "window": end, "events": "all", "start": start}
    for solver in SOLVERS[law]:
        run = simulate(Model(law, a=a, contact=contact), initial, solver=solver, **options)
        check_events(listed(run), expected, tolerance)
    return expected


@pytest.mark.parametrize(
    ("law", "initial", "a", "tolerance"), quick_first([*((*case, 1e-12) for case in REGULAR), *CHAOTIC], 2)
)
def test_event_times_of_the_reference_setting(law, initial, a, tolerance):
    assert len(check(law, initial, a, tolerance)) > 50


@pytest.mark.parametrize(("law", "initial", "before", "after"), quick_first(GRAZES, 2))
def test_grazing_touches(law, initial, before, after):
    missed, touched = (check(law, initial, a) for a in (before, after))
    assert len(touched) >= len(missed) + 2
    times = [[time for time, moved, _ in touched if moved == block] for block in (1, 2, 3)]
    # Every block begins with a stop.
    assert min(min(np.diff(times_of_block)[::2]) for times_of_block in times) < 0.002


@pytest.mark.parametrize("law", SOLVERS)
def test_conventions_agree_with_the_reference(law):
    """The first events decide which attractor `plus` reaches."""
    first = set()
    for contact, start in product(CONTACTS, STARTS):
        events = check(law, "plus", 0.08, end=30.0, contact=contact, start=start)
        first.add(tuple(round(float(time), 9) for time, _, _ in events if time < 20.0))
    assert len(first) >= 3


@st.composite
def chains(draw):
    blocks = draw(st.integers(2, 12))
    contact = draw(st.sampled_from(CONTACTS))
    slowest = 0.0 if contact == "one_sided" else -0.3
    numbers = st.floats(-1.5, 0.3, allow_subnormal=False)
    law, a = draw(st.sampled_from(list(SOLVERS))), draw(st.floats(0.0, 0.6))
    position = draw(st.lists(numbers, min_size=blocks, max_size=blocks))
    velocity = draw(st.lists(st.floats(slowest, 0.4), min_size=blocks, max_size=blocks))
    v, start = draw(st.floats(0.02, 0.5)), draw(st.sampled_from(STARTS))
    return law, a, position, velocity, {"v": v, "contact": contact, "start": start}


@pytest.mark.slow
@random_examples(20, 60, chains())
def test_random_chains_against_scipy(chain):
    """The events, their times within the peer's accuracy, and the state at the end agree."""
    law, a, position, velocity, options = chain
    blocks, v, end = len(position), options["v"], 8.0
    # Eq. 2: springs of 1 between blocks, and of D_i to the driver.
    stiffness = np.diag([2.0, *[4.0] * (blocks - 2), 2.0]) - np.eye(blocks, k=1) - np.eye(blocks, k=-1)
    slip = np.where(np.less(velocity, 0.0), -1, 1)
    if options["start"] == "tested":
        slip[-stiffness @ position <= 1.0] = 0
    ones, friction = np.ones(blocks), FRICTION[law](a)
    expected, x, w = scipy_events(
        stiffness, ones, friction, v, position, velocity, slip, end, contact=options["contact"]
    )
    # Events closer than the peer's accuracy may come in either order, and it misses a dip between samples.
    assume(len(expected) < 2 or np.diff([time for time, _, _ in expected]).min() > 1e-7)
    state = InitialState("drawn", tuple(position), tuple(velocity))
    for solver in SOLVERS[law]:
        settings = {"transient": 0.0, "window": end, "events": "all", "trajectory": 0.0, "start": options["start"]}
        model = Model(law, a=a, blocks=blocks, v=v, contact=options["contact"])
        run = simulate(model, state, solver=solver, **settings)
        assert run.status == "completed"
        assume(not (np.diff(run.event_time) < 2e-3).any())
        check_events(listed(run), expected, 1e-6)
        assert np.allclose(run.position[-1], x, atol=1e-7)
        assert np.allclose(run.velocity[-1], w, atol=1e-7)
