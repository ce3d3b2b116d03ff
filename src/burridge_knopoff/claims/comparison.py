"""The numbers that the paper prints, beside those of a study: the table of the report and of the README."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from burridge_knopoff.study.paper import PAPER_LAWS

#: {quantity: value} of the numbers behind a verdict.
Values = Mapping[str, float]


def _both_laws(quantity: str, digits: int, values: Values) -> str:
    linearized, nonlinear = (values[f"{quantity}, {law}"] for law in PAPER_LAWS)
    return f"{linearized:.{digits}f} (linearized law) and {nonlinear:.{digits}f} (nonlinear law)"


def _loss_of_synchrony(values: Values) -> str:
    laws = _both_laws("a_c, at which the synchronized orbit loses stability", 5, values)
    return f"{laws}, where the synchronized orbit loses stability"


def _settling(values: Values) -> str:
    return f"J < 1e-06 from {values['time τ from which on J < 1e-06']:.2f} on"


def _frequencies(values: Values) -> str:
    velocity = values["frequency of the velocity of block 1 over that of block 2"]
    stops = values["stops of block 1 over stops of block 2"]
    return f"{velocity:.3f} from the peaks of the spectra; {stops:.3f} from counting stops"


def _cycle(values: Values) -> str:
    """Return the range of the medians over a, over laws and initial states."""
    texts = []
    for words, short in (("of one block,", "for one block"), ("of any blocks,", "between stops of any blocks")):
        medians = [value for name, value in values.items() if f"successive stops {words}" in name]
        texts.append(f"{min(medians):.1f} to {max(medians):.1f} {short}")
    middle = next(value for name, value in values.items() if "of the middle block" in name)
    return f"{' and '.join(texts)} (medians over a); {middle:.1f} for the middle block from `plus` at a = 0.08"


def _chaos(values: Values) -> str:
    return (
        f"{_both_laws('smallest a with a chaotic attractor', 4, values)}; above, chaotic and regular windows alternate"
    )


#: What the paper gives a number for, its number, the claim that says it, and ours.
ROWS: tuple[tuple[str, str, str, Callable[[Values], str]], ...] = (
    ("Synchrony from `minus` ends at a =", "0.08", "upper_edge", _loss_of_synchrony),
    ("⟨J⟩ from `plus` at a = 0.08", "0.14", "plus_mean_distance", lambda values: f"{values['⟨J⟩, linearized']:.5f}"),
    ("J from `minus` at a = 0.08 vanishes by τ =", "4000", "minus_distance_vanishes", _settling),
    (
        "Frequency of the end blocks over that of the middle block, from `plus` at a = 0.08",
        "0.5",
        "half_frequency",
        _frequencies,
    ),
    ("Time of a stick-slip cycle", "2 to 3", "cycle_time", _cycle),
    ("Chaos first appears at a =", "0.1", "transition", _chaos),
)


def compare(claims: Iterable[Mapping[str, Any]]) -> list[tuple[str, str, str, str]]:
    """Return rows (quantity, the paper's number, ours, name of the claim), as many as the study has numbers for.

    claims : as in claims.json
    """
    measured = {
        claim["name"]: {item["quantity"]: item["value"] for item in claim["measured"] if item["value"] is not None}
        for claim in claims
    }
    rows = []
    for words, paper, name, ours in ROWS:
        try:
            rows.append((words, paper, ours(measured.get(name, {})), name))
        except (KeyError, ValueError, StopIteration):
            # A study of one law, or of few values of a, lacks some numbers.
            continue
    return rows
