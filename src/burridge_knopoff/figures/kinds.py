"""The colours of kinds of motion, the same in every figure."""

from __future__ import annotations

#: {number of a kind of motion: colour}
KIND_COLORS = {-1: "#FFFFFF", 0: "#0072B2", 1: "#56B4E9", 2: "#E69F00", 3: "#D55E00", 4: "#CC79A7", 5: "#009E73"}
