"""docs/published.md prints what it says and draws what it shows, in the sections that take seconds."""

import numpy as np
import pytest
from matplotlib.image import imread

from tests.pages import outputs

pytestmark = pytest.mark.slow

SHORT = {"Huang and Turcotte: two unequal blocks", "De Sousa Vieira: chaos of equal blocks"}


def test_short_sections(repository, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    results = outputs((repository / "docs" / "published.md").read_text(), "docs/published.md", SHORT)
    assert {block.heading for block, _, _ in results} == SHORT
    for _, said, printed in results:
        assert printed == said
    (made,) = (tmp_path / "docs" / "figures").iterdir()
    mine, committed = (imread(path) for path in (made, repository / "docs" / "figures" / made.name))
    assert mine.shape == committed.shape
    assert np.abs(mine - committed).mean() < 0.001
