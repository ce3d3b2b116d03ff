"""Grids of several parameters: points, file names and models, and a one-line message for each error."""

from itertools import chain, pairwise, product

import netCDF4
import pytest

from burridge_knopoff.check.leftovers import leftovers
from burridge_knopoff.provenance.files import write_text
from burridge_knopoff.provenance.record import write_study_record
from burridge_knopoff.study.chunks import MOST, chunks
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.points import make_points
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.study.study import Study, all_points, run_files
from burridge_knopoff.study.yaml_file import ConfigError
from tests.refused import refused

PAIR = {"pair": {"position": [-0.9, -1.1], "velocity": [0.1, 0.1]}}
GRID = {"v": [0.1, 0.05], "a": [0.2], "coupling": [{"from": 0.5, "to": 2, "step": 0.5}]}


def load(**changes):
    config = {"study": "plane", "initial": PAIR, "grid": GRID, **changes}
    return load_study({key: value for key, value in config.items() if value is not None}, "plane.yaml")


def test_points_are_named_in_the_order_of_the_config_and_contain_their_parameters():
    study = load()
    points = all_points(study)
    names = [study.point_file.format(**point) for point in points]
    assert names[:2] == [f"linearized/pair/v0.0500_a0.2000_coupling{value}.nc" for value in ("0.5000", "1.0000")]
    assert len({*names}) == len(names) == 2 * 2 * 4
    for point in points:
        model, _, _ = study.run_of(**point)
        parameters = {"law": model.law.name, "v": model.v, "a": model.parameter("a"), "coupling": model.chain.coupling}
        assert parameters == {name: point["law"] if name == "law" else float(point[name]) for name in parameters}
    command = study.command(**points[0])
    assert all(words in command for words in ("--a 0.2", "--v 0.05", "--coupling 0.5"))


def test_the_value_of_one_block_is_a_parameter():
    study = load(grid={"a": [0.2], "mass[2]": [1.0, 1.5]})
    points = all_points(study)
    assert [study.point_file.format(**point) for point in points[:2]] == [
        "linearized/pair/a0.2000_mass_2_1.0000.nc",
        "linearized/pair/a0.2000_mass_2_1.5000.nc",
    ]
    assert [study.run_of(**point)[0].chain.masses.tolist() for point in points[:2]] == [[1.0, 1.0], [1.0, 1.5]]
    assert "--mass 1.0,1.5" in study.command(**points[1])
    assert not any(letter in name for name in run_files(study) for letter in "[]")
    assert study.chain.mass == (1.0, 1.0)
    # A number for all blocks, and one for a single block.
    both = load(grid={"a": [0.2], "mass[2]": [1.0, 1.5], "mass": [1.0, 2.0]})
    masses = {tuple(both.run_of(**point)[0].chain.masses.tolist()) for point in all_points(both)}
    assert masses == {(1.0, 1.0), (1.0, 1.5), (2.0, 1.0), (2.0, 1.5)}


def test_a_grid_of_a_alone_equals_the_key_a():
    alone, usual = load(grid={"a": [0.1, 0.2]}), load(grid=None, a=[0.1, 0.2])
    assert (alone.config, alone.parameters) == (usual.config, usual.parameters)
    assert not alone.is_plane


def test_ranges_may_overlap_and_each_value_is_simulated_once():
    coarse, fine = {"from": 0, "to": 0.3, "step": 0.1}, {"from": 0.05, "to": 0.15, "step": 0.025}
    merged = [0.0, 0.05, 0.075, 0.1, 0.125, 0.15, 0.2, 0.3]
    for items in ([coarse, fine], [fine, coarse, 0.1], [*reversed(merged), -0.0, fine]):
        for study in (load(grid=None, a=items), load(grid={"v": items[-1:], "a": items})):
            assert list(study.grid.values()) == merged
    assert list(load(grid={"a": [0.1], "v": [coarse | {"from": 0.1}, fine]}).parameters["v"].values()) == merged[1:]
    chains = load(chains={"a": [coarse, fine]}).config["chains"]
    assert chains["a"] == merged
    # The double nearest to each decimal, whatever the range.
    steps = load(grid=None, a=[{"from": 0, "to": 0.3, "step": step} for step in (0.0025, 0.005, 0.01)])
    assert list(steps.grid.values()) == [k / 400 for k in range(121)]


