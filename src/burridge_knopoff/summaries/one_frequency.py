"""Whether end blocks have one frequency; apart from `detuning`, whose runs need the kernel."""

from __future__ import annotations

import numpy as np

# End blocks whose frequencies differ by no more have one frequency; on tori frequencies are known to a tenth of this.
FREQUENCY_TOLERANCE = 1e-6


def has_one_frequency(frequency: np.ndarray) -> np.ndarray:
    """Return whether the end blocks have one frequency, from the frequencies of the blocks, shape (…, blocks)."""
    return np.abs(frequency[..., -1] - frequency[..., 0]) <= FREQUENCY_TOLERANCE
