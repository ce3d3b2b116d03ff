"""Pages on what others published print what they say and draw what they show, in the sections that take seconds."""

import numpy as np
import pytest
from matplotlib.image import imread

from tests.pages import outputs

pytestmark = pytest.mark.slow

SHORT = {
    "published.md": {"Huang and Turcotte: two unequal blocks", "De Sousa Vieira: chaos of equal blocks"},
    "continuum.md": {"The size of the blocks, and dashpots that remove most of its effect"},
}


@pytest.mark.parametrize("page", SHORT)
def test_short_sections(repository, tmp_path, monkeypatch, page):
    monkeypatch.chdir(tmp_path)
    results = outputs((repository / "docs" / page).read_text(), f"docs/{page}", SHORT[page])
    assert {block.heading for block, _, _ in results} == SHORT[page]
    for _, said, printed in results:
        assert printed == said
    for made in tmp_path.glob("docs/figures/*"):
        mine, committed = (imread(path) for path in (made, repository / "docs" / "figures" / made.name))
        assert mine.shape == committed.shape
        assert np.abs(mine - committed).mean() < 0.001
