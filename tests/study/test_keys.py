"""config/keys.md lists every key of a config, as the code defines it."""

import importlib.util
import re


def generator(repository):
    """Return docs/keys.py as a module."""
    spec = importlib.util.spec_from_file_location("keys", repository / "docs" / "keys.py")
    keys = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(keys)
    return keys


def test_the_tables_of_keys_are_those_of_the_code(repository):
    keys = generator(repository)
    text = keys.PAGE.read_text()
    assert keys.updated_tables(text) == text, "run python docs/keys.py"
    rows = re.findall(r"^\| `([a-z_.]+)` \|.*\|.*\|.*\|$", text, re.MULTILINE)
    assert set(keys.fields()) == set(rows)
    assert all(field.description for field in keys.fields().values())
    assert keys.updated_tables(text.replace("| 7000.0 |", "| 700.0 |")) == text
    assert keys.updated_tables(re.sub(r"^\| `catalogue.profiles`.*\n", "", text, flags=re.MULTILINE)) == text
