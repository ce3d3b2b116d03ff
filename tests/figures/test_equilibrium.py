"""Uniform sliding: the largest eigenvalue, and the growth rates of the simulation."""

from burridge_knopoff import Model
from burridge_knopoff.figures.equilibrium import draw
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.equilibrium import summarize


def test_growth_rates_are_the_eigenvalues_and_the_simulated_rates():
    dataset = summarize([Model(law, a=0.1) for law in PAPER_LAWS], [0.0, 0.1, 0.2])
    (panel,), (other,) = (draw(dataset, has_paper_chain).axes for has_paper_chain in (True, False))
    half, *drawn = (line.get_ydata().tolist() for line in panel.get_lines())
    assert half == [0.0, 0.05, 0.1]
    assert [line.get_ydata().tolist() for line in other.get_lines()] == drawn
    assert drawn[3] == dataset["growth_rate"].sel(law="nonlinear").values.tolist()
    real = dataset["eigenvalue"].sel(part="real", law="nonlinear").max("mode")
    assert drawn[2] == real.values.tolist()
