"""Results of the library can be copied and passed between processes without changing a bit."""

import copy
import pickle
from concurrent.futures import ProcessPoolExecutor
from dataclasses import fields, is_dataclass
from functools import partial

import numpy as np
import pytest

from burridge_knopoff import (
    Chain,
    FormulaLaw,
    InitialState,
    Model,
    find_attractors,
    law_of,
    record_events,
    simulate,
    synchronized_orbit,
)
from tests.refused import refused

COPIES = {"pickle": lambda value: pickle.loads(pickle.dumps(value)), "deepcopy": copy.deepcopy}
ROUGH = InitialState("rough", {"random": "uniform", "low": -1.0, "high": -0.9, "seed": 1}, 0.0)
PAPER = Model("linearized", a=0.1)
TRAIN = Model("carlson_langer", a=3.0, blocks=30, coupling=9, pulling=1, v=0.01)


def equal(one, other):
    """Return whether two results have the same bits."""
    if type(one) is not type(other):
        return False
    if isinstance(one, np.ndarray):
        return one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes()
    if is_dataclass(one):
        return all(equal(getattr(one, item.name), getattr(other, item.name)) for item in fields(one))
    if hasattr(one, "__getstate__") and type(one).__name__ in ("Mark", "StepMark"):
        return one.__getstate__() == other.__getstate__()
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(equal, one, other))
    return one == other or (one != one and other != other)


def run(**settings):
    return simulate(PAPER, initial="plus", transient=20.0, window=30.0, **settings)


RESULTS = {
    "chain": lambda: Chain(
        4, coupling=(1.0, 2.0, 0.5), threshold={"random": "uniform", "low": 1, "high": 2, "seed": 3}
    ),
    "grid": lambda: Chain(grid=(3, 2)),
    "law": lambda: law_of("stribeck", a=0.3),
    "formula": lambda: FormulaLaw("1/(1 + a*u)**p", name="power", a=0.04, p=2.0),
    "model": lambda: TRAIN,
    "state": lambda: TRAIN.begin(ROUGH, "tested"),
    "run": run,
    "run in closed form": lambda: run(solver="map"),
    "run of fixed steps": lambda: run(solver="rk4"),
    "catalogue": lambda: record_events(TRAIN, TRAIN.begin(ROUGH, "tested"), 150.0, profiles=True),
    "attractors": lambda: find_attractors(PAPER, samples=4, transient=500.0, window=500.0),
    "orbit": lambda: synchronized_orbit(PAPER),
}


@pytest.mark.parametrize("copied", COPIES.values(), ids=COPIES)
@pytest.mark.parametrize("result", RESULTS.values(), ids=RESULTS)
def test_a_copy_has_the_same_bits(result, copied):
    original = result()
    assert equal(copied(original), original)


@pytest.mark.parametrize("copied", COPIES.values(), ids=COPIES)
def test_cached_arrays_of_a_copy_are_read_only_too(copied):
    chain = Chain(3)
    assert [item.driving.flags.writeable for item in (chain, copied(chain))] == [False, False]


CONTINUED = {
    "as a whole": (PAPER, "plus", {}),
    "closed form": (PAPER, "plus", {"solver": "map"}),
    "fixed steps": (PAPER, "plus", {"solver": "rk4"}),
    "groups": (TRAIN, ROUGH, {"lyapunov_exponents": 0}),
    "groups as a whole": (TRAIN, ROUGH, {"lyapunov_exponents": 2}),
}


@pytest.mark.parametrize("copied", COPIES.values(), ids=COPIES)
@pytest.mark.parametrize(("model", "initial", "settings"), CONTINUED.values(), ids=CONTINUED)
def test_a_run_continues_from_a_copied_state(model, initial, settings, copied):
    settings = {"window": 20.0, "events": "all", **settings}
    first = simulate(model, initial=initial, start="tested", transient=40.0, **settings)
    whole, other = (
        simulate(model, initial=state, transient=10.0, **settings) for state in (first.final, copied(first.final))
    )
    assert whole.event_count
    assert equal(whole, other)


@pytest.mark.parametrize("copied", COPIES.values(), ids=COPIES)
@pytest.mark.parametrize("options", [{}, {"loading": "quasistatic"}, {"solver": "euler", "step": 0.01}], ids=str)
def test_a_catalogue_continues_from_a_copied_state(options, copied):
    """The first catalogue ends within an event, whose beginning the copy must contain."""
    first = record_events(TRAIN, TRAIN.begin(ROUGH, "tested"), 60.0, **options)
    end = first.final.time
    while options.get("loading") != "quasistatic" and first.final.stuck.all():
        end += 1.0
        first = record_events(TRAIN, first.final, end, **options)
    whole, other = (record_events(TRAIN, state, end + 60.0, **options) for state in (first.final, copied(first.final)))
    assert len(whole.time)
    assert equal(whole, other)


def test_runs_in_other_processes():
    call = partial(simulate, window=20.0, transient=20.0, events="all")
    models = [Model("linearized", a=0.08), Model("nonlinear", a=0.1)]
    with ProcessPoolExecutor(2) as pool:
        runs = list(pool.map(call, models, ["plus", "minus"]))
    assert equal(runs, [call(models[0], "plus"), call(models[1], "minus")])
    longer = [simulate(run.model, initial=run.final, transient=0.0, window=20.0) for run in runs]
    assert [run.status for run in longer] == ["completed"] * 2


def test_a_state_of_another_version_is_refused():
    step = run().final.last_step[1]
    for bytes_ in (b"", step.__getstate__()[:-1], step.__getstate__() + b"\0"):
        with refused("state", "version"):
            type(step).__new__(type(step)).__setstate__(bytes_)
