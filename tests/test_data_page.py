"""docs/data.md describes every variable of every file as the file itself does."""

import re
import runpy

import pytest

DICTIONARY = "docs/dictionary.py"


@pytest.mark.parametrize("name", ["paper", "four_laws"])
def test_the_page_has_every_variable(repository, small_studies, name):
    dictionary = runpy.run_path(str(repository / DICTIONARY))
    text = (repository / "docs/data.md").read_text(encoding="utf-8")
    described = re.findall(r"^\| `(\w+)`[^|]* \| (.*) \|$", text, re.MULTILINE)
    folder = small_studies(name).folder
    tables = {match["file"]: match[0] for match in dictionary["TABLE"].finditer(text)}
    files = {pattern: sorted(folder.glob(pattern)) for pattern in tables}
    assert sum(map(bool, files.values())) > 15
    for pattern, paths in files.items():
        for row in dictionary["rows"](paths[0]) if paths else ():
            meanings = [meaning for name, meaning in described if name == row.names[0]]
            assert any(phrase.startswith(row.meaning) for phrase in meanings), f"{row.listed}: python {DICTIONARY}"
            assert all(f"`{name}`" in tables[pattern] for name in row.names)


def test_every_summary_has_a_table(repository, small_studies):
    text = (repository / "docs/data.md").read_text(encoding="utf-8")
    for path in small_studies("paper").folder.glob("summary/*.nc"):
        assert f"<!-- variables of summary/{path.name} -->" in text
