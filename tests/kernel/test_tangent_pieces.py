"""The tangent map of event-free pieces against SciPy and matrix exponentials, and of one solver against the other."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from burridge_knopoff.laws import law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import Instant, Model
from tests.kernel.flows import carry, directions

CONTACTS = ("one_sided", "symmetric")


def variational(model, start, end):
    """Integrate motion and perturbations of an event-free piece with SciPy."""
    blocks = model.chain.blocks
    stiffness, a, v = model.chain.stiffness, model.a, model.v
    sliding = float(model.law(v))
    slips = ~start.stuck
    sign = np.where(start.velocity < 0.0, -1.0, 1.0)

    def slope(_, y):
        position, velocity = y[:blocks], y[blocks : 2 * blocks]
        matrix = y[2 * blocks :].reshape(2 * blocks, -1)
        weakening = 1.0 / (1.0 + a * sign * velocity)
        acceleration = slips * (sliding - stiffness @ position - sign * weakening)
        change = slips[:, None] * (-stiffness @ matrix[:blocks] + (a * weakening**2)[:, None] * matrix[blocks:])
        return np.concatenate([velocity - v, acceleration, np.vstack([matrix[blocks:], change]).ravel()])

    begin_with = np.concatenate([start.vector(), directions(start).ravel()])
    run = solve_ivp(slope, (0.0, end), begin_with, "DOP853", rtol=1e-13, atol=1e-18)
    return run.y[2 * blocks :, -1].reshape(2 * blocks, -1)


@pytest.mark.parametrize(
    ("amplitude", "end"),
    [
        (0.05, 1e-3),
        (0.05, 0.4),
        (1e-3, 2.9),
        (1e-3, 9.0),
        (1e-6, 9.0),
        (1e-10, 9.0),
        (1e-14, 2.9),
        (0.0, 2.9),
        (0.0, 9.0),
    ],
)
@pytest.mark.parametrize("blocks", [2, 3, 6])
def test_nonlinear_pieces_against_scipy(blocks, amplitude, end):
    """However small the motion: the perturbations obey equations whose terms are of order 1.

    An absolute 1e-18 lets SciPy follow the smallest of these motions; its error is 1e-13 of the map per unit of time.
    """
    model = Model(Chain(blocks), law_of("nonlinear", 0.3))
    wave = np.sin(1.0 + 2.0 * np.arange(2 * blocks))
    start = Instant(amplitude * wave[:blocks], 0.1 + amplitude * wave[blocks:], np.zeros(blocks, dtype=bool))
    solver, events = carry(model, start, end, directions(start))
    assert events == []
    expected = variational(model, start, end)
    assert np.abs(solver.perturbations - expected).max() < 1e-11 * np.abs(expected).max()


def test_a_nonlinear_piece_beside_stuck_blocks_and_backward_against_scipy():
    model = Model(Chain(5), law_of("nonlinear", 0.9), contact="symmetric")
    start = Instant(
        np.array([0.1, 0.3, 0.0, 0.3, -0.1]),
        np.array([0.8, 0.0, 0.9, 0.0, -0.7]),
        np.array([False, True, False, True, False]),
    )
    solver, events = carry(model, start, 0.2, directions(start))
    assert events == []
    assert np.abs(solver.perturbations - variational(model, start, 0.2)).max() < 1e-12


@pytest.mark.parametrize("solver_name", ["map", "series"])
@pytest.mark.parametrize(
    ("stuck", "end", "amplitude"),
    [
        ((), 25.0, 0.0),
        ((), 25.0, 1e-7),
        ((), 0.4, 0.05),
        ((), 1e-9, 0.05),
        ((1,), 0.4, 0.05),
        ((0, 2), 0.4, 0.05),
        ((2, 3), 1e-9, 0.05),
        ((2, 3), 0.4, 0.05),
    ],
)
def test_linearized_pieces_against_the_matrix_exponential(solver_name, stuck, end, amplitude):
    blocks, a = 5, 0.3
    model = Model(Chain(blocks), law_of("linearized", a))
    wave = np.sin(1.0 + 2.0 * np.arange(2 * blocks))
    held = np.isin(np.arange(blocks), stuck)
    position = amplitude * wave[:blocks] + 0.3 * held
    start = Instant(position, np.where(held, 0.0, 0.1 + amplitude * wave[blocks:]), held)
    solver, events = carry(model, start, end, directions(start), solver_name)
    assert events == []
    slips = np.diag(1.0 - held)
    generator = np.block([[np.zeros((blocks, blocks)), slips], [-slips @ model.chain.stiffness, a * slips]])
    expected = expm(generator * end) @ directions(start)
    assert np.abs(solver.perturbations - expected).max() < 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("contact", CONTACTS)
def test_map_and_series_carry_the_same_perturbations(contact):
    model = Model(Chain(3), law_of("linearized", 0.12), contact=contact)
    start = model.begin(PAPER_STATES["plus"])
    matrices = []
    for solver_name in ("map", "series"):
        solver, events = carry(model, start, 60.0, directions(start), solver_name)
        assert len(events) > 40
        matrices.append(solver.perturbations)
    assert np.allclose(*matrices, rtol=0.0, atol=1e-10 * np.abs(matrices[0]).max())
