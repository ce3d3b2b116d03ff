"""Sections of a config, for many tests."""

AGREEMENT = {"relative_tolerance": 0.1, "standard_errors": 3.0}
MOTION = {
    "zero_exponent": 5e-4,
    "chaotic_exponent": 1e-3,
    "standard_errors": 3.0,
    "period_tolerance": 1e-6,
    "longest_period": 2000.0,
}
