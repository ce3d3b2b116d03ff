"""Every figure, drawn for studies of one law, of four laws, of a ring and of blocks that are not alike."""

from pathlib import Path

import pytest

from burridge_knopoff.dataset.point import to_dataset
from burridge_knopoff.figures import (
    agreement,
    basin_fractions,
    basins,
    bifurcation,
    distance,
    edges,
    equilibrium,
    friction_laws,
    lyapunov,
    mean_distance,
    motion,
    orbits,
    phases,
    solvers,
    stick_slip,
    two_blocks,
)
from burridge_knopoff.figures.style import write_figure
from burridge_knopoff.running.simulation import run
from tests.small_study import STUDIES


@pytest.fixture(scope="module", params=STUDIES)
def small(request, small_studies):
    return small_studies(request.param)


def figures_of(small):
    """Yield name and figure, drawn as the workflow does."""
    study, found = small.study, small.found
    law, initial = study.config["figures"]["law"], study.initial[0]
    grid = small.grid
    run_shown = run(study.model(law, 0.2), grid.initial[initial], grid.settings[law])
    point = to_dataset(run_shown)
    yield ("friction_laws", friction_laws.draw(found["mean_distance"], study.law_descriptions, 0.05))
    yield "mean_distance", mean_distance.draw(found["mean_distance"], found["attractors"])
    yield "bifurcation", bifurcation.draw(found["bifurcation"])
    yield "lyapunov", lyapunov.draw(found["lyapunov"])
    yield "agreement", agreement.draw(found["agreement"])
    yield "basin_fractions", basin_fractions.draw(found["attractors"])
    yield "basins", basins.draw(found["basins"], found["attractors"], study.marked_states)
    yield "edges", edges.draw(found["attractors"], found["edges"])
    if study.has_phases:
        yield "phases", phases.draw(found["phases"])
    yield "orbits", orbits.draw(found["orbits"], found["mean_distance"])
    yield "stick_slip", stick_slip.draw(found["stick_slip"], law)
    yield "equilibrium", equilibrium.draw(found["equilibrium"])
    yield "solvers", solvers.draw(found["solvers"])
    yield "two_blocks", two_blocks.draw(found["two_blocks"])
    yield "distance", distance.draw({initial: point})
    yield f"motion_{initial}", motion.draw({initial: point})


def test_every_figure_is_drawn_and_names_all_laws(small, tmp_path: Path):
    for name, figure in figures_of(small):
        write_figure(figure, tmp_path / f"{name}.png")
        assert (tmp_path / f"{name}.png").stat().st_size > 5_000, name
        if name in ("mean_distance", "bifurcation", "lyapunov", "basin_fractions", "solvers"):
            titles = " ".join(panel.get_title(loc="left") for panel in figure.axes).replace("\n", " ")
            assert all(f"{law} law" in titles for law in small.study.laws), name
