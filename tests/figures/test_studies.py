"""Every figure of a study: of one law, of four laws, of a ring, of blocks that are not alike, and of one block."""

from importlib import import_module
from pathlib import Path

import pytest

from burridge_knopoff.dataset.point import to_dataset
from burridge_knopoff.figures.description import figure_descriptions
from burridge_knopoff.figures.style import MOST_ENTRIES, write_figure
from burridge_knopoff.running.simulation import run
from tests.small_study import ALL_STUDIES


@pytest.fixture(scope="module", params=ALL_STUDIES)
def small(request, small_studies):
    return small_studies(request.param)


def figures_of(small):
    """Yield name and figure, drawn as the workflow does."""
    study, summaries = small.study, small.summaries
    law, initial = study.config["figures"]["law"], study.initial[0]
    point = to_dataset(run(study.model(law, 0.2), study.state(initial), study.settings(law)))
    for figure in figure_descriptions():
        missing = not figure.of_points and not set(figure.inputs) <= set(summaries)
        if missing or (figure.condition and not getattr(study, figure.condition)):
            continue
        taken = [{initial: point}] if figure.of_points else [summaries[name] for name in figure.inputs]
        draw = import_module(f"burridge_knopoff.figures.{figure.name}").draw
        yield figure.name, draw(*taken, **{name: getattr(study, name) for name in figure.from_study})


def test_every_figure_is_drawn_and_names_all_laws(small, tmp_path: Path):
    drawn = dict(figures_of(small))
    missing = {figure.name for figure in figure_descriptions()} - set(drawn)
    # Longer chains and grids are no part of these; others need the chain of the paper, three blocks, several laws, or a
    # key of the config.
    of_grids = {figure.name for figure in figure_descriptions() if figure.inputs == ("grid",)}
    of_keys = {"catalogue", "slip_map", "edges"}
    of_ends = (
        {"detuning", "rotation", "mean_distance", "distance", "grid_distance"} if small.study.blocks == 1 else set()
    )
    assert missing <= {"chains", "phases", "orbits", "agreement", "two_blocks", *of_keys, *of_grids, *of_ends}
    for name, figure in drawn.items():
        write_figure(figure, tmp_path / f"{name}.png")
        assert (tmp_path / f"{name}.png").stat().st_size > 5_000, name
        for legend in [*figure.legends, *filter(None, (panel.get_legend() for panel in figure.axes))]:
            assert sum(bool(text.get_text().strip()) for text in legend.get_texts()) <= MOST_ENTRIES, name
        if name in ("mean_distance", "bifurcation_diagram", "lyapunov", "basin_fractions", "solvers"):
            titles = " ".join(panel.get_title(loc="left") for panel in figure.axes).replace("\n", " ")
            assert all(f"{law} law" in titles for law in small.study.laws), name
