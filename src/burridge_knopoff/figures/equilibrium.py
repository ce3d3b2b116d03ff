"""Uniform sliding: the eigenvalues of its perturbations, and how fast these grow."""

from __future__ import annotations

import xarray
from matplotlib.figure import Figure

from burridge_knopoff.figures.style import PAGE, color, label_panels, new_figure, styled

MARKERS = ("o", "x")


@styled
def draw(equilibrium: xarray.Dataset) -> Figure:
    """Draw the eigenvalues in the complex plane as a goes up, and the largest real part against a, for each law.

    Lines are eigenvalues of the Jacobian; markers on the right are growth rates of the simulated tangent flow.
    """
    figure, (plane, growth) = new_figure(PAGE, 3.0, columns=2, share_rows=False, share_columns=False)
    a = equilibrium["a"].values
    growth.plot(a, 0.5 * a, ":", color="black", linewidth=0.9, zorder=3, label="$a/2$")
    for n, law in enumerate(equilibrium["law"].values):
        one = equilibrium.sel(law=law)
        eigenvalue = one["eigenvalue"]
        real, imaginary = (eigenvalue.sel(part=part).values for part in ("real", "imaginary"))
        width = 2.2 - 1.2 * n
        for mode in range(real.shape[1]):
            plane.plot(real[:, mode], imaginary[:, mode], color=color(n), linewidth=width)
        plane.plot(real[-1], imaginary[-1], MARKERS[n], color=color(n), markersize=4, label=f"{law} law, $a={a[-1]:g}$")
        growth.plot(a, real.max(axis=1), color=color(n), linewidth=1.0, label=f"{law} law")
        some = slice(None, None, max(1, len(a) // 12))
        simulated = one["growth_rate"].values[some]
        growth.plot(a[some], simulated, MARKERS[n], color=color(n), markersize=3.5, label=f"{law} law, simulated")
    plane.axvline(0.0, color="0.7", linewidth=0.6, zorder=0)
    plane.set(xlabel=r"$\mathrm{Re}\,\lambda$", ylabel=r"$\mathrm{Im}\,\lambda$")
    growth.set(xlabel="$a$", ylabel=r"largest $\mathrm{Re}\,\lambda$")
    plane.legend(loc="center right")
    growth.legend(loc="upper left")
    label_panels((plane, growth), ["eigenvalues of uniform sliding", "growth of perturbations"])
    return figure