def test_a_number_of_a_law_is_a_parameter():
    study = load(laws={"drop": {"law": "carlson_langer"}}, grid={"a": [2], "sigma": [0.01, 0.05]})
    assert [study.run_of(**point)[0].law.parameters["sigma"] for point in all_points(study)] == [0.01, 0.05]


BOTH = {"linearized": {}, "drop": {"law": "carlson_langer"}}


def test_a_number_with_one_value_is_of_the_laws_that_have_it():
    study = load(laws=BOTH, grid={"a": [2], "sigma": [0.02], "v": [0.1, 0.2]}, figures={"law": "drop"})
    models = [study.run_of(**point)[0] for point in all_points(study)]
    numbers = {law: {(*model.law.parameters.items(),) for model in models if model.law.name == law} for law in BOTH}
    assert numbers == {"linearized": {(("a", 2.0),)}, "drop": {(("a", 2.0), ("sigma", 0.02))}}
    assert all("sigma0.0200" in study.run_file(**point) for point in all_points(study))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"a": [0.1]}, ["a: [0.1]", "grid"]),
        ({"grid": None}, ["a: ", "grid"]),
        ({"grid": {"v": [0.1, 0.2]}}, ["grid.a: "]),
        ({"grid": {"a": [0.1], "speed": [1]}}, ["speed: ", "coupling"]),
        ({"grid": {"a": [0.1], "sigma": [0.1, 0.2]}}, ["sigma: ", "linearized"]),
        ({"grid": {"a": [0.1], "sigma": [0.1]}}, ["sigma: ", "linearized"]),
        ({"laws": BOTH, "grid": {"a": [0.1], "sigma": [0.1, 0.2]}}, ["sigma: ", "linearized"]),
        ({"grid": {"a": [0.1], "v": [0.1, 0.100001]}}, ["grid.v: ", "0.1 and 0.100001", "v0.1000.nc", "a_digits"]),
        ({"grid": {"a": [0.1], "v": []}}, ["grid.v: ", "[]"]),
        ({"grid": {"a": [0.1], "v": [0.1, 0]}}, ["v: 0.0"]),
        ({"grid": {"a": [-1], "v": [0.1]}}, ["laws.a: -1.0"]),
        ({"grid": {"a": [0.1], "initial": [0.1]}}, ["grid: 'initial'"]),
        ({"grid": {"a": [0.1], "coupling": [1, 2]}, "chain": {"coupling": [1.5]}}, ["coupling: "]),
        (
            {"grid": {"a": [{"from": 0, "to": 1, "step": 0.001}], "v": [{"from": 1, "to": 2, "step": 0.01}]}},
            ["grid", "202202 points", "1001", "101", "100000"],
        ),
        (
            {"solver": "map", "laws": {"linearized": {}}, "grid": {"a": [0.1, 9], "coupling": [1]}},
            ["solver.linearized: "],
        ),
    ],
)
def test_a_wrong_grid_gets_one_line(changes, words):
    with refused("plane.yaml", *words, error=ConfigError):
        load(**changes)


@pytest.mark.parametrize("values", [3, 40, 1500, pytest.param(24_000, marks=pytest.mark.slow)])
def test_chunks_are_all_points_in_order(values):
    study = load(grid={"a": [0.2], "v": [{"from": 0.001, "to": values / 1000, "step": 0.001}]})
    parts = chunks(study)
    assert list(chain(*parts.values())) == all_points(study)
    assert sorted(parts) == list(parts)
    sizes = [len(part) for part in parts.values()]
    assert max(sizes) <= MOST
    assert all(size == sizes[0] >= last for size, last in pairwise(sizes))
    assert not chunks(load(grid=None, a=[0.1, 0.2]))


