"""Uniform sliding over law and a: where the blocks lie, and how perturbations of it grow.

In uniform sliding U_i = vτ + e_i with K e = −Φ(av)·1. A perturbation obeys δU'' = −K δU + g δU' with the slope
g = −dΦ(aU')/dU' at U' = v, which is a under the linearized law and a Φ(av)² under the nonlinear one. A normal mode of K
with the eigenvalue κ has λ² − gλ + κ = 0, so that the Jacobian [[0, 1], [−K, g]] has the eigenvalues
λ = g/2 ± i sqrt(κ − g²/4): all real parts are g/2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import xarray
from scipy.linalg import eigvalsh_tridiagonal, solveh_banded

from burridge_knopoff.chain import Chain
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable
from burridge_knopoff.friction import LAWS, Friction
from burridge_knopoff.initial import InitialState
from burridge_knopoff.stability.flow import COMPLETED, RUNNING, Instant, Model, begin, instant, new_solver

#: Time for which the equations are simulated from uniform sliding: a few periods of the slowest mode.
DURATION = 20.0

PARTS = ("real", "imaginary")

# Figures of numbers that come from LAPACK, whose last bits depend on the machine.
DIGITS = 12

_CURVE = ("law", "a")
VARIABLES = {
    "equilibrium_position": Variable(
        (*_CURVE, "block"), "f8", "position e = U - v*tau of a block in uniform sliding", {"comment": "K e = -Phi(a v)"}
    ),
    "equilibrium_drift": Variable(
        _CURVE, "f8", "largest distance of a block from uniform sliding when it has been simulated for a while from it"
    ),
    "eigenvalue": Variable(
        (*_CURVE, "mode", "part"), "f8", "eigenvalues lambda of the Jacobian at uniform sliding, pair by pair"
    ),
    "growth_rate": Variable(
        _CURVE, "f8", "growth rate of the perturbation that grows most, from the tangent flow of the simulation"
    ),
}
_COORDINATES = {
    "block": Variable(("block",), "i2", "block number, 1 to N along the chain", coordinate=True),
    "mode": Variable(("mode",), "i2", "number of the eigenvalue, from the slowest oscillation on", coordinate=True),
    "part": Variable(("part",), "O", "part of a complex number", coordinate=True),
}


def summarize(blocks: int, grid: Sequence[float], v: float) -> xarray.Dataset:
    """Return position, simulated drift, eigenvalues and simulated growth rate of uniform sliding at each a."""
    sizes = {"law": len(LAWS), "a": len(grid), "block": blocks, "mode": 2 * blocks, "part": len(PARTS)}
    values = {name: np.full([sizes[key] for key in item.dimensions], np.nan) for name, item in VARIABLES.items()}
    for i, law in enumerate(LAWS):
        for k, a in enumerate(grid):
            model = Model(Chain(blocks), Friction(law, a), v)
            position = sliding_position(model)
            values["equilibrium_position"][i, k] = position
            found = eigenvalues(model)
            values["eigenvalue"][i, k] = np.stack([found.real, found.imag], axis=-1)
            values["equilibrium_drift"][i, k], values["growth_rate"][i, k] = simulate_sliding(model, position)
    shared = axes((), grid)
    coordinates = {"law": shared["law"], "a": shared["a"]}
    labels = {"block": np.arange(1, blocks + 1), "mode": np.arange(1, 2 * blocks + 1), "part": PARTS}
    for name, item in _COORDINATES.items():
        coordinates[name] = (name, np.array(labels[name], dtype=item.dtype), item.all_attributes())
    return summary(
        "Uniform sliding and the growth of its perturbations",
        VARIABLES,
        values,
        coordinates,
        {"history": "snakemake, from the equations of motion", "v": v, "duration": DURATION},
        module=__name__,
    )


def sliding_position(model: Model) -> np.ndarray:
    """Return e with K e = −Φ(av)·1, shape (blocks,), in a way that the simulation has no part in."""
    stiffness = model.chain.stiffness
    bands = np.stack([np.append(0.0, np.diag(stiffness, 1)), np.diag(stiffness)])
    return solveh_banded(bands, np.full(model.chain.blocks, -float(model.friction(model.v))))


def friction_slope(model: Model) -> float:
    """Return g = −dΦ(aU')/dU' at the velocity of the driver."""
    a = model.friction.a
    return a if model.friction.law == "linearized" else a * float(model.friction(model.v)) ** 2


def eigenvalues(model: Model) -> np.ndarray:
    """Return the eigenvalues of the Jacobian at uniform sliding, shape (2 blocks,).

    Pairs λ = g/2 ± i sqrt(κ − g²/4), the positive imaginary part first, in the order of the eigenvalues κ of K; these
    lie above 1, and g is below 2, so that every mode oscillates.
    """
    stiffness = model.chain.stiffness
    kappa = eigvalsh_tridiagonal(np.diag(stiffness), np.diag(stiffness, 1), lapack_driver="sterf")
    half = 0.5 * friction_slope(model)
    frequency = np.array([_rounded(value) for value in np.sqrt(kappa - half**2)])
    return (half + 1j * frequency[:, None] * np.array([1.0, -1.0])).ravel()


def simulate_sliding(model: Model, position: np.ndarray) -> tuple[float, float]:
    """Simulate uniform sliding from U(0) = position; return the largest |x_i| at the end, and the growth rate.

    The tangent map M of the simulation over the time t has the eigenvalues exp(λt); the growth rate is the logarithm of
    the largest modulus over t. NaN if the run does not complete.
    """
    start = begin(model, InitialState("sliding", tuple(position), (model.v,) * model.chain.blocks))
    solver = new_solver(model, perturbations=np.eye(2 * model.chain.blocks))
    solver.end = DURATION
    solver.begin(start.position, start.velocity, start.stuck)
    while (code := solver.run()) == RUNNING:
        pass
    if code != COMPLETED:
        return math.nan, math.nan
    end: Instant = instant(solver)
    moduli = np.abs(np.linalg.eigvals(solver.tangent.matrix()))
    rate = round(math.log(float(moduli.max())) / DURATION, DIGITS)
    # Adding 0 turns -0.0 into 0.0.
    return float(np.abs(end.position).max()), rate + 0.0


def _rounded(value: float) -> float:
    """Return a number to the figures that every machine agrees on."""
    return float(f"{value:.{DIGITS - 1}e}")
