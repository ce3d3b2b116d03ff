"""Amplitudes and phases of normal modes, compared with closed forms, energies, and fits of sines."""

import warnings

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq, minimize

from burridge_knopoff import Chain, ChainState, Model, limit_cycle, mode_amplitudes, simulate
from burridge_knopoff.motion.modes import ModeAmplitudes
from tests.refused import refused

RANDOM = np.random.default_rng(11)

#: Rows, a ring, a grid, blocks without a spring to the driver, and unequal springs, thresholds and masses.
CHAINS = [
    Chain(1, pulling=0.7, mass=1.9),
    Chain(3),
    Chain(3, mass=(1.0, 1.0, 1.3)),
    Chain(2, coupling=3.0, pulling=(1.0, 0.0), mass=(0.4, 2.5)),
    Chain(5, mass=RANDOM.uniform(0.3, 3.0, 5), coupling=RANDOM.uniform(0.5, 2.0, 4), pulling=RANDOM.uniform(0.2, 2, 5)),
    Chain(6, ends="ring", pulling=1.0, threshold=RANDOM.uniform(0.8, 1.2, 6), mass=RANDOM.uniform(0.5, 2.0, 6)),
    Chain(grid=(3, 2), pulling=0.5, mass=RANDOM.uniform(0.5, 2.0, 6)),
]


def free(chain, a=0.0):
    """Return a model, and its modes with the scale of SciPy: frequencies, and shapes in rows."""
    square, columns = eigh(chain.stiffness, np.diag(chain.masses))
    return Model("linearized", a=a, chain=chain), np.sqrt(square), columns.T


@pytest.mark.parametrize("chain", CHAINS)
def test_constant_friction_leaves_each_mode_its_amplitude_and_its_frequency(chain):
    """At a = 0 all modes at once, from random amplitudes and phases at which no block stops."""
    model, omega, shape = free(chain)
    size = RANDOM.uniform(0.2, 1.0, len(omega))
    size *= 0.9 * model.v / np.abs(shape * (omega * size)[:, None]).sum(axis=0).max()
    phase = RANDOM.uniform(-np.pi, np.pi, len(omega))
    state = ChainState(
        (size * np.cos(phase)) @ shape, model.v - (omega * size * np.sin(phase)) @ shape, np.zeros(len(omega), bool)
    )
    modes = mode_amplitudes(model, state, 200.0)
    assert modes.frequency == pytest.approx(omega / (2.0 * np.pi), rel=1e-12)
    assert modes.shape @ np.diag(chain.masses) @ modes.shape.T == pytest.approx(np.eye(len(omega)), abs=1e-12)
    assert chain.stiffness @ modes.shape.T == pytest.approx(chain.masses[:, None] * modes.shape.T * omega**2, abs=1e-11)
    sign = np.sign((modes.shape * shape).sum(axis=1))
    assert np.abs(modes.amplitude - size).max() < 1e-11
    turned = np.exp(1j * (modes.phase - phase - modes.time[:, None] * omega)) * sign
    assert np.abs(turned - 1.0).max() < 1e-9


@pytest.mark.parametrize("chain", CHAINS)
@pytest.mark.parametrize("a", [0.05, 0.3])
def test_the_energies_of_the_modes_add_up_to_that_of_the_chain(chain, a):
    """Through sticks and slips, from positions and velocities of a run and without any mode."""
    model, _, _ = free(chain, a)
    at = simulate(model, initial={"position": [-0.7] * model.blocks, "velocity": [0.1] * model.blocks}, window=50.0)
    modes = mode_amplitudes(model, at.final, 60.0)
    every = simulate(
        model, initial=at.final, transient=0.0, window=60.0, trajectory=60.0, trajectory_sampling=modes.time[1]
    )
    assert every.event_count > 5
    x, u = every.position - model.sliding_offset, every.velocity - model.v
    energy = 0.5 * (u**2 @ chain.masses + np.einsum("ti,ij,tj->t", x, chain.stiffness, x))
    assert modes.energy.sum(axis=1) == pytest.approx(energy, rel=1e-7, abs=1e-10)
    assert (modes.amplitude * np.cos(modes.phase)) @ modes.shape == pytest.approx(x, abs=1e-8)


