"""One block against its closed form; chains pulled at some blocks only; the section of one block."""

import mpmath
import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, Section, simulate
from burridge_knopoff.running.ensemble import new_ensemble
from tests.flows import carry, wave
from tests.kernel.test_ensemble import check_against_scalar
from tests.refused import refused

TRAIN = Chain(2, pulling=(1.0, 0.0))
CHAINS = [Chain(1), Chain(1, pulling=2.5, threshold=1.3), TRAIN, Chain(4, pulling=(0.0, 1.5, 0.0, 0.0))]


def cycle(pulling, threshold, a, v):
    """Return how long one block slips and sticks in its limit cycle, to 30 digits, under the linearized law.

    The slip begins at s = threshold: x'' = −k x + θ a x' with x = −θ a v/k and x' = −v at the start, a growing
    oscillation, and ends at x' = −v again, before a whole period. The block then sticks until its force, which grows as
    k v τ, reaches its threshold.
    """
    with mpmath.workdps(30):
        k, theta, a, v = map(mpmath.mpf, (pulling, threshold, a, v))
        half = theta * a / 2
        omega = mpmath.sqrt(k - half**2)
        first, rate = -theta * a * v / k, -v

        def oscillation(t, start, sine):
            return mpmath.exp(half * t) * (start * mpmath.cos(omega * t) + sine / omega * mpmath.sin(omega * t))

        ends = mpmath.pi / omega, 2 * mpmath.pi / omega
        slip = mpmath.findroot(lambda t: oscillation(t, rate, half * rate - k * first) + v, ends, "anderson")
        force = theta * (1 - a * v) - k * oscillation(slip, first, rate - half * first)
        return float(slip), float((theta - force) / (k * v))


@pytest.mark.parametrize("a", [0.02, 0.08, 0.3])
@pytest.mark.parametrize("chain", CHAINS[:2])
def test_one_block_agrees_with_its_closed_form(chain, a):
    model = Model("linearized", a=a, chain=chain)
    slip, stick = cycle(chain.driving[0], chain.thresholds[0], a, model.v)
    # At its threshold and about to slip: on the cycle.
    at = float(-(chain.thresholds[0] - model.v * 1e-3) / chain.driving[0])
    start = model.begin(InitialState("own", (at,), (0.0,)), "tested")
    for solver in ("series", "map"):
        _, events = carry(model, start, 60.0, solver=solver)
        time, block, kind = np.array(events).T
        assert (block == 1).all()
        assert kind.tolist() == [1.0, 0.0] * (len(kind) // 2) + [1.0] * (len(kind) % 2)
        lasting = np.diff(time)
        assert lasting[::2] == pytest.approx(np.full(lasting[::2].shape, slip), rel=0, abs=1e-12)
        assert lasting[1::2] == pytest.approx(np.full(lasting[1::2].shape, stick), rel=0, abs=1e-12)


def test_one_block_has_no_distance_and_two_exponents(law):
    run = simulate(Model(law, a=0.2, blocks=1), ((-0.9,), (0.1,)))
    assert run.status == "completed"
    assert (run.distance == 0.0).all()
    assert run.mean_distance == 0.0
    assert run.lyapunov_exponent.shape == (2,)
    assert abs(run.lyapunov_exponent[0]) < 5e-4
    assert run.lyapunov_exponent[1] == -np.inf


@pytest.mark.parametrize("contact", ["one_sided", "symmetric"])
@pytest.mark.parametrize("chain", CHAINS)
def test_lanes_against_one_state(law, chain, contact):
    model = Model(law, a=0.2, chain=chain, contact=contact)
    assert check_against_scalar(model, new_ensemble(model), 10, 12.0) > 10


def test_co_moving_coordinates_of_the_train():
    """D = (1, 0), K = [[2, −1], [−1, 1]]; K·1 = D, and e = −Φ K⁻¹·1 = −Φ (2, 3)."""
    assert TRAIN.stiffness.tolist() == [[2.0, -1.0], [-1.0, 1.0]]
    assert TRAIN.driving.tolist() == [1.0, 0.0]
    assert TRAIN.sliding_offset(0.9) == pytest.approx([-1.8, -2.7], rel=0, abs=1e-15)
    assert not TRAIN.is_mirror_symmetric


@pytest.mark.parametrize("blocks", [3, 4, 9])
def test_section_of_one_block(law, blocks):
    """Its crossings are the sign changes of x_n of a dense trajectory, with U_n' − v there."""
    options = {"transient": 10.0, "window": 50.0, "batches": 2, "trajectory": 60.0, "trajectory_sampling": 1e-3}
    runs = [
        simulate(Model(law, a=0.2, blocks=blocks), wave(blocks), section=Section("block", n), **options)
        for n in (1, blocks)
    ]
    for n, run in zip((1, blocks), runs, strict=True):
        inside = run.trajectory_time >= 10.0
        time, x, w = (
            run.trajectory_time[inside],
            *(values[inside, n - 1] for values in (run.position - run.model.sliding_offset, run.velocity)),
        )
        change = np.nonzero(np.sign(x[1:]) * np.sign(x[:-1]) < 0)[0]
        assert len(change) == len(run.crossing_time) > 5
        assert np.all((time[change] <= run.crossing_time) & (run.crossing_time <= time[change + 1]))
        assert np.abs(np.interp(run.crossing_time, time, w) - run.model.v - run.crossing_velocity).max() < 1e-4
    assert np.array_equal(runs[0].position, runs[1].position)


def test_the_section_is_part_of_all_forms_of_settings():
    forms = ("block=2", {"of": "block", "block": 2}, Section("block", 2))
    options = {"transient": 0.0, "window": 30.0, "batches": 2}
    times = [
        simulate(Model("linearized", a=0.1), "plus", section=section, **options).crossing_time for section in forms
    ]
    assert len(times[0]) > 3
    assert all(np.array_equal(times[0], other) for other in times)
    run = simulate(Model("linearized", a=0.1), "plus", section="block=2", **options)
    assert run.to_dataset().attrs["section"] == "block=2"
    assert run.to_dataset().attrs["history"].endswith("--section block=2")


@pytest.mark.parametrize(
    ("section", "message"),
    [
        ("block=4", "section.block: 4"),
        ("block", "section.block: 0"),
        ({"of": "sum", "block": 1}, "section.block: 1"),
        ("all", "section.of: 'all'"),
        (2, "section: 2"),
        *((f"block={text}", f"section.block: {text!r}") for text in ("two", "02", "1_0", "٢")),
    ],
)
def test_sections_that_are_refused(section, message):
    with refused(message):
        simulate(Model("linearized", a=0.1), "plus", section=section)
