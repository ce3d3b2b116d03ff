"""Configs: defaults, grids, and a one-line message for every error."""

import copy
import math
import time
from functools import reduce

import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff.model.chain import Chain
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.study import all_points
from burridge_knopoff.study.yaml_file import ConfigError, read_config, read_yaml
from tests.bad_configs import BAD_FILES
from tests.fuzzing.test_configs import RANGE_OF
from tests.refused import refused
from tests.study.bad_changes import BAD_CHANGES

STATES = {"minus": {}, "plus": {}}
RANGE = {"from": 0, "to": 0.3, "step": 0.0025}


def load(**changes):
    config = {"study": "test", "a": [RANGE], "initial": copy.deepcopy(STATES), **changes}
    return load_study({key: value for key, value in config.items() if value is not None}, "config/test.yaml")


@pytest.mark.parametrize(("changes", "words"), BAD_CHANGES)
def test_bad_configs_get_one_line(changes, words):
    with refused("config/test.yaml", *words, error=ConfigError):
        load(**changes)


@pytest.mark.parametrize("key", RANGE_OF)
def test_numbers_outside_their_range_get_one_line(key):
    """The line names the value, the kind of number and both ends."""
    low, high = RANGE_OF[key]
    whole, least = low.isdigit(), float(low.strip(">"))
    above = ">" in low
    first, last = (low, f"{high:.0f}") if whole else (f"{least:g}", f"{high:g}")
    ends = f"above {first} and at most {last}" if above else f"between {first} and {last}"
    if whole:
        wrong = [int(least) - 1, int(high) + 1, 2.5, 7.0]
    else:
        below = [-1] if low == "0.0" else [-1, 0]
        wrong = [*below, math.nextafter(least, -math.inf), math.nextafter(high, math.inf)]
    *sections, name = key.split(".")
    for value in (*wrong, math.nan, math.inf, True, "1e-6", "long"):
        changes = reduce(lambda inside, section: {section: inside}, reversed(sections), {name: value})
        words = f"config/test.yaml: {key}: {value!r}", ends
        with refused(*words, error=ConfigError):
            load(**changes)


def test_a_study_of_laws_without_a_needs_none():
    """Over one value, or over other parameters; a law with a needs it."""
    config = {
        "study": "belt",
        "laws": {"own": {"formula": "mud + (1 - mud)*exp(-u)", "mud": 0.5}},
        "initial": {"x": {"position": 0, "velocity": -0.5}},
        "chain": {"blocks": 1},
        "contact": "symmetric",
        "attractors": {"velocity": ["v - 2", "v"]},
    }
    study = load_study(config, "belt.yaml")
    assert (study.blocks, [*study.grid.values()]) == (1, [0.0])
    grid = {**config, "grid": {"v": [0.5, 1.0]}}
    assert load_study(grid, "belt.yaml").other_values == [{"v": 0.5}, {"v": 1.0}]
    with refused("belt.yaml: a", error=ConfigError):
        load_study({**config, "laws": {**config["laws"], "linearized": {}}}, "belt.yaml")


@pytest.mark.parametrize("case", [name for name in BAD_FILES if name != "template"])
def test_bad_files_get_one_line(tmp_path, case):
    content, words = BAD_FILES[case]
    path = tmp_path / "study.yaml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with refused("study.yaml", *words, error=ConfigError):
        load_study(read_config(path), str(path))


@pytest.mark.parametrize("number", ["1e-6", "1e5", "2E+3", "-3e2", "1.5e3", "+.5e-1", "7.", "0.1"])
def test_numbers_with_an_exponent_are_read_as_numbers(tmp_path, number):
    """YAML itself reads a number with an exponent as text if it has no point, or its exponent no sign."""
    (tmp_path / "file").write_text(f"[{number}]")
    (read,) = read_yaml(tmp_path / "file")
    assert type(read) is float
    assert read == float(number)


@pytest.mark.parametrize("text", ["010", "1_0", "1:30", "0x1F", "1e", "e5", "1e5.0", "1_0e5", "."])
def test_ambiguous_numbers_are_read_as_text(tmp_path, text):
    (tmp_path / "file").write_text(f"[{text}]")
    assert read_yaml(tmp_path / "file") == [text]