def write_run(path, values):
    """Write what a point file says of its run."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with netCDF4.Dataset(path, "w") as dataset:
        dataset.law, dataset.initial = "linearized", "pair"
        for name, value in values.items():
            dataset.createVariable(name, "f8")[...] = value


def test_the_record_of_a_study_is_read_again_and_its_leftovers_are_known(tmp_path):
    small = load(grid={"a": [0.2], "v": [0.1, 0.2]})
    results = tmp_path / "results" / "plane"
    results.mkdir(parents=True)
    write_study_record(results, small.config, small.parameters, "plane.yaml", {}, "")
    assert recorded_study(results)[1] == small
    # {name: values in the file, whether it is left over}
    files = {
        "a0.2000_v0.1000": ({"a": 0.2, "v": 0.1}, False),
        "a0.2000_v0.3000": ({"a": 0.2, "v": 0.3}, True),
        "a0.2000_v0.4000": ({"a": 0.2, "v": 0.3}, False),
        "a0.2000": ({"a": 0.2, "v": 0.1}, True),
        "a0.2000_coupling-0.5000_v0.1000": ({"a": 0.2, "coupling": -0.5, "v": 0.1}, True),
        "notes": ({"a": 0.2}, False),
    }
    points, logs = (results / f"{folder}/linearized/pair" for folder in ("points", "logs/simulate"))
    for name, (values, _) in files.items():
        write_run(points / f"{name}.nc", values)
        (logs / f"{name}.log").parent.mkdir(parents=True, exist_ok=True)
        (logs / f"{name}.log").touch()
    expected = {
        path for name, (_, left) in files.items() for path in (points / f"{name}.nc", logs / f"{name}.log") if left
    }
    assert {*leftovers(results, small)} == expected


def test_a_point_that_fails_is_named_with_its_command_and_the_others_are_made(tmp_path):
    """At a = 9 there is no closed form; a config check would refuse it."""
    run = {"transient": 10, "window": 10, "batches": 2, "solver": "map", "laws": {"linearized": {}}}
    checked = load(grid={"a": [0.1], "v": [0.1, 0.2]}, **run)
    study = Study(checked.config, {"a": {"9.0000": 9.0, "0.1000": 0.1}, "v": checked.parameters["v"]})
    with refused("a9.0000_v0.1000.nc", "bk simulate", "--a 9.0", "1 more point", error=RuntimeError):
        make_points(study, all_points(study), tmp_path)
    assert {path.name for path in tmp_path.rglob("*") if path.is_file()} == {"a0.1000_v0.1000.nc", "a0.1000_v0.2000.nc"}
    assert make_points(study, [point for point in all_points(study) if point["a"] == "0.1000"], tmp_path) == 0


def test_a_grid_whose_file_names_are_too_long_is_refused(tmp_path):
    """What is accepted can be written in a file system with names of at most 255 bytes, and nothing longer."""
    lengths = {True: set(), False: set()}
    for count, longer in product((15, 16), range(16)):
        state = {"wave": {"position": [-0.9] * 24, "velocity": [0.1] * 24}}
        values = {block: 1.0 if block > longer else 10.0 for block in range(1, count + 1)}
        grid = {"a": [0.05], **{f"mass[{block}]": [value] for block, value in values.items()}}
        name = "_".join(["a0.0500", *(f"mass_{block}_{value:.4f}" for block, value in values.items())]) + ".nc"
        words = ""
        try:
            load(initial=state, grid=grid, chain={"blocks": 24})
        except ConfigError as error:
            words = str(error)
        lengths[not words].add(len(name))
        if words:
            assert words.startswith(f"plane.yaml: grid: got points with file names of {len(name)} characters (a0.0500")
            assert words.endswith("expected at most 240: fewer parameters, shorter numbers, or fewer a_digits")
            with pytest.raises(OSError, match="File name too long"):
                write_text(tmp_path / name, "")
        else:
            write_text(tmp_path / name, "")
    assert (max(lengths[True]), min(lengths[False])) == (240, 241)
