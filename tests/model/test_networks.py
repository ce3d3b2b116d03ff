"""Grids, networks from a file, masses and random numbers, compared with dense matrices, and refused ones."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import HealthCheck, given
from hypothesis import settings as hypothesis_settings
from hypothesis import strategies as st

from burridge_knopoff import Chain, InitialState, Model
from burridge_knopoff.model.solving import nearest_solution
from burridge_knopoff.model.springs import read_edges
from tests.refused import refused

strength = st.floats(0.1, 5.0)
UNIFORM = {"random": "uniform", "low": 0.5, "high": 1.5, "seed": 3}


def dashpot(i, k):
    """Return the damping between two blocks of a network that has dashpots, 0 for some."""
    return 0.25 * ((i + 2 * k) % 4)


def written(folder, edges, damped=False):
    """Return the path of a file of springs, with a column of dashpots or without."""
    path = folder / "springs.txt"
    lines = (f"{i} {k} {s!r} {dashpot(i, k) if damped else ''}\n" for (i, k), s in edges.items())
    path.write_text("# block block strength\n" + "".join(lines))
    return str(path)


@st.composite
def networks(draw):
    """Blocks and springs of a network, connected or not, and the springs to the driver that hold it."""
    blocks = draw(st.integers(2, 9))
    pairs = st.tuples(st.integers(1, blocks), st.integers(1, blocks)).filter(lambda pair: pair[0] != pair[1])
    edges = draw(st.dictionaries(pairs, strength, min_size=1, max_size=15))
    edges = {pair: value for pair, value in edges.items() if pair[::-1] not in edges or pair[0] < pair[1]}
    pulling = draw(st.lists(st.one_of(st.just(0.0), strength), min_size=blocks, max_size=blocks))
    for part in connected_blocks(blocks, edges):
        if not any(pulling[block] for block in part):
            pulling[min(part)] = 1.0
    return blocks, edges, pulling


def connected_blocks(blocks, edges):
    """Return the sets of connected blocks (0 …)."""
    part = list(range(blocks))
    for _ in range(blocks):
        for i, k in edges:
            part[i - 1] = part[k - 1] = min(part[i - 1], part[k - 1])
    return [{block for block in range(blocks) if part[block] == root} for root in set(part)]


def dense(chain):
    """Return K and C from the lists of neighbours, summed by hand."""
    stiffness, damping = np.diag(chain.driving).astype(float), np.diag(chain.driver_damping)
    start, index, strengths, dashpots = chain.neighbours
    for block in range(chain.blocks):
        for place in range(start[block], start[block + 1]):
            for matrix, numbers in ((stiffness, strengths), (damping, dashpots)):
                matrix[block, block] += numbers[place]
                matrix[block, index[place]] -= numbers[place]
    return stiffness, damping


def check_algebra(chain):
    """Require that all forms of springs and dashpots are those of symmetric matrices K, with K·1 = D, and C."""
    (matrix, damping), blocks = dense(chain), chain.blocks
    assert np.allclose(chain.stiffness, matrix, rtol=0, atol=1e-12)
    assert (chain.sparse_stiffness.toarray() == chain.stiffness).all()
    assert (chain.stiffness == chain.stiffness.T).all()
    assert np.allclose(matrix @ np.ones(blocks), chain.driving, rtol=0, atol=1e-12)
    position = np.sin(1.0 + 3.0 * np.arange(3.0 * blocks)).reshape(3, blocks)
    assert np.allclose(chain.force(position), -position @ matrix, rtol=0, atol=1e-11)
    assert np.allclose(chain.damping_matrix, damping, rtol=0, atol=1e-12)
    assert (chain.damping_matrix == chain.damping_matrix.T).all()
    forces = chain.driver_damping * 0.3 - position @ damping
    assert np.allclose(chain.damping_force(position, 0.3), forces, rtol=0, atol=1e-11)
    assert chain.is_damped == damping.any()
    expected = np.linalg.solve(matrix, -0.7 * chain.thresholds)
    assert np.allclose(chain.sliding_offset(0.7), expected, rtol=1e-9, atol=1e-12)
    modes = np.linalg.eigvals(matrix / chain.masses[:, None])
    assert np.sqrt(modes.real.max()) <= chain.highest_frequency * (1 + 1e-12)
    inverse, zero = np.diag(1.0 / chain.masses), np.zeros((blocks, blocks))
    rates = np.linalg.eigvals(np.block([[zero, np.eye(blocks)], [-inverse @ matrix, -inverse @ damping]]))
    assert np.abs(rates).max() <= chain.highest_rate * (1 + 1e-12)


@hypothesis_settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(networks(), st.booleans())
def test_a_network_from_a_file(tmp_path, network, damped):
    blocks, edges, pulling = network
    masses = [1.0 + 0.1 * block for block in range(blocks)]
    springs = written(tmp_path, edges, damped)
    chain = Chain(blocks, pulling=pulling, threshold=UNIFORM, mass=masses, springs=springs, pulling_damping=0.1)
    expected, dashpots = np.zeros((2, blocks, blocks))
    for (i, k), value in edges.items():
        expected[i - 1, k - 1] = expected[k - 1, i - 1] = -value
        dashpots[i - 1, k - 1] = dashpots[k - 1, i - 1] = -dashpot(i, k) if damped else 0.0
    assert (chain.stiffness - np.diag(chain.diagonal) == expected).all()
    assert (chain.damping_matrix - np.diag(chain.damping_diagonal) == dashpots).all()
    assert all((np.diff(index) > 0).all() for index in np.split(chain.neighbours.index, chain.neighbours.start[1:-1]))
    check_algebra(chain)
    assert not chain.is_mirror_symmetric
    assert not chain.is_uniform


@given(
    st.integers(1, 5), st.integers(1, 5), strength, st.sampled_from([0.3, "neighbours"]), st.sampled_from([0.0, 0.2])
)
def test_a_grid(columns, rows, coupling, pulling, damping):
    chain = Chain(grid=[columns, rows], coupling=coupling, pulling=pulling, threshold=UNIFORM, damping=damping)
    assert chain.blocks == columns * rows
    for block in range(chain.blocks):
        ix, iy = block % columns, block // columns
        around = [(ix - 1, iy), (ix + 1, iy), (ix, iy - 1), (ix, iy + 1)]
        expected = [x + columns * y for x, y in around if 0 <= x < columns and 0 <= y < rows]
        start, end = chain.neighbours.start[block : block + 2]
        assert chain.neighbours.index[start:end].tolist() == expected
        if pulling == "neighbours":
            assert chain.driving[block] == (len(expected) if chain.blocks > 1 else 1)
    assert (chain.neighbours.strength == coupling).all()
    assert (chain.neighbours.damping == damping).all()
    check_algebra(chain)


@given(st.integers(1, 5), st.integers(1, 5), st.tuples(strength, strength), st.sampled_from([0.0, (0.2, 0.0)]))
def test_a_grid_with_two_couplings(columns, rows, coupling, damping):
    """K and C by Kronecker products of the matrices of a row of columns and a row of rows."""
    chain = Chain(grid=[columns, rows], coupling=coupling, damping=damping, pulling=0.3)

    def laplacian(count):
        step = np.diff(np.eye(count), axis=0)
        return step.T @ step

    def total(x, y):
        return np.kron(np.eye(rows), x * laplacian(columns)) + np.kron(y * laplacian(rows), np.eye(columns))

    assert np.allclose(chain.stiffness, total(*coupling) + 0.3 * np.eye(chain.blocks), rtol=0, atol=1e-13)
    assert np.allclose(chain.damping_matrix, total(*np.broadcast_to(damping, 2)), rtol=0, atol=1e-13)
    check_algebra(chain)
    # The springs to the driver are as many as the neighbours, whatever the strengths.
    assert (Chain(grid=[columns, rows], coupling=coupling).driving == Chain(grid=[columns, rows]).driving).all()


@pytest.mark.parametrize(
    ("chain", "start", "index", "springs", "dashpots"),
    [
        (Chain(3, coupling=(1.0, 2.0), damping=(0.0, 4.0)), [0, 1, 3, 4], [1, 0, 2, 1], [1, 1, 2, 2], [0, 0, 4, 4]),
        (
            Chain(3, (1.0, 2.0, 3.0), ends="ring", damping=(4.0, 5.0, 6.0)),
            *([0, 2, 4, 6], [2, 1, 0, 2, 1, 0], [3, 1, 1, 2, 2, 3], [6, 4, 4, 5, 5, 6]),
        ),
        (Chain(2, (1.0, 2.0), ends="ring", damping=(3, 0)), [0, 2, 4], [1, 1, 0, 0], [2, 1, 1, 2], [0, 3, 3, 0]),
        (Chain(1), [0, 0], [], [], []),
    ],
)
def test_the_previous_block_comes_first_in_a_row_or_ring(chain, start, index, springs, dashpots):
    assert [values.tolist() for values in chain.neighbours] == [start, index, springs, dashpots]
    assert [values.dtype.str for values in chain.neighbours] == ["<i8", "<i8", "<f8", "<f8"]
    for values in (*chain.neighbours, chain.diagonal, chain.masses, chain.driving):
        assert not values.flags.writeable
    check_algebra(chain)


def solve_exactly(matrix, load):
    """Return the solution in rational arithmetic, rounded."""
    rows = [[Fraction(value) for value in row] for row in np.column_stack([matrix, load]).tolist()]
    for i, row in enumerate(rows):
        for k, other in enumerate(rows):
            if k != i and other[i]:
                rows[k] = [value - other[i] / row[i] * pivot for value, pivot in zip(other, row, strict=True)]
    return np.array([float(row[-1] / row[i]) for i, row in enumerate(rows)])


@pytest.mark.slow
@given(st.integers(2, 7), st.integers(2, 3), strength, st.integers(0, 2**32 - 1))
def test_the_sliding_position_of_a_network_is_the_rounded_exact_solution(columns, rows, coupling, seed):
    """This includes a weakly coupled driver, for which a solution in double precision has few correct digits.

    A quarter of the elements of K is not 0 in about 16 blocks: more are solved as a sparse system.
    """
    blocks = columns * rows
    drawn = {"random": "uniform", "low": 0.5, "high": 2.0, "seed": seed}
    chain = Chain(grid=(columns, rows), coupling=coupling, pulling=[1e-6, *(blocks - 1) * [0.0]], threshold=drawn)
    assert (-chain.sliding_offset(1.0) == solve_exactly(chain.stiffness, chain.thresholds)).all()


@pytest.mark.parametrize("springs", [None, {"distance": "9/r**3"}])
def test_the_sliding_position_does_not_depend_on_the_rows_that_are_multiplied_at_a_time(monkeypatch, springs):
    monkeypatch.setattr("burridge_knopoff.model.solving._ELEMENTS", 20)
    chain = Chain(grid=(7, 3), springs=springs, pulling=[1e-6, *20 * [0.0]])
    assert (-chain.sliding_offset(1.0) == solve_exactly(chain.stiffness, chain.thresholds)).all()


def test_long_rows_and_rings_slide_like_short_ones():
    for chain in (Chain(40, 7.0, 0.3, UNIFORM), Chain(40, 7.0, 0.3, UNIFORM, "ring")):
        expected = -0.7 * nearest_solution(chain.sparse_stiffness, chain.thresholds)
        assert np.allclose(chain.sliding_offset(0.7), expected, rtol=1e-13, atol=0)
    for ends in ("open", "ring"):
        chain = Chain(100_000, 100.0, ends=ends)
        offset = chain.sliding_offset(0.7)
        assert (offset == offset[::-1]).all()
        assert np.abs(chain.force(offset) - 0.7).max() < 1e-12


def test_a_symmetric_grid_has_symmetric_sliding_positions():
    offset = Chain(grid=(60, 60), coupling=30.0).sliding_offset(1.0).reshape(60, 60)
    assert all((offset == other).all() for other in (offset.T, offset[::-1], offset[:, ::-1]))


def test_unequal_masses_break_the_mirror_symmetry():
    assert Chain(3, mass=2.0).is_mirror_symmetric
    assert not Chain(3, mass=(1.0, 1.0, 2.0)).is_mirror_symmetric
    assert not Model("linearized", a=0.1, mass=2.0).has_closed_form
    assert not Chain(3, mass=2.0).is_equivalent_to(Chain(3))
    assert Chain(3, mass=(1.0, 1.0, 1.0)).is_equivalent_to(Chain(3))


def test_unequal_friction_breaks_the_mirror_symmetry():
    assert Chain(3, weakening=(1.0, -0.5, 1.0)).is_mirror_symmetric
    assert not Chain(3, weakening=(1.0, 1.0, 0.5)).is_mirror_symmetric
    assert not Model("linearized", a=0.1, weakening=0.5).has_closed_form
    assert Chain(3, weakening=(1.0, -0.5, 1.0)).different_key(Chain(3)) == "weakening"
    assert Chain(3, weakening=(1.0, 1.0, 1.0)).is_equivalent_to(Chain(3))


def test_random_numbers_depend_on_their_seed():
    chain, longer = Chain(50, threshold=UNIFORM, mass=UNIFORM), Chain(80, threshold=UNIFORM)
    assert (chain.thresholds == Chain(50, threshold=chain.threshold).thresholds).all()
    assert (chain.thresholds == longer.thresholds[:50]).all()
    assert chain.threshold == "random=uniform,low=0.5,high=1.5,seed=3"
    assert (chain.thresholds != Chain(50, threshold={**UNIFORM, "seed": 4}).thresholds).all()
    for text in ("01", "1_0", "٣", "0x1", " 1", "1 "):
        with refused(f"chain.threshold.seed: {text!r}"):
            Chain(3, threshold=f"random=uniform,low=0.5,high=1.5,seed={text}")
    # Quantities of one seed are independent.
    assert abs(np.corrcoef(chain.thresholds, chain.masses)[0, 1]) < 0.5
    assert 0.5 <= chain.thresholds.min() < 0.6
    assert 1.4 < chain.thresholds.max() <= 1.5
    assert (Chain(5, threshold={**UNIFORM, "low": 1.5}).thresholds == 1.5).all()


def test_initial_states_of_any_number_of_blocks():
    rough = InitialState("rough", UNIFORM, 0.25)
    assert rough.blocks is None
    position, velocity = rough.coordinates(60)
    assert (position == rough.coordinates(70)[0][:60]).all()
    assert velocity.tolist() == 60 * [0.25]
    at = Model("linearized", a=0.1, blocks=60).begin(rough)
    assert at.velocity.tolist() == 60 * [0.25]
    assert (InitialState("own", 0.5, 0.0).blocks, InitialState("own", UNIFORM, (0.0, 0.1)).blocks) == (1, 2)
    with refused("blocks: 3"):
        InitialState("own", UNIFORM, (0.0, 0.1)).coordinates(3)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("", "0 columns"),
        ("1 2\n", "2 columns"),
        ("1 2 1.0 3 4\n", "5 columns"),
        ("1 2 1.0 -3\n", "1 2 1 -3"),
        ("1 2 1.0 0.1\n2 3 1.0\n", "columns"),
        ("1 2 strong\n", "'strong'"),
        ("1 2 1\n2 3\n", "columns"),
        ("0 1 1.0\n", "0 1 1"),
        ("1 2.5 1.0\n", "1 2.5 1"),
        ("1 1000001 1.0\n", "1 1e+06 1"),
        ("1 2 0\n", "1 2 0"),
        ("1 2 nan\n", "1 2 nan"),
        ("2 2 1.0\n", "2 2 1"),
        ("1 2 1\n3 1 1\n2 1 1\n", "2 1 1"),
    ],
)
def test_files_that_are_not_a_list_of_springs_are_refused(tmp_path, lines, message):
    path = tmp_path / "springs.txt"
    path.write_text(lines)
    with refused(f"chain.springs: {path}", message):
        Chain(springs=str(path))


def test_refused_networks(tmp_path):
    path = written(tmp_path, {(1, 2): 1.0, (3, 4): 2.0})
    assert Chain(springs=path).blocks == 4
    for options, message in (
        ({"pulling": 0.0}, "chain.pulling: 0.0"),
        ({"pulling": [1, 0, 0, 0]}, "chain.pulling: 0"),
        (
            {"pulling": [1, 0, 1e-7, 0]},
            "chain.pulling: 1e-07",
        ),
        ({"blocks": 5}, "chain.pulling: 0"),
        ({"blocks": 3, "pulling": 1}, "chain.springs: block 4"),
        ({"coupling": 2.0}, "chain.coupling: 2.0"),
        ({"coupling": (1.0, 1.0)}, "chain.coupling: (1.0, 1.0)"),
        ({"ends": "ring"}, "chain.ends: ring"),
        ({"grid": (2, 2)}, "chain.grid: [2, 2]"),
        ({"mass": [1, 2]}, "chain.mass"),
    ):
        with refused(message):
            Chain(**{"springs": path, **options})
    for options, message in (
        ({"blocks": 5}, "chain.blocks: 5"),
        ({"grid": (2,)}, "chain.grid: (2,)"),
        ({"grid": (2000, 2000)}, "chain.grid: [2000, 2000]"),
        ({"coupling": (1, 2, 3)}, "chain.coupling: 3 numbers"),
        ({"damping": (1,)}, "chain.damping: a list of 1 number"),
        ({"pulling": 0.0}, "chain.pulling: 0.0"),
        ({"threshold": {**UNIFORM, "high": 0.25}}, "chain.threshold.high: 0.25"),
        ({"threshold": "random=uniform,low=1"}, "chain.threshold.high"),
        ({"threshold": {}}, "chain.threshold.random"),
    ):
        with refused(message):
            Chain(**{"grid": (2, 2), **options})


def test_a_changed_file_gives_another_chain(tmp_path):
    path = written(tmp_path, {(1, 2): 1.0})
    chain = Chain(springs=path)
    assert Chain(springs=chain.springs) == chain
    written(tmp_path, {(1, 2): 2.0})
    assert Chain(springs=path) != chain
    read_edges.cache_clear()
    with refused(f"chain.springs: {path}", chain.springs[-16:]):
        _ = Chain(2, springs=chain.springs).neighbours


@given(
    st.sampled_from(["open", "ring", "grid"]),
    st.integers(2, 9),
    st.integers(1, 4),
    st.one_of(st.none(), st.floats(1.0, 6.0)),
)
def test_springs_by_distance(shape, columns, rows, cut_off):
    """Every pair of blocks within the cut-off is joined once."""
    rows = rows if shape == "grid" else 1
    where = {"grid": (columns, rows)} if shape == "grid" else {"blocks": columns, "ends": shape}
    keys = {"distance": "9/r**3 + exp(-r)"} | ({} if cut_off is None else {"cut_off": cut_off})
    chain = Chain(**where, springs=keys, pulling=0.5)
    expected = np.zeros((columns * rows, columns * rows))
    for i in range(columns * rows):
        for k in range(columns * rows):
            dx, dy = abs(i % columns - k % columns), abs(i // columns - k // columns)
            r = np.hypot(min(dx, columns - dx) if shape == "ring" else dx, dy)
            if i != k and r <= (cut_off or np.inf):
                expected[i, k] = -(9.0 / r**3 + np.exp(-r))
    expected += np.diag(0.5 - expected.sum(axis=1))
    assert np.allclose(chain.stiffness, expected, rtol=1e-13)
    assert Chain(**where, springs=chain.springs, pulling=0.5) == chain


ALL_PAIRS = {"springs": {"distance": "1/r**3"}, "pulling": 1.0}


@pytest.mark.parametrize(
    ("keys", "place"),
    [
        ({"pulling": "neighbours"}, "chain.pulling"),
        ({"springs": {"distance": "9/q"}}, "chain.springs.distance: q"),
        ({"springs": {"distance": "9/r,2"}}, "chain.springs.distance: '9/r,2'"),
        ({"springs": {"cut_off": 2}}, "chain.springs.distance: missing"),
        ({"springs": {"distance": "1/r", "cut_off": 0.5}}, "chain.springs.cut_off: 0.5"),
        ({"springs": {"distance": "1/(r-2)"}, "blocks": 9}, "chain.springs.distance: -1 at r = 1"),
        ({"blocks": 300}, "chain.springs.distance: 9.7059e-07 at r = 101"),
        ({"blocks": 100_000}, "chain.springs: 5e+09 springs"),
        ({"blocks": 1}, "chain.blocks: 1"),
        ({"grid": (3, 3), "ends": "ring"}, "chain.ends: ring"),
        ({"coupling": 2.0}, "chain.coupling: 2.0"),
    ],
)
def test_refused_springs_by_distance(keys, place):
    with refused(place):
        Chain(**(ALL_PAIRS | keys))
