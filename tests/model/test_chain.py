"""Chains of any springs: their algebra, compared with dense matrices, their symmetries, and refused chains."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff import Chain, Model, law_of
from tests.refused import refused

strength = st.floats(0.1, 5.0)


@st.composite
def chains(draw):
    blocks = draw(st.integers(1, 9))
    ends = draw(st.sampled_from(["open", "ring"])) if blocks > 1 else "open"

    def numbers(count):
        return draw(st.one_of(strength, st.lists(strength, min_size=count, max_size=count)))

    coupling, threshold = numbers(blocks - (ends == "open")), numbers(blocks)
    some = st.lists(st.one_of(st.just(0.0), strength), min_size=blocks, max_size=blocks).filter(any)
    pulling = draw(st.one_of(strength, some, st.just("neighbours")))
    return Chain(blocks, coupling, pulling, threshold, ends)


@given(chains())
def test_the_algebra(chain):
    matrix, blocks = chain.stiffness, chain.blocks
    assert (matrix == matrix.T).all()
    assert np.allclose(matrix @ np.ones(blocks), chain.driving, rtol=0, atol=1e-12)
    assert np.allclose(np.diag(matrix), chain.diagonal) or (blocks == 2 and chain.ends == "ring")
    assert np.linalg.eigvalsh(matrix).min() >= chain.driving.min() - 1e-9
    assert np.allclose(matrix @ chain.sliding_offset(0.7), -0.7 * chain.thresholds, rtol=0, atol=1e-11)
    position = np.sin(1.0 + 3.0 * np.arange(blocks))
    assert np.allclose(chain.force(position), -matrix @ position, rtol=0, atol=1e-12)


@given(st.integers(2, 40))
def test_the_algebra_of_the_papers_chains(blocks):
    """K·1 = D exactly, as co-moving coordinates require; K is positive definite with eigenvalues of at least 1."""
    chain = Chain(blocks)
    assert (chain.stiffness @ np.ones(blocks) == chain.driving).all()
    assert np.linalg.eigvalsh(chain.stiffness).min() >= 1.0 - 1e-12
    assert np.allclose(chain.stiffness @ chain.sliding_offset(0.7), -0.7)


@given(chains())
def test_mirror_symmetry(chain):
    matrix, threshold = chain.stiffness, chain.thresholds
    mirrored = (matrix == matrix[::-1, ::-1]).all() and (threshold == threshold[::-1]).all()
    assert chain.is_mirror_symmetric == (mirrored and chain.blocks > 1)
    if mirrored:
        offset = chain.sliding_offset(0.9)
        assert (offset == offset[::-1]).all()


@given(strength, strength, strength, st.integers(2, 7))
def test_all_modes_oscillate_below_the_damping_limit(coupling, pulling, threshold, blocks):
    chain = Chain(blocks, coupling, pulling, threshold)
    assert chain.is_uniform
    for first in range(blocks):
        for last in range(first + 1, blocks + 1):
            least = np.linalg.eigvalsh(chain.stiffness[first:last, first:last]).min()
            assert threshold * chain.damping_limit <= 2.0 * np.sqrt(least) + 1e-9


def test_the_chain_of_the_paper():
    chain = Chain(3)
    assert chain.stiffness.tolist() == [[2, -1, 0], [-1, 4, -1], [0, -1, 2]]
    assert chain.driving.tolist() == [1, 2, 1]
    for friction in (1.0, float(law_of("linearized", a=0.08)(0.1))):
        expected = friction * np.array([-5 / 6, -2 / 3, -5 / 6])
        assert chain.sliding_offset(friction) == pytest.approx(expected, rel=0.0, abs=2e-16)
    assert friction == pytest.approx(1 - 0.008, abs=1e-15)
    assert chain.damping_limit == 2.0
    assert Chain(3, ends="ring").driving.tolist() == [2, 2, 2]
    assert Chain(3, pulling=np.array([1.0, 2.0, 1.0])).driving.tolist() == [1, 2, 1]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        *(({"blocks": blocks}, f"chain.blocks: {blocks}") for blocks in (0, -3, 2_000_000)),
        *(({"blocks": blocks}, f"chain.blocks: {blocks}") for blocks in (2.0, True)),
        ({"ends": "loose"}, "chain.ends: 'loose'"),
        *(({key: [0.1]}, f"chain.{key}") for key in ("coupling", "damping")),
        (
            {"pulling_damping": [0.1]},
            "chain.pulling_damping",
        ),
        ({"grid": [1, 3], "damping": [0.1]}, "chain.damping"),
        ({"coupling": [1.0, 1.0], "ends": "ring"}, "chain.coupling"),
        ({"threshold": [1.0, 2.0]}, "chain.threshold"),
        ({"pulling": "all"}, "chain.pulling: 'all'"),
        ({"threshold": 0.0}, "chain.threshold: 0.0"),
        ({"coupling": -1.0}, "chain.coupling: -1.0"),
        ({"pulling": [1.0, float("nan"), 1.0]}, "chain.pulling[1]: nan"),
        ({"coupling": True}, "chain.coupling: True"),
        ({"pulling": 0.0}, "chain.pulling: 0.0"),
        ({"pulling": [0, 0, 0]}, "chain.pulling: (0.0, 0.0, 0.0)"),
        ({"pulling": 1e-7}, "chain.pulling: 1e-07"),
        (
            {"pulling": (1e-7, 0.0, 1e-8)},
            "chain.pulling: (1e-07, 0.0, 1e-08)",
        ),
        ({"pulling": (1.0, 1e-31, 1.0)}, "chain.pulling[1]: 1e-31"),
        ({"damping": 1e-31}, "chain.damping: 1e-31"),
        ({"blocks": 1, "ends": "ring"}, "chain.ends: ring"),
    ],
)
def test_refused(options, message):
    with refused(message):
        Chain(**options)


@pytest.mark.parametrize(
    ("blocks", "values", "message"),
    [
        (2, [0.1, 0.2], "chain.damping"),
        (1, [0.1], "chain.damping"),
    ],
)
def test_a_list_for_fewer_than_two_springs_is_refused(blocks, values, message):
    with refused(message):
        Chain(blocks, damping=values)


@pytest.mark.filterwarnings("ignore:the matrix subclass")
@pytest.mark.parametrize("chain", [Chain(3, damping=0.5, pulling_damping=0.2), Chain(grid=[1, 3], damping=0.5)])
def test_forces_on_anything_that_numpy_reads(chain):
    """A matrix of numpy is a table of numbers like any other."""
    values = np.array([[-0.9, -1.1, -1.0], [0.3, 0.1, 0.2]])
    forces = {"position": chain.force, "velocity": lambda values: chain.damping_force(values, 0.1)}
    for key, force in forces.items():
        expected = force(values)
        assert np.array_equal(expected, np.array([force(row) for row in values]))
        for form in (np.matrix(values), values.tolist(), np.ma.masked_array(values)):
            result = force(form)
            assert type(result) is np.ndarray
            assert np.array_equal(result, expected)
        for form in (values[:, :2], np.matrix(values).T, 1.0, []):
            with refused(key, "(…, 3)"):
                force(form)
        with refused(f"{key}: 'far'"):
            force("far")


def test_cached_arrays_are_read_only():
    chain = Chain(3, coupling=np.array(0.5), pulling=2.0)
    arrays = [chain.thresholds, chain.coupling_to_previous, chain.coupling_to_next, chain.driving, Chain(3).driving]
    for array in (*arrays, Model("linearized", a=0.1, chain=chain).sliding_offset):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 2.0


def test_ends_are_compared_by_value():
    """A text that was read is a different object from the one in a program."""
    assert Chain(3, coupling=(1.0, 2.0), ends="".join(["op", "en"])).stiffness[0, 2] == 0.0


@pytest.mark.parametrize(
    "options", [{"coupling": [1.0, 2.0]}, {"pulling": [1.0, 2.0, 3.0]}, {"threshold": [1.0, 1.0, 2]}, {"ends": "ring"}]
)
def test_unequal_springs_have_no_closed_form(options):
    law = law_of("linearized", a=0.1)
    assert Model(law, coupling=0.5, pulling=2.0, threshold=1.5).has_closed_form
    assert not Model(law, blocks=3, **options).has_closed_form
