"""docs/catalogues.md: its code prints the output that it shows."""

import pytest

from tests.pages import outputs


@pytest.mark.slow
def test_the_page_shows_what_its_code_prints(repository):
    results = outputs((repository / "docs" / "catalogues.md").read_text(), "catalogues.md")
    assert results
    for _, expected, printed in results:
        assert printed == expected
