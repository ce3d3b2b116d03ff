"""Files that state another origin than the true one, with a checksum that fits."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import netCDF4

from burridge_knopoff.provenance.checksum import add_checksum


def forge(path: Path, **attributes: Any) -> None:
    """Change global attributes of a netCDF file, and its checksum; None removes an attribute."""
    with netCDF4.Dataset(path, "a") as dataset:
        for name, value in attributes.items():
            if value is None:
                dataset.delncattr(name)
            else:
                dataset.setncattr(name, value)
        add_checksum(dataset)
