"""The origin of a file of a study: with what it was made, and whether that is still what its study asks for.

A netCDF file has its origin in global attributes, a PNG picture and a report in their metadata, claims.json in a key.
The other texts and the PDF pictures have none: they were made together with one of these.
"""

from __future__ import annotations

import html
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.provenance.keys import difference, value_of
from burridge_knopoff.provenance.opening import open_whole
from burridge_knopoff.provenance.whole import check_whole

#: Name of the origin in the metadata of a picture or a report, and in claims.json.
NAME = "origin"
#: Suffixes of the files that contain their origin.
_WITH_ORIGIN = (".nc", ".png", ".json", ".html")
_META = re.compile(r'<meta name="origin" content="([^"]*)">')


@dataclass(frozen=True)
class Origin:
    """With what a file was made.

    file : its name in the results of its study
    rule : name of the rule
    params : {key of the config: value} on which it depends, itself or by its inputs, see `provenance.keys`
    inputs : {file: its checksum} of other rules that the job read, except points
    rule_fingerprint : of the sources of the rule
    """

    file: str
    rule: str
    params: Mapping[str, Any]
    inputs: Mapping[str, str]
    rule_fingerprint: str

    def attributes(self) -> dict[str, str]:
        """Return the global attributes of a netCDF file: texts, of which some are JSON."""
        return {name: value if isinstance(value, str) else json.dumps(value) for name, value in vars(self).items()}

    @classmethod
    def from_attributes(cls, attributes: Mapping[str, Any]) -> Origin | None:
        """Return the origin in the attributes of a netCDF file; None if it was not made in a study."""
        try:
            values = {name: attributes[name] for name in cls.__dataclass_fields__}
            return cls(**{**values, **{name: json.loads(values[name]) for name in ("params", "inputs")}})
        except (KeyError, ValueError, TypeError):
            return None


#: Attributes that belong to one file, not to its content.
OWN_ATTRIBUTES = (*Origin.__dataclass_fields__, "checksum")


def with_origin(text: str, name: str, origin: Origin) -> str:
    """Return a text of a study with its origin, if its format has a place for it."""
    if name.endswith(".json"):
        return json.dumps({**json.loads(text), NAME: vars(origin)}, ensure_ascii=False, indent=1) + "\n"
    meta = f'<meta name="{NAME}" content="{html.escape(json.dumps(vars(origin)))}">'
    return text.replace("</head>", f"{meta}\n</head>", 1) if name.endswith(".html") else text


def read_origin(path: Path) -> tuple[Origin | None, str]:
    """Return the origin of an intact file of a study, and its checksum.

    Raises BadFile if the file is missing or corrupt.
    """
    if path.suffix == ".nc":
        with open_whole(path) as dataset:
            return Origin.from_attributes(vars(dataset)), dataset.checksum
    checksum = check_whole(path)
    try:
        return Origin(**embedded_origin(path)), checksum
    # None, or none that can be read.
    except (OSError, ValueError, SyntaxError, TypeError, AttributeError):
        return None, checksum


def embedded_origin(path: Path) -> dict[str, Any]:
    """Return the origin in a text or a picture as a mapping; empty if it has none."""
    match path.suffix:
        case ".png":
            from PIL import Image

            with Image.open(path, formats=["PNG"]) as picture:
                return json.loads(picture.info.get(NAME, "{}"))
        case ".json":
            return json.loads(path.read_text(encoding="utf-8")).get(NAME, {})
        case ".html":
            match = _META.search(path.read_text(encoding="utf-8"))
            return json.loads(html.unescape(match[1])) if match else {}
        case _:
            return {}


def check_origin(path: Path, results: Path, record: Mapping[str, Any]) -> tuple[Origin | None, str]:
    """Check that a file is whole, and was made for its place in a study and with the params of the study.

    record : of the study, see `provenance.record`

    Returns its origin, None for a text or a picture that has none, and its checksum.
    Raises BadFile, one line with the difference. Files that other sources made are accepted.
    """
    origin, checksum = read_origin(path)
    name = path.relative_to(results).as_posix()
    if origin is None:
        if path.suffix in _WITH_ORIGIN:
            raise BadFile(path, "was not made in a study")
    elif origin.file != name:
        raise BadFile(path, f"is another file: got {origin.file}, expected {name}")
    elif words := other_params(origin.params, record):
        raise BadFile(path, f"was made with {words}")
    return origin, checksum


def other_params(params: Mapping[str, Any], record: Mapping[str, Any]) -> str:
    """Return in words the first param that differs from that of a study; empty if all are equal."""
    pairs = ((key, value, value_of(record["config"], record["grid"], key)) for key, value in params.items())
    return next(filter(None, (difference(value, expected, key) for key, value, expected in pairs)), "")
