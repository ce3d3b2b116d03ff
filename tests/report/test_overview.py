"""What a page says of settings: whether longer chains were made with those that the study has now."""

import pytest

from burridge_knopoff.motion.chain_synchronization import Sample, Watch
from burridge_knopoff.report.overview import foreign_settings
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.model import model_of
from burridge_knopoff.summaries.chains import chain_dataset, merge

CONFIG = {
    "study": "x",
    "a": [0.1],
    "initial": {"minus": {}},
    "chains": {"blocks": [2], "a": [0.1], "samples": 2, "symmetric_samples": 1, "time_limit": 200},
}
OWN = {"formula": "1 - c*tanh(a*u/c)", "c": 0.2}


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({}, []),
        ({"v": 0.2}, ["v = 0.1, here 0.2"]),
        ({"chain": {"coupling": 9.0}}, ["coupling = 1.0, here 9.0"]),
        ({"chain": {"pulling": 1.0}}, ["pulling = neighbours, here 1.0"]),
        (
            {"laws": {"linearized": OWN}},
            [f"friction = linearized: Φ = 1 − aU′, here linearized: Φ = {OWN['formula']}, u"],
        ),
        ({"chains": {**CONFIG["chains"], "velocity": [0.0, 0.3]}}, ["velocity = [0.0, 0.2], here [0.0, 0.3]"]),
        ({"chains": {**CONFIG["chains"], "time_limit": 300}}, ["time_limit = 200.0, here 300.0"]),
    ],
)
def test_longer_chains_of_other_settings_are_told(change, expected):
    made = load_study(CONFIG, "x.yaml")
    model = {key: made.config[key] for key in ("laws", "chain", "v", "contact")}
    chains = made.config["chains"]
    sample = Sample(
        start=made.config["start"],
        **{key: chains[key] for key in ("samples", "symmetric_samples", "seed", "position", "velocity")},
    )
    watch = Watch(chains["time_limit"], chains["synchronization_distance"])
    dataset = merge([chain_dataset([model_of(model, "linearized", 0.1, 2)], [0.1], sample, watch)])
    told = foreign_settings(dataset, load_study({**CONFIG, **change}, "x.yaml"))
    assert len(told) == len(expected)
    assert all(line.startswith(start) for line, start in zip(told, expected, strict=True))
