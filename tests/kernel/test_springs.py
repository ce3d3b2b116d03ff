"""The springs of a chain as the kernel holds them: the bound on its fastest oscillation."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff import Chain, Model
from burridge_knopoff.running.kernel_model import kernel_model


def fastest(chain):
    return kernel_model(Model("nonlinear", a=0.1, chain=chain)).fastest


@given(st.integers(2, 20), st.integers(0, 2**32 - 1), st.sampled_from(["open", "ring"]))
def test_no_mode_is_faster_than_the_bound_and_it_is_close(blocks, seed, ends):
    generator = np.random.default_rng(seed)
    coupling = (10.0 ** generator.uniform(-1.0, 1.0, blocks - (ends == "open"))).tolist()
    chain = Chain(blocks, coupling, (10.0 ** generator.uniform(-1.0, 1.0, blocks)).tolist(), ends=ends)
    largest = np.sqrt(np.linalg.eigvalsh(chain.stiffness).max())
    gershgorin = np.sqrt((2.0 * chain.diagonal - chain.driving).max())
    assert largest * (1.0 - 1e-12) <= fastest(chain) <= gershgorin * (1.0 + 1e-12)


def test_the_bound_takes_several_steps():
    """Those of the power method bring it from 8e-3 to 1e-4 above the truth for one strong spring among weak ones."""
    chain = Chain(5, coupling=[0.1, 3.0, 0.1, 0.1], pulling=0.1)
    largest = np.sqrt(np.linalg.eigvalsh(chain.stiffness).max())
    assert fastest(chain) == pytest.approx(largest, rel=2e-4)
