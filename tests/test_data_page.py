"""docs/variables.md describes every variable of every file as the file itself does."""

import re
import runpy

import pytest

DICTIONARY = "docs/dictionary.py"


@pytest.fixture(scope="module")
def sections(repository):
    """{pattern of files: its section}."""
    text = (repository / "docs/variables.md").read_text(encoding="utf-8")
    parts = re.split(r"^## `(.*)`$", text, flags=re.MULTILINE)
    return {re.sub("<.*?>", "*", name): part for name, part in zip(parts[1::2], parts[2::2], strict=True)}


@pytest.mark.parametrize("name", ["paper", "four_laws"])
def test_the_page_has_every_variable(repository, small_studies, sections, name):
    dictionary = runpy.run_path(str(repository / DICTIONARY))
    described = re.findall(r"^\| `(\w+)`[^|]* \| (.*) \|$", "".join(sections.values()), re.MULTILINE)
    folder = small_studies(name).folder
    files = {pattern: sorted(folder.glob(pattern)) for pattern in sections}
    assert sum(map(bool, files.values())) > 15
    for pattern, paths in files.items():
        assert not paths or dictionary["docstring"](paths[0]) in sections[pattern], f"{pattern}: python {DICTIONARY}"
        for row in dictionary["rows"](paths[0]) if paths else ():
            meanings = [meaning for name, meaning in described if name == row.names[0]]
            assert any(phrase.startswith(row.meaning) for phrase in meanings), f"{row.listed}: python {DICTIONARY}"
            assert all(f"`{name}`" in sections[pattern] for name in row.names)


def test_every_summary_has_a_table(small_studies, sections):
    summaries = {f"summary/{path.name}" for path in small_studies("paper").folder.glob("summary/*.nc")}
    assert len(summaries) > 10
    assert summaries <= sections.keys()