def test_the_lines_of_a_periodic_orbit_are_its_fourier_coefficients():
    """With a mass larger by half the motion at a = 0.06 is periodic; the coefficients are sums over one period."""
    model = Model("linearized", a=0.06).at(**{"mass[3]": 1.5})
    orbit = limit_cycle(model, simulate(model, initial="plus", transient=0.0, window=6000.0).final, settling=3000.0)
    period, count = orbit.period, 20_000
    run = simulate(
        model,
        initial=orbit.reference,
        transient=0.0,
        window=period,
        trajectory=period,
        trajectory_sampling=period / count,
    )
    coefficients = 2.0 * np.fft.rfft((run.position - model.sliding_offset)[:count], axis=0) / count
    modes = mode_amplitudes(model, orbit.reference)
    # Without the mean.
    strongest = 1 + np.abs(coefficients[1:]).sum(axis=1).argsort()[-4:]
    for k in strongest:
        line = modes.line(k / period)
        assert line @ modes.shape == pytest.approx(coefficients[k], abs=1e-6)
        kinetic = np.abs(coefficients[k]) ** 2 @ model.chain.masses
        assert modes.line_shares(k / period) == pytest.approx(np.abs(line) ** 2 / kinetic, abs=1e-6)


@pytest.mark.parametrize(
    ("position", "expected"),
    [
        # Vertices of the polyhedron of admissible amplitudes, as A ω of block 1, or of block 2 in the fast mode.
        ((0.079, 0.0578, 0.079), (1.0, 0.0, 0.0)),
        ((0.0705, 0.0, -0.0705), (0.0, 1.0, 0.0)),
        ((0.06, -0.044, -0.027), (0.0, 0.5 * (3.0 - np.sqrt(3.0)), 1.0)),
    ],
)
def test_as_a_vanishes_the_amplitudes_are_those_of_the_vertices(position, expected):
    model = Model("linearized", a=0.001)
    state = ChainState(np.array(position), np.full(3, model.v), np.zeros(3, bool))
    settled = simulate(model, initial=state, transient=0.0, window=20000.0, lyapunov_exponents=0).final
    modes = mode_amplitudes(model, settled, 1000.0)
    greatest = np.abs(modes.shape).max(axis=1)
    speed = 2.0 * np.pi * modes.frequency * modes.amplitude.mean(axis=0) * greatest / model.v
    assert speed == pytest.approx(expected, abs=0.02)


@pytest.mark.parametrize("blocks", [3, 4, 5, 8])
@pytest.mark.parametrize("waves", [1, 2])
def test_waves_along_a_ring_are_one_line_whatever_their_phase(blocks, waves):
    """Standing, travelling and between: two modes of one frequency share them, by a phase that means nothing."""
    ring = Chain(blocks, ends="ring", pulling=0.8)
    model, place = Model("linearized", a=0.0, chain=ring), 2.0 * np.pi * waves / blocks * np.arange(blocks)
    omega = np.sqrt(0.8 + 2.0 - 2.0 * np.cos(place[1]))
    for width in (0.0, 0.7, 1.0):
        for phase in (0.0, 0.4, 1.3):
            x = 0.02 * np.cos(place + phase)
            speed = model.v + 0.02 * width * omega * np.sin(place + phase)
            modes = mode_amplitudes(model, ChainState(x, speed, np.zeros(blocks, bool)), 500.0)
            shares = modes.line_shares(omega / (2.0 * np.pi))
            expected = np.isclose(2.0 * np.pi * modes.frequency, omega, rtol=1e-12).astype(float)
            assert expected.sum() == (1 if 2 * waves == blocks else 2)
            assert shares == pytest.approx(expected, abs=1e-9)


def test_modes_of_different_frequencies_keep_their_shares():
    """In a ring two waves of lengths 6 and 3, and in a row two modes, with energies of 1 to 4 at one frequency."""
    frequency, time = np.array([0.1, 0.2, 0.2, 0.3, 0.3, 0.3 + 1e-6]), np.arange(0.0, 4000.0, 0.5)
    power = np.array([4.0, 1.0, 2.0, 0.0, 3.0, 5.0])
    amplitude = np.sqrt(power) * np.ones((len(time), 1))
    phase = 2.0 * np.pi * 0.15 * time[:, None] + np.arange(6.0)
    modes = ModeAmplitudes(frequency, np.eye(6), time, amplitude, phase)
    assert modes.line_shares(0.15) == pytest.approx(np.array([4.0, 3.0, 3.0, 3.0, 3.0, 5.0]) / 15.0, rel=1e-6)


