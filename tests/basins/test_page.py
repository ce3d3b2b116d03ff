"""docs/attractors.md prints what it says of the boundaries."""

import pytest

from tests.pages import outputs

pytestmark = pytest.mark.slow


def test_script(repository):
    results = outputs((repository / "docs" / "attractors.md").read_text(), "docs/attractors.md")
    assert len(results) == 1
    for _, said, printed in results:
        assert printed == said
