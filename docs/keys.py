"""Make the tables of keys in config/README.md from the fields of a config: python docs/keys.py.

Each row is regenerated from the key in its first cell. The order of the keys and all other text are written by hand.
"""

import re
from pathlib import Path

import yaml

from burridge_knopoff.model.fields import FOLLOWS, REQUIRED, Field, Keys
from burridge_knopoff.study.config import CONFIG

PAGE = Path(__file__).parent.parent / "config" / "README.md"

_SYMBOLS = {"|": "\\|", "<J>": "⟨J⟩", "tau": "τ"}


def fields(keys: Keys = CONFIG, section: str = "") -> dict[str, Field]:
    """Return the fields of a config by their full keys, such as `motion.zero_exponent`."""
    found: dict[str, Field] = {}
    for name, field in keys.fields.items():
        inside = isinstance(field.range, Keys)
        found |= fields(field.range, f"{section}{name}.") if inside else {section + name: field}
    return found


def refreshed(text: str) -> str:
    """Return the page with the rows of all keys brought up to date."""
    known = fields()
    return re.sub(
        r"^\| `([a-z_.]+)` \|.*$",
        lambda row: _row(row[1], known[row[1]]) if row[1] in known else row[0],
        text,
        flags=re.MULTILINE,
    )


def _row(key: str, field: Field) -> str:
    default = "" if field.default in (REQUIRED, FOLLOWS) else yaml.safe_dump(field.default, default_flow_style=True)
    cells = [f"`{key}`", default.removesuffix("...\n").strip(), str(field.range), field.description]
    for plain, shown in _SYMBOLS.items():
        cells[1:] = [cell.replace(plain, shown) for cell in cells[1:]]
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    PAGE.write_text(refreshed(PAGE.read_text()))
