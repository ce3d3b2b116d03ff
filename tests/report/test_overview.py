"""The setting of a study in words: terms are explained where they stand, and the caption is about this chain."""

import pytest

from burridge_knopoff.report.overview import convention_words, explanations, sketch_caption
from burridge_knopoff.study.load import load_study
from tests.small_study import SMALL, STUDIES


@pytest.mark.parametrize(
    ("chain", "said", "unsaid"),
    [
        ({}, ["Springs couple neighbouring blocks"], ["first two", "Dashpots", "not drawn", "F is", "w of"]),
        ({"blocks": 9}, ["Only the first two blocks and the last are drawn."], ["Dashpots"]),
        ({"blocks": 1}, ["A spring connects the block to a driver"], ["neighbouring"]),
        ({"threshold": [1.0, 1.1, 1.0]}, ["F is the static friction"], ["weakening"]),
        ({"damping": 0.1}, ["Dashpots are not drawn."], ["static friction"]),
        ({"grid": [2, 2]}, ["The springs between the blocks are not drawn."], ["neighbouring"]),
    ],
)
def test_the_caption_of_the_sketch_is_about_this_chain(chain, said, unsaid):
    blocks = chain.get("blocks", 4 if "grid" in chain else 3)
    state = {"pushed": {"position": [-0.9] * (blocks - 1) + [-1.0], "velocity": [0.1] * blocks}}
    caption = sketch_caption(load_study({**SMALL, "chain": chain, "initial": state}, "small.yaml"))
    assert all(words in caption for words in said), caption
    assert not any(words in caption for words in unsaid), caption


def test_terms_are_explained_where_they_stand():
    study = load_study({**SMALL, **STUDIES["one_law"]}, "small.yaml")
    assert explanations("All 31 runs are moving on.", study) == []
    assert explanations("quasiperiodic at 3 values of a", study) == [
        "Quasiperiodic: no repetition was found within 2000 time units."
    ]
    start, contact = (
        "Start: moving (every block slips at τ = 0); tested (a block sticks at τ = 0 if static friction can hold it).",
        "Contact: one-sided (a stuck block never slips backward); "
        "symmetric (a stuck block slips backward if the force on it is large enough).",
    )
    assert explanations("with the other start plus reaches another attractor", study) == [start]
    assert explanations("under (one_sided, tested) it holds", study) == [contact, start]
    assert convention_words("symmetric, moving") == "symmetric contact, moving start"
    assert convention_words("only from there on") == "only from there on"
