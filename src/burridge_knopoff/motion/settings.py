"""Thresholds that distinguish kinds of motion; fields and defaults are those of the config of a study."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any

from burridge_knopoff.model.fields import check_fields, fields_of, settings
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.ranges import HUGE, SHARE, TOLERANCE, Number
from burridge_knopoff.running.section import SUM, Section, SectionRange
from burridge_knopoff.running.settings import TIME, Settings

ERRORS = Number(0.0, 100.0)

#: Number of Lyapunov exponents that are computed for a motion, the largest ones.
EXPONENTS = 3


@settings
@dataclass(frozen=True)
class MotionSettings:
    """Thresholds that distinguish kinds of motion: `motion`, `synchronization_threshold` and `section` of the config.

    Raises ValueError, one line, for anything out of range.

    >>> from burridge_knopoff import MotionSettings
    >>> MotionSettings(chaotic_exponent=2e-3).longest_period
    2000.0
    """

    zero_exponent: Annotated[
        float,
        SHARE,
        "a Lyapunov exponent whose modulus is at most this counts as 0; for v < 0.1 it is multiplied by v/0.1",
    ] = 5e-4
    chaotic_exponent: Annotated[
        float,
        SHARE,
        "a motion is chaotic if its largest exponent is above this and not 0 within its errors; for v < 0.1 it is "
        "multiplied by v/0.1; for a suspected torus, which is followed for longer, it is divided by the square root of "
        "the ratio of the windows",
    ] = 1e-3
    standard_errors: Annotated[
        float, ERRORS, "an exponent within this many standard errors of 0 counts as 0 as well"
    ] = 3.0
    period_tolerance: Annotated[
        float,
        TOLERANCE,
        "section points W' and states that differ by at most this repeat; for v < 0.1 it is multiplied by v/0.1",
    ] = 1e-6
    longest_period: Annotated[
        float,
        TIME,
        "a motion is periodic if it repeats within this time; regular motion that is locked with a longer period, or "
        "does not repeat, is quasiperiodic; for v < 0.1 it is divided by v/0.1",
    ] = 2000.0
    synchronization_threshold: Annotated[
        float, TOLERANCE, "the end blocks count as synchronized if <J> is below this"
    ] = 1e-6
    section: Annotated[Section, SectionRange(), fields_of(Settings)["section"].description] = SUM

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def attributes(self) -> dict[str, Any]:
        """The settings, as attributes of a file."""
        return {name: getattr(self, name) for name in fields_of(type(self))} | {"section": str(self.section)}

    def scaled_to_velocity(self, v: float) -> MotionSettings:
        """Return the settings for a driver velocity v: below 0.1 motion is smaller and slower in proportion."""
        v = fields_of(Model)["v"].range.form(v, "v")
        share = min(1.0, v / 0.1)
        return replace(
            self.scaled_by(share),
            period_tolerance=share * self.period_tolerance,
            longest_period=self.longest_period / share,
        )

    def scaled_by(self, share: float) -> MotionSettings:
        """Return settings with the thresholds of exponents multiplied by a factor."""
        share = Number(0.0, HUGE).form(share, "share")
        return replace(self, zero_exponent=share * self.zero_exponent, chaotic_exponent=share * self.chaotic_exponent)


#: The defaults of a study.
MOTION = MotionSettings()
