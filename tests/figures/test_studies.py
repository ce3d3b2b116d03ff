"""Every figure, drawn for studies of one law, of four laws, of a ring and of blocks that are not alike."""

from importlib import import_module
from pathlib import Path

import pytest

from burridge_knopoff.dataset.point import to_dataset
from burridge_knopoff.figures.style import write_figure
from burridge_knopoff.running.simulation import run
from tests.small_study import STUDIES


@pytest.fixture(scope="module", params=STUDIES)
def small(request, small_studies):
    return small_studies(request.param)


def figures_of(small):
    """Yield name and figure, drawn as the workflow does."""
    study, found, grid = small.study, small.found, small.grid
    law, initial = study.config["figures"]["law"], study.initial[0]
    point = to_dataset(run(study.model(law, 0.2), grid.initial[initial], grid.settings[law]))
    taken = {
        "friction_laws": (found["mean_distance"], study.law_descriptions, 0.05),
        "mean_distance": (found["mean_distance"], found["attractors"]),
        "basin_fractions": (found["attractors"],),
        "basins": (found["basins"], found["attractors"], study.marked_states),
        "edges": (found["attractors"], found["edges"]),
        "orbits": (found["orbits"], found["mean_distance"]),
        "stick_slip": (found["stick_slip"], law),
        **dict.fromkeys(("distance", "motion"), ({initial: point},)),
    }
    alone = ["bifurcation", "lyapunov", "agreement", "equilibrium", "solvers", "two_blocks"]
    taken |= {name: (found[name],) for name in [*alone, *["phases"] * ("phases" in study.stages)]}
    for name, arguments in taken.items():
        yield name, import_module(f"burridge_knopoff.figures.{name}").draw(*arguments)


def test_every_figure_is_drawn_and_names_all_laws(small, tmp_path: Path):
    for name, figure in figures_of(small):
        write_figure(figure, tmp_path / f"{name}.png")
        assert (tmp_path / f"{name}.png").stat().st_size > 5_000, name
        if name in ("mean_distance", "bifurcation", "lyapunov", "basin_fractions", "solvers"):
            titles = " ".join(panel.get_title(loc="left") for panel in figure.axes).replace("\n", " ")
            assert all(f"{law} law" in titles for law in small.study.laws), name
