"""Standard errors of the statistics of a catalogue, by batch means.

Slip events come in bursts, so that a Poisson error of their number is too small, and so is the error of a mean over
events that counts them as independent. The catalogue is therefore divided into batches of equal time. The scatter of
their sums gives the error, which allows for all correlations within a batch.

Correlation between neighbouring batches enters in two ways. As long as it is larger than chance explains, of either
sign, neighbouring batches are joined, down to FEWEST_BATCHES. A positive correlation that is left adds to the
variance; a negative one, as of large events that recur, is left out, so that the error is rather too large. If
correlations last for a twentieth of the catalogue, the error is about a tenth too small; if they last longer, the
catalogue is too short for a reliable error.

Reference: G. S. Fishman, "Grouping observations in digital simulation", Management Science 24 (1978) 510-521.
"""

from __future__ import annotations

import math

import numpy as np

#: Number of batches at first, and the smallest number to which they are joined; powers of 2.
BATCHES, FEWEST_BATCHES = 32, 8

# A mean has an error if its weight is spread over this many batches.
_FEWEST_WEIGHTED = 4.0


def batch_index(time: np.ndarray, begin: float, end: float) -> np.ndarray:
    """Return the batch (0 …) of each event: of BATCHES equal parts of the time from `begin` to `end`."""
    length = (end - begin) / BATCHES
    if not length > 0.0:
        return np.zeros(len(time), dtype=int)
    return np.clip((time - begin) / length, 0.0, BATCHES - 1.0).astype(int)


def batch_sums(
    batch: np.ndarray, value: np.ndarray | None = None, row: np.ndarray | None = None, rows: int = 1
) -> np.ndarray:
    """Return the sums of a value of events over each batch and row, shape (rows, BATCHES).

    batch, value, row : of the events, shape (events,); without values the events are counted
    """
    index = batch if row is None else row * BATCHES + batch
    return np.bincount(index, value, rows * BATCHES).reshape(rows, BATCHES).astype(float)


def ratio_error(total: np.ndarray, weight: np.ndarray) -> np.ndarray:
    """Return the standard error of Σ total / Σ weight over consecutive batches, shape (…).

    total, weight : sums over each batch, shape (…, batches). For a rate the weight is the length of a batch, for a mean
        over events their number, or the sum of their weights

    The result is NaN if nearly all weight lies in a few batches.
    """
    total, weight = np.broadcast_arrays(np.asarray(total, dtype=float), np.asarray(weight, dtype=float))
    error = np.full(total.shape[:-1], np.nan)
    joining = np.ones(error.shape, dtype=bool)
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = total.sum(axis=-1, keepdims=True) / weight.sum(axis=-1, keepdims=True)
        while True:
            residual, count = total - ratio * weight, total.shape[-1]
            square = np.sum(residual**2, axis=-1)
            correlation = np.sum(residual[..., 1:] * residual[..., :-1], axis=-1) / square
            whole, squares = weight.sum(axis=-1) ** 2, np.sum(weight**2, axis=-1)
            # Without correlation between batches this is unbiased for any weights.
            variance = square / (whole - squares) * (1.0 + 2.0 * np.fmax(correlation, 0.0))
            is_last = count <= FEWEST_BATCHES
            joined = joining & (is_last | ~(np.abs(correlation) > 2.0 / math.sqrt(count)))
            error[joined] = np.where(whole < _FEWEST_WEIGHTED * squares, np.nan, np.sqrt(variance))[joined]
            joining &= ~joined
            if is_last or not joining.any():
                return error
            total, weight = (part.reshape(*error.shape, -1, 2).sum(axis=-1) for part in (total, weight))


def rate_error(count: np.ndarray, duration: float) -> np.ndarray:
    """Return the standard error of the rate of events, shape (…).

    count : number of events in each of consecutive equal batches, shape (…, batches); duration : of all batches

    The error is at least that of a single event, also if there is none.
    """
    return np.maximum(ratio_error(count, np.full(count.shape[-1], duration / count.shape[-1])), 1.0 / duration)
