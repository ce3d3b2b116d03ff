"""Studies of grids, networks from a file, masses and random numbers: what determines and identifies their runs."""

import json
import shlex

import pytest

from burridge_knopoff.cli import build_parser
from burridge_knopoff.cli.options import join_signed, model_of, state_of
from burridge_knopoff.model.springs import read_edges
from burridge_knopoff.study.load import load_study
from tests.refused import refused

UNIFORM = {"random": "uniform", "low": 0.5, "high": 1.5, "seed": 1}
ROUGH = {"rough": {"position": {**UNIFORM, "low": -1.5}, "velocity": 0}}


def load(chain, initial=ROUGH, **keys):
    return load_study({"study": "x", "a": [0.1], "initial": initial, "chain": chain, **keys}, "config/mine.yaml")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The working folder of programs, with a config and a file of springs."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "config").mkdir()
    (tmp_path / "config" / "faults.txt").write_text("1 2 1.5  # the first fault\n3 2 0.5\n")
    return tmp_path


@pytest.mark.parametrize(
    ("chain", "blocks"),
    [
        ({"grid": [3, 2], "coupling": 2, "mass": UNIFORM, "threshold": UNIFORM}, 6),
        ({"grid": [3, 2], "coupling": [2, 0.5], "damping": [0, 0.1]}, 6),
        ({"springs": "faults.txt", "mass": [1, 2, 1]}, 3),
        ({"springs": "faults.txt", "blocks": 4, "pulling": 1}, 4),
        ({"blocks": 5, "ends": "ring", "mass": 2}, 5),
        ({"blocks": 3, "weakening": [1, -0.5, 1]}, 3),
        ({"blocks": 4, "weakening": {**UNIFORM, "low": -0.5}}, 4),
        ({"blocks": 10_000, "coupling": 100, "pulling": 1}, 10_000),
    ],
)
def test_the_command_of_a_run_contains_the_chain_and_the_state(folder, chain, blocks):
    study = load(chain, without=["solvers", "attractors"])
    assert study.blocks == study.config["chain"]["blocks"] == blocks
    command = study.command("linearized", "rough", "0.1000")
    assert len(command) < 500
    options = build_parser().parse_args(join_signed([*shlex.split(command)[1:], "--out", "x"]))
    state = state_of(options)
    assert state == study.state("rough")
    assert model_of(options, state) == study.model("linearized", 0.1)


def test_a_changed_file_of_springs_gives_another_run(folder):
    chain = {"springs": "faults.txt"}
    study = load(chain)
    assert study.config["chain"]["springs"].startswith("config/faults.txt@")
    assert load(chain).config == study.config
    (folder / "config" / "faults.txt").write_text("1 2 1.5\n3 2 0.25\n")
    assert load(chain).command("linearized", "rough", "0.1000") != study.command("linearized", "rough", "0.1000")
    assert load({"springs": str(folder / "config" / "faults.txt")}).config["chain"] == load(chain).config["chain"]
    with refused("config/mine.yaml: chain.springs: config/other.txt"):
        load({"springs": "other.txt"})
    (folder / "config" / "faults.txt").write_text("1 2 1.5\n3 4 0.25\n")
    with refused("config/mine.yaml: chain.pulling: 0"):
        load({"springs": "faults.txt", "pulling": [1, 0, 0, 0]})


def test_results_are_read_without_the_file_of_springs(folder, monkeypatch):
    study = load({"springs": "faults.txt"})
    (folder / "config" / "faults.txt").unlink()
    read_edges.cache_clear()
    again = load_study(json.loads(json.dumps(study.config)), "elsewhere/study.json")
    assert again.config == study.config
    assert not again.is_mirror_symmetric
    assert again.command("linearized", "rough", "0.1000") == study.command("linearized", "rough", "0.1000")


def test_a_study_of_runs_alone_may_have_a_large_chain():
    chain = {"grid": [400, 500], "pulling": 1}
    assert load(chain, without=["attractors", "solvers"], trajectory=1).blocks == 200_000
    with refused("attractors.samples: 1000"):
        load(chain, attractors={"samples": 1000}, without=["solvers"], trajectory=1)


def test_a_network_has_neither_phases_nor_other_lengths():
    study = load({"grid": [3, 1]})
    assert (study.single_length_key, study.is_mirror_symmetric) == ("grid", False)
    assert study.config["phases"]["a"] == []
    assert not study.proved_laws


def test_lists_are_limited_by_the_length_of_a_command():
    with refused("chain.mass", "1024"):
        load({"blocks": 2000, "mass": 2000 * [1]})
    assert load({"mass": 2}, {"one": {"position": -0.5, "velocity": 0}}).blocks == 1


def test_springs_by_distance_keep_their_form():
    """A list of positions still gives the number of blocks, and a record of the study repeats the config."""
    study = load({"grid": [5, 5], "springs": {"distance": "9/r**3", "cut_off": 4}, "pulling": 1})
    assert study.config["chain"]["springs"] == "distance=9/r**3,cut_off=4.0"
    again = load_study(json.loads(json.dumps(study.config)), "elsewhere/study.json")
    assert again.config == study.config
    state = {"one": {"position": [-0.9, -0.8, -0.7, -0.6], "velocity": [0, 0, 0, 0]}}
    row = load({"springs": {"distance": "1/r"}, "pulling": 1}, state)
    assert (row.blocks, row.single_length_key) == (4, "")
    with refused("config/mine.yaml: chain.pulling"):
        load({"blocks": 4, "springs": {"distance": "1/r"}})
