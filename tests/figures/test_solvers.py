"""The table of independent solvers: its numbers are those of the summary."""

import numpy as np
import xarray as xr

from burridge_knopoff.figures.solvers import draw

NAMES = ("law", "solver", "initial", "a")


def solvers():
    """Return one law, of which the second solver differs, the third rounds, and the fourth does not apply."""
    values = {
        "mean_distance": [0.1327, 0.1328, 0.1327, np.nan],
        "mean_distance_error": [7e-6, 7e-6, 7e-6, np.nan],
        "difference": [0.0, -1e-4, 3e-15, np.nan],
        "difference_error": [0.0, 2e-5, 1e-14, np.nan],
        "status": [0, 0, 0, -1],
        "step_count": [143, 40_000, 250, 0],
        "end_time": [100.0, 100.0, 100.0, np.nan],
    }
    data = {name: (NAMES, np.reshape(numbers, (1, 4, 1, 1))) for name, numbers in values.items()}
    coordinates = {"law": ["linearized"], "solver": ["series", "rk4", "map", "other"], "initial": ["plus"], "a": [0.05]}
    return xr.Dataset(data, coordinates, {"solver_linearized": "series"})


def test_a_row_has_the_numbers_of_each_solver_that_applies():
    (panel,) = draw(solvers()).axes
    words = [text.get_text() for text in panel.texts]
    head, row = words[: len(words) // 2], words[len(words) // 2 :]
    table = dict(zip(head, row, strict=True))
    assert (table["initial state"], table["$a$"]) == ("plus", "0.05")
    assert table[r"$\langle J\rangle$, series"] == r"0.1327 ± $7\times10^{-6}$"
    assert table[r"$|\Delta\langle J\rangle|$, rk4"] == r"$1\times10^{-4}$ ± $2\times10^{-5}$"
    # Rounding is 0.
    assert table[r"$|\Delta\langle J\rangle|$, map"] == "0"
    assert [table[f"steps, {name}"] for name in ("series", "rk4", "map")] == ["1.43", "400", "2.50"]
    assert not any("other" in name for name in head)
