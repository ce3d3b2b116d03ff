"""docs/data.md describes every variable of every file in the words of the file itself."""

import re
import runpy

import pytest

DICTIONARY = "docs/dictionary.py"


@pytest.mark.parametrize("name", ["one_law", pytest.param("four_laws", marks=pytest.mark.slow)])
def test_the_page_has_every_variable(repository, small_studies, name):
    dictionary = runpy.run_path(str(repository / DICTIONARY))
    text = (repository / "docs/data.md").read_text(encoding="utf-8")
    shown = {(match[1], match[2]) for match in re.finditer(r"^\| (`.*`) \|[^|]*\| (.*) \|$", text, re.MULTILINE)}
    folder = small_studies(name).folder
    tables = {match["file"]: match[0] for match in dictionary["TABLE"].finditer(text)}
    files = {pattern: sorted(folder.glob(pattern)) for pattern in tables}
    assert sum(map(bool, files.values())) > 15
    for pattern, paths in files.items():
        for row in dictionary["rows"](paths[0]) if paths else ():
            assert (row.listed, row.meaning) in shown, f"{pattern}: {row.listed}: python {DICTIONARY}"
            assert all(f"`{one}`" in tables[pattern] for one in row.names)


def test_every_summary_has_a_table(repository, small_studies):
    text = (repository / "docs/data.md").read_text(encoding="utf-8")
    for path in small_studies("one_law").folder.glob("summary/*.nc"):
        assert f"<!-- variables of summary/{path.name} -->" in text
