"""Numbers in docs/ for settings other than those of the default study, from its attractors.

    python benchmarks/other_settings.py results/paper

For docs/attractors.md the uncertainty exponents from ten times the pairs; for docs/synchronization.md which phases
synchronize by how much the inner block oscillates; for docs/bifurcations.md where the orbit with 9, 9 and 6 stops is
born. It takes some minutes.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import xarray
from measure import print_table

from burridge_knopoff.attractors.settings import SEARCH
from burridge_knopoff.attractors.stored_returns import KnownAttractors, known_attractors
from burridge_knopoff.basins.settings import BasinSettings, PhaseSettings
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.motion.limit_cycle import limit_cycle
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.bifurcations import locate_bifurcations
from burridge_knopoff.periodic_orbits.following import follow
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.study.study import Study
from burridge_knopoff.summaries import basins, phases

EXPONENTS_AT, PAIRS = (0.05, 0.08, 0.15), 16_000
PHASES_AT, AMPLITUDE = (0.005, 0.05, 0.08), 0.03
PHASES = PhaseSettings((AMPLITUDE, 0.07), (30.0, 180.0), (0.0, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0), samples=200, seed=5)
BIRTH_FROM, BIRTH_RANGE, STOPS = 0.17, (0.15, 0.172), (9, 9, 6)


def known_of(results: Path, attractors: xarray.Dataset, model: Model) -> KnownAttractors:
    """Return the attractors of a model with the section returns that the study has stored."""
    return known_attractors(attractors, xarray.load_dataset(results / f"returns/{model.law.name}.nc"), model)


def exponents(results: Path, study: Study, attractors: xarray.Dataset, a: float) -> list[str]:
    """Return the uncertainty exponent of the plane of the maps at one a under each law, and the dimension."""
    plane = BasinSettings(initial=study.state(study.config["basins"]["initial"]), pairs=PAIRS)
    start = study.config["start"]
    candidates = [known_of(results, attractors, study.model(law, a)) for law in study.laws]
    summaries = [basins.pairs(candidate, plane, SEARCH.label_limit, SEARCH.seed, start) for candidate in candidates]
    values = [
        (summary["uncertainty_exponent"].item(), summary["uncertainty_exponent_error"].item()) for summary in summaries
    ]
    alpha = "; ".join(f"{value:.3f} ± {error:.3f}" for value, error in values)
    return [f"{a:g}", alpha, "; ".join(f"{2.0 - value:.2f}" for value, _ in values)]


def born_at(study: Study, attractors: xarray.Dataset) -> float:
    """Return the a at which the orbit of these stops begins at a grazing that turns, stable or not (linearized law)."""
    model = study.model("linearized", BIRTH_FROM)
    periodic = attractors.sel(law="linearized", a=BIRTH_FROM)
    periodic = periodic.isel(attractor=(periodic["kind"] == MotionKind.PERIODIC).values)
    states = np.concatenate([periodic["position"].values - model.sliding_offset, periodic["velocity"].values], axis=1)
    orbits = [limit_cycle(model, state_of(state)) for state in states]
    orbit = next(orbit for orbit in orbits if orbit.stop_counts == STOPS)
    bifurcations = locate_bifurcations(follow(orbit, BIRTH_RANGE, upward=False, parameter="a"))
    return next(
        bifurcation.a
        for bifurcation in bifurcations
        if bifurcation.kind == BifurcationKind.GRAZING and bifurcation.is_turning_point
    )


def main() -> None:
    """Print both tables and the a."""
    results = Path(sys.argv[1])
    _, study = recorded_study(results)
    attractors = xarray.load_dataset(results / "summary/attractors.nc")
    laws = "; ".join(study.laws)
    print_table(
        ["a", f"α ({laws})", "dimension 2 − α"], [exponents(results, study, attractors, a) for a in EXPONENTS_AT]
    )
    model = study.model("linearized", PHASES_AT[0])
    candidates = [known_of(results, attractors, model.at(a=a)) for a in PHASES_AT]
    fraction = phases.one_law(candidates, PHASES, SEARCH.label_limit)["synchronized_fraction"]
    table = 100.0 * fraction.sel(amplitude=AMPLITUDE).transpose("inner_share", "phase_difference", "a").values
    header = ["share", *(f"{angle:g}°, a = {a:g}" for angle in PHASES.phase_difference for a in PHASES_AT)]
    rows = [
        [f"{share:g}", *(f"{value:g} %" for value in row.ravel())]
        for share, row in zip(PHASES.inner_share, table, strict=True)
    ]
    print_table(header, rows)
    print(f"stops {STOPS}, linearized: born at a = {born_at(study, attractors):.7f}, a grazing that turns")


if __name__ == "__main__":
    main()
