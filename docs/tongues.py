"""Follow the ends of locking in the detuning of one end block, for docs/tongues.md: `python docs/tongues.py`.

It prints what the page shows, and writes docs/figures/tongues.png. It takes six minutes on one core. The law is the
linearized one, under which v only sets the scale. The detuning d is `mass[3]` − 1.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from burridge_knopoff import (
    Bifurcation,
    BifurcationCurve,
    ChainState,
    ContinuationSettings,
    Model,
    PeriodicOrbit,
    block_frequencies,
    find_attractors,
    follow,
    follow_bifurcation,
    limit_cycle,
    locate_bifurcations,
    mode_amplitudes,
    multipliers,
    simulate,
    synchronized_orbit,
)
from burridge_knopoff.figures.palette import KINDS, SYNCHRONIZED, ramp
from burridge_knopoff.figures.strips import cells
from burridge_knopoff.figures.style import PAGE, label_panels, new_figure, styled
from burridge_knopoff.motion.rotation import rotation_number

PICTURE = Path(__file__).parent / "figures" / "tongues.png"

#: Classes of motion; chaos is not distinguished from a torus.
TWO, FREE, TORUS, PERIODIC = range(4)
SHADES = {
    "two frequencies": "#E4E4E4",
    "one, relative phase free": "#9A9A9A",
    "one, torus": KINDS[2],
    "one, periodic": KINDS[1],
}
VALUES, DETUNINGS = np.arange(0.005, 0.1001, 0.005), np.arange(0.0, 0.9001, 0.025)

STEPS = ContinuationSettings(first_step=1e-3, largest_step=2e-2, smallest_step=1e-5, max_orbits=200)
# Curves end in corners, around which only short steps lead.
FINE = ContinuationSettings(first_step=1e-3, largest_step=5e-2, smallest_step=1e-7, max_orbits=200)
# Rotation numbers of the tongues, with an a in each and the revolutions of the middle block in a period.
RATIOS = {"35/54": (0.0805, 54), "9/14": (0.155, 14), "7/11": (0.217, 11)}
LINES = {"grazing": "-", "fold": "--", "Neimark–Sacker": ":"}

#: A bifurcation at which locking ends, its curve, and the smallest a at which the curve is a boundary.
Boundary = tuple[Bifurcation, BifurcationCurve, float]


def model_of(a: float, d: float = 0.0) -> Model:
    """Return three blocks with a detuned last block."""
    return Model("linearized", a=a).at(**{"mass[3]": 1.0 + d})


def motion(model: Model, state: ChainState) -> tuple[int, float, ChainState]:
    """Return the class of the motion that a state reaches, the largest share of a mode, and its last state."""
    run = simulate(model, initial=state, transient=3000, window=6000, trajectory=0)
    frequency, _ = block_frequencies(model, run.final, 2000.0)
    second, third = (run.lyapunov_exponent + 3.0 * run.lyapunov_error)[1:]
    share = mode_amplitudes(model, run.final, 2000.0).line_shares(frequency[0]).max()
    if abs(frequency[2] - frequency[0]) > 1e-5:
        return TWO, share, run.final
    return (FREE if third >= 0.0 else TORUS if second >= 0.0 else PERIODIC), share, run.final


def branch_one() -> tuple[np.ndarray, np.ndarray]:
    """Return the classes of branch 1 and the largest shares of a mode, each of shape (detunings, values of a)."""
    # `plus` reaches branch 1 at a = 0.03; from there the branch is followed in a.
    first = simulate(Model("linearized", a=0.03), "plus", transient=0, window=6000, trajectory=0).final
    states = {}
    for side in (VALUES[VALUES >= 0.03], VALUES[VALUES < 0.03][::-1]):
        state = first
        for a in side:
            *_, state = motion(model_of(a), state)
            states[a] = state
    classes, shares = np.zeros((2, len(DETUNINGS), len(VALUES)))
    for column, a in enumerate(VALUES):
        state = states[a]
        for row, d in enumerate(DETUNINGS):
            classes[row, column], shares[row, column], state = motion(model_of(a, d), state)
    return classes, shares


def print_branch_one(classes: np.ndarray, shares: np.ndarray) -> None:
    """Print up to which detuning the end blocks have a stable relative phase and one frequency, and the least share."""
    print("   a  phase stable  one frequency  share of one mode")
    for column in range(1, len(VALUES), 3):
        attracts, same = classes[:, column] >= TORUS, classes[:, column] != TWO
        until = DETUNINGS[np.argmin(attracts) - 1] if not attracts.all() else DETUNINGS[-1]
        last, share = DETUNINGS[same.nonzero()[0][-1]], shares[same, column].min()
        print(f"{VALUES[column]:.3f} {until:11.3f} {last:14.3f} {share:15.3f}")


def loss(
    orbit: PeriodicOrbit,
    parameter: str,
    interval: tuple[float, float],
    upward: bool,
    settings: ContinuationSettings = STEPS,
) -> Bifurcation:
    """Return the bifurcation along a parameter at which an orbit loses stability or its branch has a turning point."""
    branch = follow(
        orbit,
        interval,
        settings,
        parameter=parameter,
        upward=upward,
        is_complete=lambda points: points[-1].multipliers.unstable_count > 0,
    )
    return next(item for item in locate_bifurcations(branch) if item.loses_stability or item.is_turning_point)


def describe(name: str, curve: BifurcationCurve) -> BifurcationCurve:
    """Print the kind, the ends and the errors of a curve, and return it."""
    (first, a), (last, b) = curve.values[0], curve.values[-1]
    ends = f"from ({first:.4f}, {a:.4f}) to ({last:.4f}, {b:.4f})"
    print(f"{name}, {curve.kind.words}: {ends}, errors at most {curve.errors.max():.0e}")
    return curve


def ends_of_synchrony() -> Iterator[Boundary]:
    """Yield the boundaries of the tongue of synchrony in (mass[3], a)."""
    for a, lowest in ((0.02, 0.005), (0.032, 0.029), (0.06, 0.03)):
        for upward in (True, False):
            end = loss(synchronized_orbit(model_of(a)), "mass[3]", (0.5, 1.5), upward)
            curve = follow_bifurcation(end, ("mass[3]", "a"), (lowest, 0.13), STEPS)
            yield end, describe(f"synchrony, from a = {a}", curve), lowest


def inner_grazings() -> Iterator[BifurcationCurve]:
    """Yield the grazings that are no boundary, at small a: beyond them the lighter end block never stops."""
    for upward in (True, False):
        branch = follow(
            synchronized_orbit(model_of(0.02)),
            (0.5, 1.5),
            STEPS,
            parameter="mass[3]",
            upward=upward,
            is_complete=lambda points: 0 in points[-1].orbit.stop_counts[::2],
        )
        (grazing,) = locate_bifurcations(branch)
        curve = follow_bifurcation(grazing, ("mass[3]", "a"), (0.004, 0.034), STEPS)
        yield describe("the lighter end block stops no more", curve)


def end_of_wrong_leader() -> BifurcationCurve:
    """Return the fold at which the orbit ends on which, above a_c, the wrong end block leads."""
    orbit = synchronized_orbit(model_of(0.1))
    pushed = orbit.reference.position + np.array([1e-3, 0.0, -1e-3])
    state = ChainState(pushed, orbit.reference.velocity, orbit.reference.stuck)
    leading = limit_cycle(orbit.model, state, settling=6000.0)
    ends = (loss(leading, "mass[3]", (0.99, 1.01), upward, ContinuationSettings()) for upward in (True, False))
    fold = next(end for end in ends if end.is_turning_point)
    return describe("one end leads", follow_bifurcation(fold, ("mass[3]", "a"), (0.08, 0.13), STEPS))


def is_boundary(orbit: PeriodicOrbit) -> bool:
    """Return whether an orbit at a bifurcation would be stable without it."""
    return bool((np.abs(multipliers(orbit).whole) <= 1.0 + 1e-6).all())


def interval_range(model: Model, start: ChainState, transient: float) -> float:
    """Return the range of the times between stops after a transient, the smaller one of both end blocks."""
    run = simulate(model, initial=start, transient=transient, window=1000, event_window=1000, lyapunov_exponents=0)
    stops = [run.event_time[(run.event_block == block) & (run.event_kind == 0)] for block in (1, 3)]
    return float(min(np.ptp(np.diff(times)) for times in stops if len(times) > 2))


def is_periodic(model: Model, orbit: PeriodicOrbit) -> bool:
    """Return whether a run from near an orbit settles on one on which an end block stops once in each period."""
    start = ChainState(orbit.reference.position + 1e-4, orbit.reference.velocity, orbit.reference.stuck)
    late = interval_range(model, start, 30000)
    # Near a Neimark–Sacker bifurcation perturbations decay slowly.
    return late < 1e-5 or late < 0.5 * interval_range(model, start, 3000)


def check_synchrony(boundaries: list[Boundary]) -> None:
    """Print how many runs on both sides of the boundaries, 0.001 away in d, are periodic inside and not outside."""
    right = tried = 0
    for end, curve, lowest in boundaries:
        outward = np.sign(end.value - 1.0)
        for (mass, a), orbit in list(zip(curve.values, curve.orbits, strict=True))[1:-1:2]:
            if lowest < a < 0.1 and is_boundary(orbit):
                for side in (-outward, outward):
                    found = is_periodic(orbit.model.at(**{"mass[3]": float(mass) + 1e-3 * side}), orbit)
                    right, tried = right + (found == (side != outward)), tried + 1
    print(f"{right} of {tried} runs: periodic inside, not outside")


def rotation_tongues() -> dict[str, list[BifurcationCurve]]:
    """Return the lower and the upper boundaries of tongues of branch 1 in (a, coupling), by rotation number."""
    tongues: dict[str, list[BifurcationCurve]] = {}
    for name, (a, revolutions) in RATIOS.items():
        attractors, _ = find_attractors(model_of(a), starts=["plus"], samples=40, transient=2000, window=2000)
        states = [item.motion.state() for item in attractors if item.motion.kind.name == "PERIODIC"]
        orbits = [limit_cycle(model_of(a), state, settling=2000.0) for state in states]
        orbit = next(orbit for orbit in orbits if orbit.stop_counts[1] == revolutions)
        for upward in (True, False):
            end = loss(orbit, "a", (a - 0.03, a + 0.03), upward, ContinuationSettings())
            curve = follow_bifurcation(end, ("a", "coupling"), (0.9, 1.2), FINE)
            tongues.setdefault(name, []).append(describe(name, curve))
    return tongues


def check_rotation(tongues: dict[str, list[BifurcationCurve]]) -> None:
    """Print at how many points of the boundaries runs on one side, and only there, have the given rotation number."""
    right = tried = 0
    for name, curves in tongues.items():
        top, bottom = map(int, name.split("/"))
        size = 3e-5 if name == "35/54" else 2e-4
        for curve in curves:
            for (a, _), orbit in list(zip(curve.values, curve.orbits, strict=True))[::3]:
                if is_boundary(orbit):
                    locked = []
                    for side in (-1, 1):
                        model = orbit.model.at(a=float(a) + side * size)
                        start = orbit.reference
                        run = simulate(model, initial=start, transient=6000, window=100, lyapunov_exponents=0)
                        number, _ = rotation_number(model, run.final, 6000.0)
                        locked.append(abs(number - top / bottom) < 1e-6)
                    right, tried = right + (locked[0] != locked[1]), tried + 1
    print(f"{right} of {tried} points: locked on one side only")


def boundary_points(curve: BifurcationCurve, lowest: float = 0.0) -> np.ndarray:
    """Return the points of a curve, shape (n, 2), with NaN where no stable orbit ends."""
    bounds = [[is_boundary(orbit) and orbit.a > lowest] for orbit in curve.orbits]
    return np.where(bounds, curve.values, np.nan)


def edge(boundaries: list[Boundary], a: np.ndarray) -> np.ndarray:
    """Return the detuning on boundaries at values of a."""
    points = np.concatenate([boundary_points(curve, lowest) for _, curve, lowest in boundaries])
    points = points[np.isfinite(points[:, 1])]
    points = points[points[:, 1].argsort()]
    return np.interp(a, points[:, 1], points[:, 0] - 1.0)


@styled
def draw(
    classes: np.ndarray,
    synchrony: list[Boundary],
    inner: list[BifurcationCurve],
    fold: BifurcationCurve,
    tongues: dict[str, list[BifurcationCurve]],
) -> Figure:
    """Draw the classes of branch 1, the tongue of synchrony, and those of the rotation number."""
    figure, panels = new_figure(PAGE, 3.4, columns=3, share_rows=False, share_columns=False)
    unsynchronized, synchronous, ratio = panels
    below = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.2), "fontsize": 7}
    shades = ListedColormap(list(SHADES.values()))
    unsynchronized.pcolormesh(
        cells(VALUES), cells(DETUNINGS), classes, cmap=shades, vmin=-0.5, vmax=3.5, rasterized=True
    )
    patches = [Patch(facecolor=tone, edgecolor="0.5", label=name) for name, tone in SHADES.items()]
    unsynchronized.legend(handles=patches, handlelength=1.0, ncols=2, columnspacing=1.0, **below)
    unsynchronized.set(xlabel="$a$", ylabel="detuning $d$")
    upper, lower = ([item for item in synchrony if (item[0].value > 1.0) == above] for above in (True, False))
    # Below a = 0.029 the lower boundary lies at much smaller d.
    a = np.linspace(0.029, 0.1105, 100)
    synchronous.fill_between(a, edge(lower[1:], a), edge(upper, a), color=SYNCHRONIZED, alpha=0.3, linewidth=0)
    a = np.linspace(0.005, 0.029, 50)
    grazings = [np.interp(a, *curve.values[curve.values[:, 1].argsort()].T[::-1]) - 1.0 for curve in inner]
    synchronous.fill_between(a, *grazings, color=SYNCHRONIZED, alpha=0.3, linewidth=0)
    for grazing, outer in zip(grazings, (upper, lower), strict=True):
        hatched = {"facecolor": "none", "edgecolor": SYNCHRONIZED, "hatch": "////", "linewidth": 0}
        synchronous.fill_between(a, grazing, edge(outer[:1], a), **hatched)
        synchronous.plot(a, grazing, color="0.5", linewidth=0.6)
    for curve, lowest in (*((curve, lowest) for _, curve, lowest in (*upper, *lower)), (fold, 0.0)):
        mass, a = boundary_points(curve, lowest).T
        synchronous.plot(a, mass - 1.0, LINES[curve.kind.words], color="black")
    kinds = [Line2D([], [], color="black", linestyle=style, label=kind) for kind, style in LINES.items()]
    synchronous.legend(handles=kinds, ncols=2, columnspacing=1.0, **below)
    synchronous.set(xlabel="$a$", ylabel="detuning $d$", xlim=(0.0, 0.13), ylim=(-0.05, 0.09))
    for (name, curves), color in zip(tongues.items(), ramp(3), strict=True):
        for curve in curves:
            ratio.plot(*boundary_points(curve).T, LINES[curve.kind.words], color=color)
        ratio.plot([], [], color=color, label=name)
    styles = [
        line
        for line in kinds
        if line.get_label() in {curve.kind.words for curves in tongues.values() for curve in curves}
    ]
    ratio.legend(handles=[*ratio.get_legend_handles_labels()[0], *styles], ncols=2, columnspacing=1.0, **below)
    ratio.set(xlabel="$a$", ylabel="coupling")
    label_panels(panels, ["one frequency, branch 1", "one stop per period", "tongues of branch 1"])
    return figure


def main() -> None:
    """Print what the page shows, and draw the picture."""
    classes, shares = branch_one()
    print_branch_one(classes, shares)
    print("mass[3], a")
    synchrony, inner, fold = list(ends_of_synchrony()), list(inner_grazings()), end_of_wrong_leader()
    check_synchrony(synchrony)
    print("a, coupling")
    tongues = rotation_tongues()
    check_rotation(tongues)
    draw(classes, synchrony, inner, fold, tongues).savefig(PICTURE, dpi=200)


if __name__ == "__main__":
    main()
