"""docs/tongues.md prints what it says, in the sections that take seconds."""

import pytest

from tests.pages import outputs

pytestmark = pytest.mark.slow

SHORT = {"Parameters of single blocks and springs", "Synchrony: a tongue that ends at grazings"}


def test_short_sections(repository):
    results = outputs((repository / "docs" / "tongues.md").read_text(), "docs/tongues.md", SHORT)
    assert len(results) == 3
    for _, said, printed in results:
        assert printed == said