def end_shares(detuning, ratio, shift=0.0):
    """Return the shares of the modes if the end blocks oscillate and the middle block is at rest, and the modes.

    ratio : amplitude of block 3 over that of block 1; shift : of its phase from antiphase
    """
    masses = np.array([1.0, 1.0, 1.0 + detuning])
    _, _, shape = free(Chain(3, mass=masses))
    motion = np.array([1.0, 0.0, -ratio * np.exp(1j * shift)])
    return np.abs(shape @ (masses * motion)) ** 2 / (np.abs(motion) ** 2 @ masses), shape


def largest_share(detuning, ratio, shift=0.0):
    """Return the largest share of the second mode, whatever the amplitude and phase of the middle block: minimized."""
    masses = np.array([1.0, 1.0, 1.0 + detuning])
    _, _, shape = free(Chain(3, mass=masses))

    def other_modes(middle):
        motion = np.array([1.0, middle[0] + 1j * middle[1], -ratio * np.exp(1j * shift)])
        return -(np.abs(shape[1] @ (masses * motion)) ** 2) / (np.abs(motion) ** 2 @ masses)

    starts = ([0.1, 0.1], [-0.5, 0.2])
    return max(-minimize(other_modes, x, tol=1e-12).fun for x in starts)


@pytest.mark.parametrize(
    ("detuning", "at_rest", "moving"), [(0.1, 0.986, 0.990), (0.3, 0.902, 0.928), (0.5, 0.798, 0.848)]
)
def test_the_share_of_a_mode_in_end_blocks_of_equal_amplitudes(detuning, at_rest, moving):
    """Locked oscillators in antiphase, the middle block at rest or with any amplitude: by Cauchy's inequality.

    The motion of the middle block that suits a mode best adds the share of this block in the mode.
    """
    shares, shape = end_shares(detuning, 1.0)
    assert shares.sum() == pytest.approx(1.0, abs=1e-12)
    assert shares.max() == pytest.approx(at_rest, abs=5e-4)
    assert (shares + shape[:, 1] ** 2).max() == pytest.approx(moving, abs=5e-4)
    assert (shares + shape[:, 1] ** 2).max() == pytest.approx(largest_share(detuning, 1.0), abs=1e-9)
    assert (shares + shape[:, 1] ** 2).argmax() == 1
    # Away from antiphase the share of this mode falls, whatever the middle block does.
    shifted = [largest_share(detuning, 1.0, shift) for shift in (0.0, 0.25 * np.pi, 0.5 * np.pi)]
    assert shifted[0] > shifted[1] > shifted[2]


@pytest.mark.parametrize(("moving", "expected"), [(False, (0.391, 0.788)), (True, (0.317, 0.911))])
def test_the_share_of_a_mode_does_not_decide_at_unequal_amplitudes(moving, expected):
    """Ratios of the end blocks at which a mode has 95 % at a detuning of 0.3: its own is 0.569, those of locking 1."""

    def excess(ratio):
        shares, shape = end_shares(0.3, ratio)
        return (shares[1] + shape[1, 1] ** 2 if moving else shares[1]) - 0.95

    ends = [brentq(excess, *bracket) for bracket in ((0.1, 0.569), (0.569, 1.2))]
    assert ends == pytest.approx(expected, abs=5e-4)
    if moving:
        assert [largest_share(0.3, ratio) for ratio in ends] == pytest.approx([0.95, 0.95], abs=1e-8)


def test_a_state_or_a_chain_that_does_not_fit_is_refused():
    model = Model("linearized", a=0.06)
    state = ChainState(np.zeros(3), np.full(3, model.v), np.zeros(3, bool))
    with refused("duration: 0"):
        mode_amplitudes(model, state, 0)
    with refused("state", "4 blocks"):
        mode_amplitudes(Model("linearized", a=0.06, blocks=4), state)
    long = Model("linearized", a=0.06, blocks=20_000)
    with refused("model.blocks: 20000"):
        mode_amplitudes(long, (np.zeros(20_000), np.full(20_000, 0.1)))


def test_a_line_without_motion_or_beyond_the_sampling_has_no_shares():
    """In uniform sliding every x is 0; states at intervals of Δt resolve frequencies up to 1/(2Δt)."""
    model = Model("linearized", a=0.06)
    modes = mode_amplitudes(model, ChainState(np.zeros(3), np.full(3, model.v), np.zeros(3, bool)), 50.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert np.isnan(modes.line_shares(0.2)).all()
    highest = 0.5 / modes.time[1]
    assert modes.line(0.999 * highest).shape == (3,)
    for method in (modes.line, modes.line_shares):
        with refused("frequency"):
            method(1.001 * highest)
