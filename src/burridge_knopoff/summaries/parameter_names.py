"""The names that varied numbers of a law cannot have: files of the results have variables of these names."""

from __future__ import annotations

from burridge_knopoff.messages import refusal
from burridge_knopoff.model.parameters import CHAIN_PARAMETERS, parameter_key
from burridge_knopoff.study.study import Study


def check_parameter_names(study: Study, file: str) -> None:
    """Refuse a varied number of a law with the name of a variable or a dimension; such results are still opened.

    file : name of the config file, for messages. Raises ValueError, one line.
    """
    for name in study.parameters:
        of_law = name not in ("a", "v") and parameter_key(name) not in CHAIN_PARAMETERS
        if of_law and name in _names_in_files():
            raise refusal(f"{file}: grid", name, "another name: the results have a variable or a dimension of this one")


def _names_in_files() -> set[str]:
    """Return the names in the files in which the parameters of a study are coordinates."""
    from burridge_knopoff.dataset.point import POINT_VARIABLES
    from burridge_knopoff.summaries import lyapunov, mean_distance, runs

    variables = POINT_VARIABLES | runs.VARIABLES | mean_distance.VARIABLES | lyapunov.VARIABLES
    return {*variables, *(name for item in variables.values() for name in item.dimensions)} - {"a"}