@pytest.mark.parametrize("name", ["paper", "smoke"])
def test_the_shipped_configs_are_valid(repository, name):
    path = repository / "config" / f"{name}.yaml"
    study = load_study(read_config(path), str(path))
    assert study.name == name
    if name == "paper":
        assert len(all_points(study)) == 484
        assert study.grid["0.0800"] == 0.08
        assert study.grid["0.3000"] == 0.3
        assert study.shown_point == "0.0800"


def test_lists_and_several_ranges():
    study = load(a=[0.2, {"from": 0.08, "to": 0.1, "step": 0.01}, 0.095, {"from": 0, "to": 0, "step": 1}])
    assert list(study.grid) == ["0.0000", "0.0800", "0.0900", "0.0950", "0.1000", "0.2000"]
    assert list(study.grid.values()) == [0.0, 0.08, 0.09, 0.095, 0.1, 0.2]


FOUR_LAWS = {
    "nonlinear": {},
    "linearized": {},
    "cl": {"formula": "(1 - sigma)/(1 + a*u/(1 - sigma))", "sigma": 0.01},
    "soft": {"law": "stribeck", "eta": 0.1},
}


def test_laws_in_the_order_of_the_config():
    study = load(laws=FOUR_LAWS, a=[0.02, 0.05, 0.08, 3], basins={"a": {"cl": []}}, figures={"law": "cl"})
    assert study.laws == ("nonlinear", "linearized", "cl", "soft")
    assert [point["law"] for point in all_points(study)[::8]] == list(study.laws)
    assert study.config["solver"] == dict.fromkeys(study.laws, "series")
    # Laws other than the paper's have maps at the values of its first law.
    maps = {"nonlinear": [0.08], "linearized": [0.05, 0.08], "cl": [], "soft": [0.05, 0.08]}
    assert study.config["basins"]["a"] == maps
    assert list(study.config["basins"]["a"]) == list(study.laws)
    assert study.config["chains"]["laws"] == ["nonlinear"]
    assert study.model("cl", 0.5)
    assert study.model("soft", 3.0).law.parameters == {"a": 3.0, "sigma": 0.05, "eta": 0.1}
    assert study.model("soft", 3.0).law.name == "soft"
    assert float(study.model("cl", 0.3).law(0.0)) == 0.99


def test_a_model_has_the_chain_and_driver_of_the_config():
    chain = {"coupling": [1, 2, 3], "pulling": 0.5, "threshold": [1, 2, 1], "ends": "ring"}
    model = load(chain=chain, v=0.2, contact="symmetric").model("nonlinear", 0.08)
    assert model.chain == Chain(3, (1.0, 2.0, 3.0), 0.5, (1.0, 2.0, 1.0), "ring")
    assert (model.v, model.contact, model.parameter("a")) == (0.2, "symmetric", 0.08)


def test_command_of_a_point():
    study = load(solver={"linearized": "map", "nonlinear": "rk4"}, step=0.01, lyapunov_alignment=250)
    assert "--solver map" in study.command("linearized", "plus", "0.0800")
    options = study.command("nonlinear", "plus", "0.0800")
    assert "--a 0.08 " in options
    assert "--position=0.989,-0.993,-0.991" in options
    assert "--step 0.01" in options
    assert "--lyapunov-alignment 250.0" in options
    assert "--position=-0.989,-0.993,-0.991" in study.command("nonlinear", "minus", "0.0800")
    with refused("a0.0801", error=ConfigError):
        study.command("linearized", "plus", "0.0801")


def test_a_command_leaves_defaults_out():
    study = load(laws=FOUR_LAWS)
    start = "--a 0.08 --initial plus --position=0.989,-0.993,-0.991 --velocity=0.099,0.1012,0.1023"
    assert study.command("nonlinear", "plus", "0.0800") == f"bk simulate --law nonlinear {start}"
    soft = f"bk simulate --law stribeck --law-name soft --number eta=0.1 {start}"
    assert study.command("soft", "plus", "0.0800") == soft
    formula = "'--formula=(1 - sigma)/(1 + a*u/(1 - sigma))' --law-name cl --number sigma=0.01"
    assert study.command("cl", "plus", "0.0800") == f"bk simulate {formula} {start}"
    chain = {"coupling": [1, 2, 3], "pulling": 0.5, "threshold": [1, 2, 1], "ends": "ring"}
    command = load(chain=chain, v=0.2).command("nonlinear", "plus", "0.0800")
    options = "--coupling 1.0,2.0,3.0 --pulling 0.5 --threshold 1.0,2.0,1.0 --ends ring --v 0.2"
    assert f"--a 0.08 {options} --initial plus" in command


