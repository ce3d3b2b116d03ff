"""docs/tutorial.md: its code runs, and gives the outputs and pictures of the page."""

import re

import numpy as np
import pytest
from matplotlib.image import imread

from tests.pages import blocks, outputs

pytestmark = pytest.mark.slow

FROM_FILES = "From the files of a study"
#: Tested in test_notebook.py, without ipywidgets.
SLIDER = "A slider over a"


def test_the_tutorial_prints_what_it_says(repository, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "docs/figures").mkdir(parents=True)
    page = (repository / "docs" / "tutorial.md").read_text()
    headings = {block.heading for block in blocks(page)} - {FROM_FILES, SLIDER}
    results = outputs(page, "docs/tutorial.md", headings)
    assert len(results) >= 5
    for _, expected, printed in results:
        assert printed == expected
    names = re.findall(r"!\[.*?\]\((figures/tutorial_\w+\.png)\)", page)
    figures = sorted(str(path.relative_to(tmp_path / "docs")) for path in tmp_path.rglob("*.png"))
    assert figures == sorted(names)
    for name in names:
        mine, committed = (imread(folder / "docs" / name) for folder in (tmp_path, repository))
        assert mine.shape == committed.shape
        # Another version of matplotlib may shade an edge differently; a missing curve gives 0.003.
        assert np.abs(mine - committed).mean() < 0.001, name
