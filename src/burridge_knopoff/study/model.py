"""The models of a study, from its config's `laws`, `chain`, `v` and `contact`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import Model, at_recorded_a
from burridge_knopoff.motion.settings import MotionSettings

#: Keys of a config that belong to the criteria of motions, besides `motion`.
_BESIDE_MOTION = ("synchronization_threshold", "section")
#: Keys of a config that define a model, except the number of blocks.
MODEL_KEYS = ("laws", "chain", "v", "contact")


def motion_of(config: Mapping[str, Any]) -> MotionSettings:
    """Return the criteria of a config by which kinds of motion are distinguished."""
    return MotionSettings(**config["motion"], **{key: config[key] for key in _BESIDE_MOTION if key in config})


def models_of(config: Mapping[str, Any], a: float, blocks: int | None = None) -> list[Model]:
    """Return a model for each law of a study, at one a; blocks and errors as in `model_of`."""
    return [model_of(config, law, a, blocks) for law in config["laws"]]


def model_of(
    config: Mapping[str, Any], law: str, a: float, blocks: int | None = None, others: Mapping[str, float] | None = None
) -> Model:
    """Return the model of a study under one of its laws, at one a.

    blocks : number of blocks, by default the config's; others : values of the study's other parameters
    Raises ValueError if a value is out of range.
    """
    chain = Chain(**{**config["chain"], **({} if blocks is None else {"blocks": blocks})})
    model = Model({law: config["laws"][law]}, chain=chain, v=config["v"], contact=config["contact"])
    # A parameter with one value is of the laws that have it; the config was checked when it was read.
    own = {name: value for name, value in (others or {}).items() if model.has_parameter(name)}
    return at_recorded_a(model, a).at(**own)