def test_command_of_another_solver():
    solver = {"linearized": "map", "nonlinear": "rk4"}
    study = load(solvers={"step": 0.02}, step=0.01, solver=solver, window=500)
    assert study.other_solvers("linearized") == ["series", "rk4"]
    assert study.other_solvers("nonlinear") == ["series"]
    options = study.command("linearized", "plus", "0.0800").split()
    assert "--lyapunov-exponents" not in options
    series = study.command("linearized", "plus", "0.0800", "series").split()
    assert [word for word in options if word not in series] == ["--solver", "map"]
    rk4 = study.command("linearized", "plus", "0.0800", "rk4")
    assert "--solver rk4 --step 0.02" in rk4
    assert "--lyapunov-exponents 0" in rk4
    assert "--window 500" in rk4
    for law, solver in (("linearized", "map"), ("nonlinear", "rk4"), ("nonlinear", "map")):
        with refused(f"{law}/{solver}", error=ConfigError):
            study.command(law, "plus", "0.0800", solver)


@pytest.mark.parametrize(
    ("changes", "linearized", "nonlinear"),
    [
        ({}, ["map", "rk4"], ["rk4"]),
        ({"solver": "rk4", "step": 0.01}, ["series", "map"], ["series"]),
        ({"chain": {"coupling": 2.5, "pulling": 0.7}}, ["map", "rk4"], ["rk4"]),
        ({"chain": {"threshold": [1, 2, 1]}}, ["rk4"], ["rk4"]),
        ({"chain": {"ends": "ring"}}, ["rk4"], ["rk4"]),
        ({"a": [1.9]}, ["map", "rk4"], ["rk4"]),
        ({"a": [1.9, 2.5], "solvers": {"a": [1.9, 2.5]}}, ["rk4"], ["rk4"]),
    ],
)
def test_every_solver_that_accepts_a_law_is_compared(changes, linearized, nonlinear):
    study = load(**changes)
    assert study.other_solvers("linearized") == linearized
    assert study.other_solvers("nonlinear") == nonlinear


def test_a_thousand_values_are_checked_fast():
    begin = time.process_time()
    load(laws=FOUR_LAWS, a=[{"from": 0, "to": 0.999, "step": 0.001}])
    assert time.process_time() - begin < 5.0


@pytest.mark.parametrize("key", ["transient", "window"])
def test_a_run_too_long_for_the_comparison_is_refused_by_the_key_that_made_it_so(key):
    """The step of the comparison has a default; each of the remedies that the line names is one."""
    long = {key: 2e7}
    with refused(f"{key}: 20000000.0", "solvers.step", "0.0061", "without: [solvers]"):
        load(**long)
    load(**long, solvers={"step": 0.0061})
    load(**long, without=["solvers"])
    load(**{key: 5e6})
    with refused("solvers.step: 0.003", "0.0061", "without: [solvers]"):
        load(**long, solvers={"step": 0.003})
    # No step is both short enough for the chain and long enough for the run.
    with refused(f"{key}: 600000000.0", "without: [solvers]"):
        load(**{key: 6e8}, sampling=1000)


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({}, [0.02, 0.05, 0.08, 0.2]),
        ({"a": [0.05, 0.1, 0.2]}, [0.05, 0.2]),
        ({"a": [0.01, 0.1, 0.3]}, [0.1]),  # the value nearest to 0.08, which the figures show
        ({"a": [0.01, 0.1, 0.3], "figures": {"a": 0.3}}, [0.3]),
        ({"a": [0.01, 0.1, 0.3], "solvers": {"a": [0.3, 0.01]}}, [0.01, 0.3]),
    ],
)
def test_where_solvers_are_compared(changes, expected):
    assert load(**changes).config["solvers"]["a"] == expected


@given(st.integers(0, 1000), st.integers(1, 50), st.sampled_from(["0.001", "0.0025", "0.0001", "0.0005"]))
def test_ranges_are_exact_decimals(first, count, step):
    """Every grid value is the double nearest to its decimal, so that a0.0800 is 0.08 and not 0.08000000000000002."""
    from decimal import Decimal

    from burridge_knopoff.study.grid import _range

    start = Decimal(first) * Decimal(step)
    stop = start + count * Decimal(step)
    values = _range({"from": float(start), "to": float(stop), "step": float(step)}, "a[0]")
    assert values == [float(start + k * Decimal(step)) for k in range(count + 1)]
