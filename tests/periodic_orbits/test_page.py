"""docs/bifurcations.md prints what it says."""

import pytest

from tests.pages import outputs

pytestmark = pytest.mark.slow


def test_scripts(repository):
    results = outputs((repository / "docs" / "bifurcations.md").read_text(), "docs/bifurcations.md")
    assert len(results) == 2
    for _, said, printed in results:
        assert printed == said
