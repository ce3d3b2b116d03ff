"""Pages of docs/: the outputs and pictures of the sections that take seconds are those that their code gives."""

from collections import Counter

import numpy as np
import pytest
from matplotlib.image import imread

from tests.pages import outputs

pytestmark = pytest.mark.slow

#: Headings of these sections, and how many outputs there are below each.
SHORT = {
    "model.md": {"Units": 1},
    "attractors.md": {"What lies on the boundaries": 1},
    "bifurcations.md": {"Orbits without stops": 1, "Bifurcation curves in two parameters": 1},
    "published.md": {
        "Huang and Turcotte: two unequal blocks": 1,
        "De Sousa Vieira: chaos of equal blocks": 1,
        "Stender and Hoffmann: one block on a belt": 1,
        "Vasconcelos: the onset of slip": 1,
        "Amundsen: the speed of fronts": 1,
        "Rice, Myers, Langer and Shaw: the size of the blocks": 1,
    },
    "studies.md": {"Asperities and barriers": 1},
    "tongues.md": {"What shows locking": 1},
}


@pytest.mark.parametrize("page", SHORT)
def test_short_sections(repository, tmp_path, monkeypatch, page):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "docs/figures").mkdir(parents=True)
    results = outputs((repository / "docs" / page).read_text(), f"docs/{page}", set(SHORT[page]))
    assert Counter(block.heading for block, _, _ in results) == SHORT[page]
    for _, expected, printed in results:
        assert printed == expected
    figures = list(tmp_path.glob("docs/figures/*"))
    assert len(figures) == (page == "published.md")
    for path in figures:
        mine, committed = (imread(picture) for picture in (path, repository / "docs" / "figures" / path.name))
        assert mine.shape == committed.shape
        assert np.abs(mine - committed).mean() < 0.001


def test_chains_of_the_default_study(repository, monkeypatch):
    if not (repository / "results/paper/summary/chains.nc").exists():
        pytest.skip("the target `chains` of the default study has not run")
    monkeypatch.chdir(repository)
    [(_, expected, printed)] = outputs((repository / "docs/studies.md").read_text(), "studies.md", {"Longer chains"})
    assert printed == expected
