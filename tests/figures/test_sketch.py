"""The sketch of the chain: blocks, springs with their strengths, and what has no room is left out."""

import pytest

from burridge_knopoff import Chain
from burridge_knopoff.figures.sketch import draw


def words(**chain):
    return [text.get_text() for text in draw(Chain(**chain)).axes[0].texts]


def test_the_paper_s_chain_has_twice_as_strong_a_spring_at_its_middle_block():
    assert [word for word in words(blocks=3) if word.strip("$").isdigit()] == ["1", "$1$", "2", "$2$", "3", "$1$"] + [
        "$1$"
    ] * 2


@pytest.mark.parametrize(("blocks", "names"), [(2, ["1", "2"]), (6, list("123456")), (40, ["1", "2", "40"])])
def test_long_chains_are_drawn_by_their_ends(blocks, names):
    said = words(blocks=blocks, pulling=7.0)
    assert [word for word in said if word.isdigit()] == names
    assert said.count("$7$") == len(names)
    assert ("· · ·" in said) == (blocks > 6)


def test_what_differs_between_blocks_is_said():
    said = words(blocks=3, coupling=[1.0, 1.5, 2.5], threshold=[1.0, 1.2, 1.0], ends="ring")
    assert {"$1$", "$1.5$", "$F=1.2$", "a spring of strength $2.5$ couples block 3 to block 1"} <= set(said)


def test_the_springs_of_a_grid_are_said():
    assert "springs of strength $2$ couple a grid of 3 × 2 blocks" in words(grid=(3, 2), coupling=2.0)
    said = "springs of strength $2$ along rows and $0.5$ along columns couple a grid of 3 × 2 blocks"
    assert said in words(grid=(3, 2), coupling=(2.0, 0.5))


def test_dashpots_are_said():
    said = words(blocks=3, damping=[0.1, 0.3], pulling_damping=0.2)
    assert "dashpots $0.1$ to $0.3$ between blocks\ndashpots $0.2$ to the driver" in said
    assert not any("dashpots" in word for word in words(blocks=3))
