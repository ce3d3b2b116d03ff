"""Symmetry to the bit: every engine preserves the symmetries of a chain and a state, at any stiffness.

Mirror images have their events at the same instant because their bits are equal, not because the events are close: the
rounding error of a spring force grows with the stiffness.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from burridge_knopoff import Chain, Model, law_of, simulate
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.running.ensemble import new_ensemble

#: Stiffness of the springs between neighbours and to the driver.
DASHPOTS = st.sampled_from([(0.0, 0.0), (0.3, 0.0), (0.0, 0.1), (1.0, 0.2)])
ENGINES = ("series", "map", "ensemble")
TIMES = 20


def states_of(engine, model, position, velocity, duration, start="moving"):
    """Return positions and velocities at TIMES instants, shape (TIMES, blocks), and how many events there were."""
    if engine == "ensemble":
        at = model.begin(InitialState("drawn", tuple(position), tuple(velocity)), start)
        times = np.linspace(0.0, duration, TIMES + 1)[1:]
        results = new_ensemble(model).run(at.position[None], at.velocity[None], at.stuck[None], times)
        return results["position"][0] + model.sliding_offset, results["velocity"][0], results["event_count"][0]
    whole = {"transient": 0.0, "window": duration, "sampling": duration, "trajectory": duration}
    run = simulate(
        model,
        initial=(position, velocity),
        **whole,
        solver=engine,
        trajectory_sampling=duration / TIMES,
        events="none",
        lyapunov_exponents=0,
        start=start,
    )
    return run.position[-TIMES:], run.velocity[-TIMES:], run.event_count


@st.composite
def chains(draw, ends=("open", "ring")):
    """A chain of up to 25 blocks, its model, a state, and a time in which blocks stick and slip."""
    generator = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    end = draw(st.sampled_from(ends))
    blocks = draw(st.integers(2 if end == "open" else 3, 25))
    coupling = 10.0 ** draw(st.floats(-3.0, 6.0))
    pulling = draw(st.sampled_from([0.1, 1.0, 40.0]))
    threshold = draw(st.sampled_from([1e-3, 1.0, 50.0]))
    v = threshold * draw(st.sampled_from([0.01, 0.1, 1.0]))
    law = law_of(
        draw(st.sampled_from(["linearized", "nonlinear"])), a=generator.uniform(0.0, 0.4) / max(1.0, threshold)
    )
    damping, pulling_damping = (size * (coupling * pulling) ** 0.25 for size in draw(DASHPOTS))
    chain = Chain(blocks, coupling, pulling, threshold, end, damping=damping, pulling_damping=pulling_damping)
    model = Model(law, chain=chain, v=v, contact=draw(st.sampled_from(["one_sided", "symmetric"])))
    size = threshold / (coupling + pulling) * draw(st.sampled_from([1e-3, 0.1, 1.0]))
    position = size * generator.normal(size=blocks)
    velocity = v * draw(st.sampled_from([0.0, 1.0, 3.0])) * abs(generator.normal(size=blocks))
    return model, position, velocity, min(100.0, 100.0 / chain.highest_frequency + 5.0 / pulling**0.5)


def are_equal(one, other):
    """Return whether states are equal to the bit; after the end of unbounded motion they are NaN."""
    return np.array_equal(one, other, equal_nan=True)


def own_image(values):
    """Return values that are their own mirror image, half of them as given."""
    return np.where(np.arange(len(values)) < len(values) // 2, values[::-1], values)


def engines_of(model):
    return [engine for engine in ENGINES if engine != "map" or model.has_closed_form]


@settings(max_examples=60)
@given(chains(), st.sampled_from(["moving", "tested"]))
def test_a_state_that_is_its_own_mirror_image_stays_so(drawn, start):
    model, position, velocity, duration = drawn
    for engine in engines_of(model):
        x, u, _ = states_of(engine, model, own_image(position), own_image(velocity), duration, start)
        assert are_equal([x, u], np.array([x, u])[..., ::-1])


@settings(max_examples=40)
@given(chains())
def test_mirror_images_move_as_mirror_images(drawn):
    model, position, velocity, duration = drawn
    for engine in engines_of(model):
        x, u, count = states_of(engine, model, position, velocity, duration)
        other_x, other_u, other_count = states_of(engine, model, position[::-1], velocity[::-1], duration)
        assert are_equal([x, u], np.array([other_x, other_u])[..., ::-1])
        assert count == other_count


@settings(max_examples=40)
@given(chains(("ring",)), st.integers(1, 24), st.integers(1, 5))
def test_a_ring_has_no_first_block(drawn, turn, period):
    """A rotated state has the rotated motion; a state that is periodic along the ring stays periodic."""
    model, position, velocity, duration = drawn
    blocks = model.blocks // period * period
    repeated = Model(model.law, chain=replace(model.chain, blocks=max(blocks, 3), threshold=1.0), v=model.v)
    x, u, _ = states_of("series", model, position, velocity, duration)
    other_x, other_u, _ = states_of("series", model, np.roll(position, turn), np.roll(velocity, turn), duration)
    assert (np.roll([x, u], turn, axis=2) == np.array([other_x, other_u])).all()
    for engine in ("series", "ensemble") if blocks >= 3 else ():
        tiled = [np.tile(values[:period], blocks // period) for values in (position, velocity)]
        x, u, _ = states_of(engine, repeated, *tiled, duration)
        assert (np.roll([x, u], period, axis=2) == np.array([x, u])).all()


@pytest.mark.parametrize("engine", ENGINES)
def test_stiff_springs_of_three_blocks(engine):
    """Asymmetric perturbations of this state grow as exp(0.039 τ), but ⟨J⟩ must stay 0."""
    model = Model("linearized", a=0.3, coupling=250.0, pulling=1.0)
    x, u, count = states_of(engine, model, (-1.0, -0.95, -1.0), (0.1, 0.12, 0.1), 2000.0)
    assert count > 1000
    assert (np.array([x, u]) == np.array([x, u])[..., ::-1]).all()


@pytest.mark.parametrize("engine", ["series", "ensemble"])
def test_stiff_springs_of_five_blocks(engine):
    """From rest, with dimensional springs; mirror blocks must start at the same time, and ⟨J⟩ must stay 0."""
    model = Model("nonlinear", a=1.0, blocks=5, coupling=250.0, pulling=40.0, threshold=50.0, v=0.01)
    position = 1e-4 * np.array([4.0, -3.0, 2.0, -3.0, 4.0])
    x, u, count = states_of(engine, model, position, np.zeros(5), 2000.0, "tested")
    assert count > 100
    assert (np.array([x, u]) == np.array([x, u])[..., ::-1]).all()


@pytest.mark.parametrize("coupling", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("apart", [1e-9, 1e-12])
def test_starts_at_different_times_keep_their_order(coupling, apart):
    """Stuck blocks start when pulling · v τ equals what their forces lack, here 0.5 and 0.5 + 0.1 `apart`."""
    v, force = 0.1, np.array([0.5, 0.5 - 0.1 * apart, 0.5])
    chain = Chain(3, coupling, pulling=1.0)
    position = -np.linalg.solve(chain.stiffness, force)
    model = Model("linearized", a=0.1, chain=chain, v=v)
    whole = {"transient": 0.0, "window": 5.5, "events": "all", "lyapunov_exponents": 0}
    run = simulate(model, initial=(position, (0.0, 0.0, 0.0)), **whole, start="tested")
    rounding = 1e-15 * (1.0 + coupling * abs(position).max()) / v
    first = [run.event_time[run.event_block == block][0] for block in (1, 2, 3)]
    assert first == pytest.approx([5.0, 5.0 + apart, 5.0], abs=4 * rounding)
    if apart > 8 * rounding:
        assert first[0] < first[1] > first[2]


@pytest.mark.parametrize("grid", [(3, 3), (4, 3), (6, 5)])
@pytest.mark.parametrize("engine", ["series", "ensemble"])
def test_grids_from_left_to_right(grid, engine):
    """docs/model.md guarantees identical bits only for this reflection; others change the order of sums of forces."""
    columns, rows = grid
    generator = np.random.default_rng(columns)
    left = generator.uniform(-1.2, -0.4, (rows, columns))
    position = np.minimum(left, left[:, ::-1])
    model = Model("carlson_langer", a=3.0, grid=grid, coupling=3.0, pulling=1.0, v=0.1)
    x, u, count = states_of(engine, model, position.ravel(), np.zeros(columns * rows), 60.0, "tested")
    assert count > 50
    fields = np.reshape([x, u], (2, TIMES, rows, columns))
    assert (fields == fields[..., ::-1]).all()
