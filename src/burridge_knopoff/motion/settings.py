"""How kinds of motion are distinguished; fields and defaults are those of a study's config."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any

from burridge_knopoff.model.fields import check_fields, fields_of, settings
from burridge_knopoff.model.ranges import SHARE, TOLERANCE, Number
from burridge_knopoff.running.section import SUM, Section, SectionRange
from burridge_knopoff.running.settings import TIME, Settings

ERRORS = Number(0.0, 100.0)

#: Lyapunov exponents that are computed of a motion, the largest ones.
EXPONENTS = 3


@settings
@dataclass(frozen=True)
class MotionSettings:
    """How kinds of motion are told: the config's keys of `motion`, its synchronization_threshold and its `section`.

    Raises ValueError, one line, for anything out of range.

    >>> from burridge_knopoff import MotionSettings
    >>> MotionSettings(chaotic_exponent=2e-3).longest_period
    2000.0
    """

    zero_exponent: Annotated[
        float, SHARE, "a Lyapunov exponent of this modulus at most counts as 0; below v = 0.1 it scales with v"
    ] = 5e-4
    chaotic_exponent: Annotated[
        float,
        SHARE,
        "a motion is chaotic if its largest exponent is above this and not 0 within its errors; below v = 0.1 it "
        "scales with v; in the longer window of what may be a torus it is smaller by the root of the ratio",
    ] = 1e-3
    standard_errors: Annotated[
        float, ERRORS, "an exponent of this many standard errors at most counts as 0 as well"
    ] = 3.0
    period_tolerance: Annotated[
        float,
        TOLERANCE,
        "section points W' and states that differ by this at most repeat; below v = 0.1 it scales with v",
    ] = 1e-6
    longest_period: Annotated[
        float,
        TIME,
        "a motion is periodic if it repeats after this time at most; regular motion that is locked with a longer "
        "period, or does not repeat, is quasiperiodic; below v = 0.1 it grows as 1/v",
    ] = 2000.0
    synchronization_threshold: Annotated[float, TOLERANCE, "the end blocks move as one where <J> is below this"] = 1e-6
    section: Annotated[Section, SectionRange(), fields_of(Settings)["section"].description] = SUM

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def attributes(self) -> dict[str, Any]:
        """The settings as attributes of a file."""
        return {name: getattr(self, name) for name in fields_of(type(self))} | {"section": str(self.section)}

    def scaled_to_velocity(self, v: float) -> MotionSettings:
        """Return the settings that a driver of speed v asks for: slower motion is smaller, and takes longer."""
        share = min(1.0, v / 0.1)
        return replace(
            self.scaled_by(share),
            period_tolerance=share * self.period_tolerance,
            longest_period=self.longest_period / share,
        )

    def scaled_by(self, share: float) -> MotionSettings:
        """Return settings whose thresholds of exponents are that share of these."""
        return replace(self, zero_exponent=share * self.zero_exponent, chaotic_exponent=share * self.chaotic_exponent)


#: The defaults of a study.
MOTION = MotionSettings()
