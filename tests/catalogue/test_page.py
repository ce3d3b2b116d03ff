"""docs/catalogues.md prints what it says."""

from tests.pages import outputs


def test_the_page_prints_what_it_says(repository):
    results = outputs((repository / "docs" / "catalogues.md").read_text(), "catalogues.md")
    assert results
    for _, said, printed in results:
        assert printed == said
