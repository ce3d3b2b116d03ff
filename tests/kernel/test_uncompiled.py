"""Compiled and uncompiled, the kernel makes the same numbers, bit for bit."""

import json

import numpy as np
import pytest

from burridge_knopoff.simulation import simulate
from tests.kernel.pure import run_uncompiled

CODE = """
import json
from burridge_knopoff.kernel import event_driven
assert event_driven.__file__.endswith(".py")
from burridge_knopoff.simulation import simulate
run = simulate({law!r}, {a}, {initial!r}, solver={solver!r}, transient=10.0, window=30.0, events="all",
               sampling=1.0, step=0.01, contact={contact!r}, lyapunov_exponents=5)
print(json.dumps([[x.hex() for x in map(float, values)] for values in (
    run.event_time, run.event_block, run.event_position.ravel(), run.event_velocity.ravel(), run.distance,
    run.crossing_time, run.crossing_velocity, run.position.ravel(),
    run.lyapunov_exponent, run.lyapunov_error, run.batch_lyapunov_exponent.ravel(), [run.lyapunov_infinite_count],
    [run.mean_distance, run.mean_distance_error, run.least_friction, run.least_spring_force, run.step_count])]))
"""


@pytest.mark.parametrize(
    ("law", "solver", "initial", "a", "contact"),
    [
        ("linearized", "map", "plus", 0.08, "one_sided"),
        ("linearized", "map", "plus", 0.2, "symmetric"),
        ("linearized", "series", "minus", 0.08, "one_sided"),
        ("nonlinear", "series", "plus", 0.25, "symmetric"),
        ("nonlinear", "rk4", "plus", 0.08, "one_sided"),
        ("linearized", "series", "plus", 0.2, "symmetric"),
    ],
)
def test_same_bits(tmp_path, law, solver, initial, a, contact):
    uncompiled = json.loads(
        run_uncompiled(tmp_path, CODE.format(law=law, solver=solver, initial=initial, a=a, contact=contact))
    )
    run = simulate(
        law,
        a,
        initial,
        solver=solver,
        transient=10.0,
        window=30.0,
        events="all",
        sampling=1.0,
        step=0.01,
        contact=contact,
        lyapunov_exponents=5,
    )
    compiled = [
        [x.hex() for x in map(float, values)]
        for values in (
            run.event_time,
            run.event_block,
            run.event_position.ravel(),
            run.event_velocity.ravel(),
            run.distance,
            run.crossing_time,
            run.crossing_velocity,
            run.position.ravel(),
            run.lyapunov_exponent,
            run.lyapunov_error,
            run.batch_lyapunov_exponent.ravel(),
            [run.lyapunov_infinite_count],
            [run.mean_distance, run.mean_distance_error, run.least_friction, run.least_spring_force, run.step_count],
        )
    ]
    assert len(run.event_time) > 10
    assert np.isfinite(run.lyapunov_exponent[:3]).all() == (solver != "rk4")
    assert uncompiled == compiled


def test_the_package_under_test_is_compiled():
    from burridge_knopoff.kernel import event_driven

    assert not event_driven.__file__.endswith(".py")
