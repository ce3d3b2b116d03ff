"""The initial states of a study: those of the paper follow v, own numbers do not, and remarks tell what does not."""

import copy

import numpy as np
import pytest

from burridge_knopoff.model.initial import PAPER_STATES, InitialState, PaperState
from burridge_knopoff.provenance.record import write_study_record
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.study.remarks import remarks
from burridge_knopoff.study.study import all_points
from tests.refused import refused

NUMBERS = {name: {"position": [*s.position], "velocity": [*s.velocity]} for name, s in PAPER_STATES.items()}
OWN = {"position": [-1.0, -0.9, -1.1], "velocity": 0.1}


def study_of(initial, **changes):
    grid = {} if "grid" in changes else {"a": [0.05, 0.08]}
    return load_study(copy.deepcopy({"study": "x", "initial": initial, **grid, **changes}), "x.yaml")


def commands(study):
    return [study.command(**point) for point in all_points(study)]


@pytest.mark.parametrize("changes", [{}, {"v": 0.1}, {"v": 7.0, "grid": {"a": [0.05], "v": [0.1], "coupling": [1, 2]}}])
def test_at_the_v_of_the_paper_its_states_are_their_numbers(changes):
    short, long = (study_of(initial, **changes) for initial in ({"minus": {}, "plus": {}}, NUMBERS))
    assert short == long
    assert short.config["initial"] == NUMBERS
    assert commands(short) == commands(long)


@pytest.mark.parametrize("changes", [{"v": 0.2}, {"grid": {"a": [0.05], "v": [0.2, 0.3]}}])
def test_at_another_v_they_have_other_commands_than_their_numbers(tmp_path, changes):
    """Results of the numbers are thus out of date for a study of the states, and the reverse."""
    short, long = (study_of(initial, **changes) for initial in ({"minus": {}, "plus": {}}, NUMBERS))
    assert short.config["initial"] == {"minus": {}, "plus": {}}
    assert not {*commands(short)} & {*commands(long)}
    assert [study.state("plus") for study in (short, long)] == [
        PaperState("plus", **NUMBERS["plus"]),
        InitialState("plus", **NUMBERS["plus"]),
    ]
    for study in (short, long):
        write_study_record(str(tmp_path), study.config, study.parameters, "x.yaml", {}, "")
        assert recorded_study(tmp_path)[1] == study


def test_of_several_v_only_that_of_the_paper_has_the_numbers():
    grid = {"a": [0.05], "v": [0.05, 0.1, 0.2]}
    short, long = (study_of(initial, grid=grid) for initial in ({"plus": {}}, {"plus": NUMBERS["plus"]}))
    same = [command == other for command, other in zip(commands(short), commands(long), strict=True)]
    assert same == [point["v"] == "0.1000" for point in all_points(short)]


def test_the_states_of_the_paper_fix_the_number_of_blocks():
    assert study_of({"plus": {}}, v=0.2).blocks == 3
    with refused("initial", "plus: 3, pair: 2"):
        study_of({"plus": {}, "pair": {"position": [-1.0, -1.0], "velocity": [0.1, 0.1]}}, v=0.2)
    with refused("initial.plus", "3", "4"):
        study_of({"plus": {}}, v=0.2, chain={"blocks": 4})
    for name, hint in (("Plus", "plus?"), ("plsu", "plus?"), ("x", "")):
        with refused(f"initial.{name}", hint):
            study_of({name: {}})


FOLLOWS = "the numbers of the paper, which are for v = 0.1; with plus: {} they follow v"


@pytest.mark.parametrize(
    ("initial", "changes", "lines"),
    [
        ({"plus": {}, "own": OWN}, {}, []),
        ({"plus": {}, "own": OWN}, {"v": 0.2}, []),
        ({"plus": NUMBERS["plus"]}, {"v": 0.1}, []),
        ({"plus": NUMBERS["plus"], "own": OWN}, {"v": 0.2}, [f"plus: {FOLLOWS}"]),
        ({"plus": {}}, {"v": [0.1, 0.2]}, []),
        ({"plus": {}, "own": OWN}, {"v": [0.1, 0.2]}, ["own: the same numbers at every v"]),
        ({"plus": NUMBERS["plus"]}, {"v": [0.1, 0.2]}, ["plus: the same numbers at every v", f"plus: {FOLLOWS}"]),
        *(
            ({"plus": {}, "own": OWN}, {name: [1.0, 1.1]}, [f"plus, own: the same numbers at every {name}"])
            for name in ("coupling", "coupling[2]", "pulling", "pulling[1]", "mass", "mass[3]", "threshold")
        ),
        *(({"plus": {}, "own": OWN}, {name: [0.1, 0.2]}, []) for name in ("damping", "pulling_damping[1]")),
        ({"own": OWN}, {"mass": [1.1]}, []),
        (
            {"plus": {}, "own": OWN},
            {"v": [0.2, 0.3], "mass[3]": [1.0, 1.1]},
            [
                "plus: in proportion to v, but the same numbers at every mass[3]",
                "own: the same numbers at every v and mass[3]",
            ],
        ),
    ],
)
def test_remarks_name_the_states_that_do_not_follow(initial, changes, lines):
    varied = {name: values for name, values in changes.items() if isinstance(values, list)}
    study = study_of(initial, **({"grid": {"a": [0.05], **varied}} if varied else changes))
    assert remarks(study, {}) == [f"initial: {line}" for line in lines]


def test_the_marks_on_a_basin_map_are_the_states_of_its_model():
    maps = {"linearized": [0.05], "nonlinear": [0.05, 0.08]}
    shifted = {"position": [0.3, -0.993, 0.4], "velocity": NUMBERS["plus"]["velocity"]}
    study = study_of({"minus": {}, "plus": {}, "shifted": shifted}, v=0.2, basins={"a": maps})
    models = [study.model(law, a) for law, values in maps.items() for a in values]
    marks = study.marked_states
    # The plane of `minus` is another one than that of the numbers, which do not follow v.
    assert {*marks} == {"minus", "plus"}
    for name, points in marks.items():
        for model, point in zip(models, points, strict=True):
            position = model.begin(PAPER_STATES[name]).position + model.sliding_offset
            np.testing.assert_allclose(point, position[[0, -1]], rtol=1e-14)
    at_paper = study_of({"minus": {}, "plus": {}, "shifted": shifted}, basins={"a": maps}).marked_states
    assert at_paper == {"minus": [(-0.989, -0.991)] * 3, "plus": [(0.989, -0.991)] * 3, "shifted": [(0.3, 0.4)] * 3}


def test_a_study_of_another_chain_is_told_that_it_has_no_claims():
    line = "claims: none, since they are about the paper's chain of 3 blocks"
    five = {"own": {"position": [-1.0] * 5, "velocity": 0.1}}
    for chain, initial in (({"blocks": 5}, five), ({"pulling": 1.0}, {"own": OWN}), ({"ends": "ring"}, {"own": OWN})):
        assert line in remarks(study_of(initial, chain=chain), {})
        assert line not in remarks(study_of(initial, chain=chain, without=["claims"]), {})
    # The paper's chain in other words.
    assert line not in remarks(study_of({"plus": {}}, chain={"pulling": [1.0, 2.0, 1.0]}), {})
