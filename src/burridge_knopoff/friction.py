"""The two friction laws Φ(aU') of the paper."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

LAWS = ("linearized", "nonlinear")


@dataclass(frozen=True)
class Friction:
    """Friction on a slipping block, in units of the static friction.

    linearized: Φ = 1 − aU'; nonlinear: Φ = 1/(1 + aU') (the paper's Section II). `a` says how fast friction falls with
    the slip speed. Below a = 2 every normal mode of slipping blocks oscillates, which the mapping relies on.

    Raises ValueError if the law is unknown or a is not in [0, 2).
    """

    law: str
    a: float

    def __post_init__(self) -> None:
        if self.law not in LAWS:
            raise ValueError(f"law: {self.law!r} is not allowed: {' | '.join(LAWS)}")
        if isinstance(self.a, bool) or not isinstance(self.a, int | float | np.floating) or not 0.0 <= self.a < 2.0:
            raise ValueError(f"a: {self.a!r} is not allowed: 0 ≤ a < 2")
        # Adding 0 turns -0.0 into 0.0: the same number must not make two different files.
        object.__setattr__(self, "a", float(self.a) + 0.0)

    def __call__(self, speed: ArrayLike) -> np.ndarray:
        """Return Φ(a·speed), elementwise."""
        speed = np.asarray(speed, dtype=float)
        if self.law == "nonlinear":
            return 1.0 / (1.0 + self.a * speed)
        return 1.0 - self.a * speed
