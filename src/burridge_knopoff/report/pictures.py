"""The figures of a study as pictures inside the page, each once and pixel by pixel, and what each of them shows."""

from __future__ import annotations

import base64
import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from PIL import Image

from burridge_knopoff.provenance.seal import BadFile

THUMBNAIL_WIDTH = 400

#: Title and alternative text of each figure.
TEXTS = {
    "mean_distance": (
        "⟨J⟩ against a",
        "Mean distance ⟨J⟩ between the outer blocks against a, a panel for each law: runs from each initial state in "
        "black over the attractors in the colours of their branches; below, strips with the branch that each initial "
        "state reaches under each convention of contact and start.",
    ),
    "bifurcation": (
        "Bifurcation diagrams",
        "Section points W' at W = 0 against a, a panel for each law and initial state; upward crossings above 0, "
        "downward crossings below.",
    ),
    "lyapunov": (
        "Lyapunov exponents",
        "The largest Lyapunov exponents against a with three standard errors, a panel for each law and initial state; "
        "a strip above each panel gives the kind of motion.",
    ),
    "orbits": (
        "The synchronized orbit",
        "Floquet multipliers of the synchronized orbit against a; ⟨J⟩ of stable and unstable orbits around a_c; the "
        "asymmetry of the orbits that branch off against the distance from a_c; differences between the laws.",
    ),
    "basin_fractions": (
        "Basin fractions and sweeps",
        "Fraction of the sampled initial states that reach each branch of attractors against a, and ⟨J⟩ along sweeps "
        "of a upward and downward, for each law.",
    ),
    "basins": (
        "Basins of attraction",
        "Maps over the initial positions U_1(0) and U_N(0) of the outer blocks, each pixel in the colour of the "
        "attractor that is reached; the initial states of the study are marked.",
    ),
    "agreement": (
        "Agreement of the laws",
        "For each law compared with the first one and each initial state, against a: the difference of ⟨J⟩ with both "
        "tolerances, the Wasserstein distance of the section points, and the time until which events come in the same "
        "order; shaded where the laws disagree.",
    ),
    "chains": (
        "Longer chains",
        "Fraction of the sampled initial states that synchronize all mirror pairs against a, a panel for each number "
        "of blocks, and ⟨J⟩ of two blocks under each law.",
    ),
    "friction_laws": (
        "Friction laws",
        "The friction Φ of each law against the slip speed U', and the least friction that slipping blocks felt in "
        "each run against a.",
    ),
    "two_blocks": (
        "Two blocks",
        "⟨J⟩ of two blocks against a from each initial state under each law; shaded where one disagrees with the first "
        "one.",
    ),
    "stick_slip": (
        "Stick-slip cycles",
        "Cycle times, frequency ratios, the correlation of the end blocks and stick fractions against a, a column for "
        "each initial state.",
    ),
    "equilibrium": (
        "Uniform sliding",
        "Eigenvalues of the perturbations of uniform sliding in the complex plane, and the largest real part against "
        "a, for each law.",
    ),
    "solvers": (
        "Independent solvers",
        "⟨J⟩ of every solver, its distance from that of the study's solver, and the steps per unit time against a, a "
        "column for each law.",
    ),
    "distance": ("J against time", "The distance J between the outer blocks against time τ, for each initial state."),
}


@dataclass(frozen=True)
class Picture:
    """A figure in the page: `data` and `thumbnail` are data URIs, sizes are in pixels."""

    name: str
    title: str
    alternative: str
    data: str
    width: int
    height: int
    thumbnail: str
    thumbnail_width: int
    thumbnail_height: int


def read_picture(path: str | Path) -> Picture:
    """Read a figure; its pixels are kept, in a format that takes a third of the room of PNG.

    Raises BadFile if it is not a picture.
    """
    name = Path(path).stem
    try:
        with Image.open(path) as opened:
            shown = opened.convert("RGB")
    except (OSError, SyntaxError) as error:
        raise BadFile(path, f"is not a readable picture ({error})") from None
    small = shown.copy()
    small.thumbnail((THUMBNAIL_WIDTH, shown.height), Image.Resampling.LANCZOS)
    title, alternative = _texts(name)
    return Picture(
        name, title, alternative, _uri(shown, lossless=True), *shown.size, _uri(small, quality=80), *small.size
    )


def _texts(name: str) -> tuple[str, str]:
    if name in TEXTS:
        return TEXTS[name]
    if name.startswith("motion_"):
        state = name.removeprefix("motion_")
        return (
            f"Motion from {state}",
            f"Velocities and positions of all blocks against time τ at the end of the run from the state {state}.",
        )
    words = name.replace("_", " ")
    return words.capitalize(), f"Figure of the study: {words}."


def _uri(picture: Image.Image, **options: Any) -> str:
    content = io.BytesIO()
    picture.save(content, "WEBP", **options)
    return "data:image/webp;base64," + base64.b64encode(content.getvalue()).decode()
