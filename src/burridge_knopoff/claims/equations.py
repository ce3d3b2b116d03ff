"""Eq. 1 of the paper, with units, compared in exact fractions with Eq. 2, in dimensionless form, for a chain."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from burridge_knopoff.model.chain import Chain


def equation_difference(chain: Chain, random: np.random.Generator) -> Fraction:
    """Return the largest |ΔU''| between Eq. 1 in dimensionless units and the equations of a chain of three blocks.

    The state of slipping blocks, the time and all units are random fractions.
    """

    def fractions(count: int) -> list[Fraction]:
        return [Fraction(*map(int, pair)) for pair in random.integers(1, 1000, (count, 2))]

    root_k, root_m, friction, c, speed, time = fractions(6)
    k, m, unit_of_time = root_k**2, root_m**2, root_m / root_k
    x, velocity = fractions(3), fractions(3)
    # Eq. 1, divided by m.
    forces = (
        k * (x[1] - 2 * x[0] + speed * time) - friction / (1 + c * velocity[0]),
        k * (x[0] - 4 * x[1] + x[2] + 2 * speed * time) - friction / (1 + c * velocity[1]),
        k * (x[1] - 2 * x[2] + speed * time) - friction / (1 + c * velocity[2]),
    )
    with_units = [force / m for force in forces]
    a, v = c * friction / (root_k * root_m), speed * root_k * root_m / friction
    u, slip = [k * value / friction for value in x], [k * value * unit_of_time / friction for value in velocity]
    tau = time / unit_of_time
    dimensionless = [
        Fraction(drive) * v * tau
        - sum((Fraction(spring) * value for spring, value in zip(row, u, strict=True)), Fraction())
        - Fraction(threshold) / (1 + a * rate)
        for drive, row, threshold, rate in zip(
            chain.driving.tolist(), chain.stiffness.tolist(), chain.thresholds.tolist(), slip, strict=True
        )
    ]
    return max(
        abs(k * unit_of_time**2 * value / friction - other)
        for value, other in zip(with_units, dimensionless, strict=True)
    )
