"""Uniform sliding over (law, a): the positions of the blocks, and the growth of perturbations.

In uniform sliding U_i = vτ + e_i with K e = −Φ(w v)·threshold. A perturbation obeys δU'' = −M⁻¹K δU + G δU' with the
diagonal matrices M of the masses and G of g_i = −threshold_i·dΦ(w_i U')/dU'/m_i at U' = v. Under the linearized law,
with thresholds, masses and weakenings w of 1, all g_i are a. The growth rates are the eigenvalues λ of the Jacobian
[[0, 1], [−M⁻¹K, G]]. If all g_i have the same value g, a normal mode of M⁻¹K with eigenvalue κ has λ² − gλ + κ = 0.
Thus λ = g/2 ± i sqrt(κ − g²/4): the real part of every oscillating mode is g/2.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray
from scipy.linalg import solve, solveh_banded

from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable
from burridge_knopoff.laws.blend import mirror_law
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Model, at_recorded_a
from burridge_knopoff.model.uniform_sliding import DIGITS, eigenvalues, round_digits
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.summaries.sentences import at_value, lines_of, values_where

#: Growth rates up to this one are rounding errors.
ROUNDING = 1e-10

#: Time for which uniform sliding is simulated: a few periods of the slowest mode of the paper's chain.
DURATION = 20.0

# Logarithm of the largest growth of a perturbation in that time; if growth is faster, the time is shorter.
LARGEST_GROWTH = 20.0

PARTS = ("real", "imaginary")

#: Largest number of blocks: the modes of larger chains take hours, and their matrices need more memory than there is.
MAX_BLOCKS = 1024

_CURVE = ("law", "a")
VARIABLES = {
    "equilibrium_position": Variable(
        (*_CURVE, "block"),
        "f8",
        "position e in uniform sliding: e = U - v*tau",
        {"comment": "K e = -Phi(w v) threshold, with the weakening w"},
    ),
    "equilibrium_drift": Variable(
        _CURVE,
        "f8",
        "drift from uniform sliding: largest distance of a block from uniform sliding at the end of a "
        "simulation that starts there",
    ),
    "eigenvalue": Variable(
        (*_CURVE, "mode", "part"), "f8", "eigenvalue lambda: of the Jacobian at uniform sliding, in pairs"
    ),
    "growth_rate": Variable(
        _CURVE, "f8", "growth rate: of the fastest-growing perturbation, from the tangent flow of the simulation"
    ),
    "strengthening_growth_rate": Variable(
        _CURVE,
        "f8",
        "growth rate with strengthening: if friction increases with velocity, under the law reflected at "
        "the driver velocity",
        {"comment": "2 Phi(v) - Phi(U'); NaN where this is not a friction law, and unless weakening is 1"},
    ),
}
MODE = Variable(("mode",), "i4", "number of the eigenvalue: starting with the slowest oscillation", coordinate=True)


def summarize(models: Sequence[Model], grid: Sequence[float]) -> xarray.Dataset:
    """Return position, simulated drift, eigenvalues and simulated growth rate of uniform sliding at each a of a grid.

    All are NaN for more than MAX_BLOCKS blocks.

    models : one for each law, at any a, with the same chain and driver velocity
    """
    blocks = models[0].blocks
    sizes = {"law": len(models), "a": len(grid), "block": blocks, "mode": 2 * blocks, "part": len(PARTS)}
    values = {name: np.full([sizes[key] for key in item.dimensions], np.nan) for name, item in VARIABLES.items()}
    for i, law_model in enumerate(models):
        for k, a in enumerate(grid if blocks <= MAX_BLOCKS else ()):
            model = at_recorded_a(law_model, a)
            position = sliding_position(model)
            values["equilibrium_position"][i, k] = position
            spectrum = eigenvalues(model)
            values["eigenvalue"][i, k] = np.stack([spectrum.real, spectrum.imag], axis=-1)
            values["equilibrium_drift"][i, k], values["growth_rate"][i, k] = simulate_sliding(model, position)
            if not (model.chain.weakenings == 1.0).all():
                continue
            try:
                reverse = replace(model, law=mirror_law(model.law, model.v))
            except ValueError:
                continue
            values["strengthening_growth_rate"][i, k] = simulate_sliding(reverse, position)[1]
    coordinates = axes(
        {"mode": MODE},
        law=[model.law.name for model in models],
        a=grid,
        block=range(1, blocks + 1),
        mode=range(1, 2 * blocks + 1),
        part=PARTS,
    )
    return summary(
        "Uniform sliding and the growth of its perturbations",
        VARIABLES,
        values,
        coordinates,
        {"history": "snakemake, from the equations of motion", "v": models[0].v, "duration": DURATION},
        module=__name__,
    )


def sliding_position(model: Model) -> np.ndarray:
    """Return e with K e = −Φ(w v)·threshold, shape (blocks,), independently of the simulation."""
    chain = model.chain
    load = -model.sliding_friction * chain.thresholds
    # SciPy rejects a band matrix of a single number.
    if chain.ends == "ring" or chain.blocks == 1 or chain.is_network:
        return np.array([round_digits(value) for value in solve(chain.stiffness, load, assume_a="pos")])
    bands = np.stack([np.append(0.0, np.diag(chain.stiffness, 1)), np.diag(chain.stiffness)])
    return solveh_banded(bands, load)


def simulate_sliding(model: Model, position: np.ndarray) -> tuple[float, float]:
    """Simulate uniform sliding from U(0) = position; return the largest |x_i| at the end, and the growth rate.

    The tangent map M of the simulation over the time t has the eigenvalues exp(λt); the growth rate is the logarithm of
    the largest modulus over t. NaN if the run does not complete.
    """
    start = model.begin(InitialState("sliding", tuple(position), (model.v,) * model.blocks))
    runner = Runner(model, perturbations=np.eye(2 * model.blocks))
    fastest = float(eigenvalues(model).real.max())
    duration = min(DURATION, LARGEST_GROWTH / fastest) if fastest > 0.0 else DURATION
    end = runner.state_after(start, duration)
    if end is None:
        return math.nan, math.nan
    moduli = np.abs(np.linalg.eigvals(runner.perturbations))
    rate = round(math.log(float(moduli.max())) / duration, DIGITS)
    # Adding 0 turns -0.0 into 0.0.
    return float(np.abs(end.position).max()), rate + 0.0


def digest(data: xarray.Dataset) -> str:
    """Return where perturbations of uniform sliding grow, and their largest growth rate."""

    def sentence(part: xarray.Dataset) -> str:
        a, growth = part["a"].values, part["eigenvalue"].sel(part="real").max("mode", skipna=False).values
        if np.isnan(growth).all():
            return "uniform sliding was not examined"
        where = values_where(growth > ROUNDING, a)
        largest = f"; the largest growth rate is {np.nanmax(growth):.4g}{at_value(a, int(np.nanargmax(growth)))}"
        return f"perturbations of uniform sliding grow {where}{largest * bool((growth > ROUNDING).any())}"

    return lines_of(data, ["law"], sentence)
