"""The schema of a config for editors is current, named by each config, and as strict as the range of each key.

tests/fuzzing/test_configs.py checks that it accepts all valid configs.
"""

import contextlib
import math
from functools import reduce
from pathlib import Path

import pytest
from jsonschema import Draft7Validator

from burridge_knopoff.study.config import CONFIG
from burridge_knopoff.study.grid import resolve_grid
from burridge_knopoff.study.yaml_file import ConfigError, read_config
from tests.bad_configs import BAD_FILES
from tests.fuzzing.test_configs import RANGE_OF, SCHEMA
from tests.study.bad_changes import BAD_CHANGES
from tests.study.test_keys import generator

ROOT = Path(__file__).parents[2]
GOOD = {"study": "test", "a": [0.08], "initial": {"minus": {}}}
#: What only the package refuses: NaN, a line break at the end of a text, the order of two numbers, an unreadable file,
#: and a key that is not a text, which no file can have.
BEYOND_A_SCHEMA = ("got nan", r"got 'x\n'", "low < high", "at least low", "cannot be read", "initial: got 1,")
BEYOND_A_SCHEMA += ("or a formula of v: ",)


def range_error(config):
    """Return the message with which a range of a key refuses a config; empty if only other rules may refuse it."""
    try:
        CONFIG.form(resolve_grid(config), "")
    except ValueError as error:
        return str(error)
    return ""


def test_the_schema_is_that_of_the_keys(repository):
    keys = generator(repository)
    assert keys.SCHEMA.read_text() == keys.config_schema(), "run python docs/keys.py"
    Draft7Validator.check_schema(SCHEMA.schema)


@pytest.mark.parametrize("path", sorted((ROOT / "config").rglob("*.yaml")), ids=lambda path: path.stem)
def test_a_config_names_the_schema_and_is_valid(path):
    name = path.read_text().splitlines()[0].removeprefix("# yaml-language-server: $schema=")
    assert (path.parent / name).resolve() == ROOT / "workflow/schemas/config.schema.yaml"
    SCHEMA.validate(read_config(path))


def test_the_schema_refuses_what_the_ranges_refuse(tmp_path):
    configs = [
        {key: value for key, value in {**GOOD, **changes}.items() if value is not None} for changes, _ in BAD_CHANGES
    ]
    for name, (content, _) in BAD_FILES.items():
        path = tmp_path / f"{name}.yaml"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        with contextlib.suppress(ConfigError):
            configs.append(read_config(path))
    errors = [error for config in configs if (error := range_error(config)) and SCHEMA.is_valid(config)]
    assert [error for error in errors if not any(words in error for words in BEYOND_A_SCHEMA)] == []


@pytest.mark.parametrize("key", RANGE_OF)
def test_numbers_at_and_beyond_the_ends_of_their_range(key):
    low, high = RANGE_OF[key]
    least, kind = float(low.strip(">")), int if low.isdigit() else float
    allowed = [kind(high)] if low.startswith(">") else [kind(least), kind(high)]
    beyond = [least] if low.startswith(">") else [math.nextafter(least, -math.inf)]
    *sections, name = key.split(".")
    for value in (*allowed, *beyond, math.nextafter(high, math.inf), math.inf, True, "1e-6"):
        changes = reduce(lambda inside, section: {section: inside}, reversed(sections), {name: value})
        assert SCHEMA.is_valid({**GOOD, **changes}) == any(value is member for member in allowed), (key, value)
