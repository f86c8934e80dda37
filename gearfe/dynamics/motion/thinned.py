"""What a run keeps at its rate: its channels, filtered before they are thinned, so that nothing above half the rate folds down.

Forces and accelerations are products of the motion and of stiffnesses that turn with the gears: they have harmonics that the
motion has not, so that channels are filtered and not the states alone.
"""

import math
from functools import cache

import numpy as np
from scipy.signal import firwin

PASSED = 0.4  # of the rate: amplitudes below it stay, of those above half the rate a ten-thousandth (80 dB) is left
SHORT_PASSED = 1 / 14  # of the lower rate of filters before the last one, which see no less than nine times the rate kept
REACH, SHORT = 26, 3  # samples a filter looks at on either side, at its own lower rate: of the last filter, of those before
LEAST, MOST = 2, 16  # steps for each sample kept, at least; samples that one filter makes one of at most
WIDTH = 7.857  # of Kaiser's window, for 80 dB
TOGETHER = 16  # samples kept that one product makes
STEEP = 2.509  # samples on either side times the width from what stays to what is left out, of the rate; for 80 dB


def stages(every):
    """Of how many samples each filter makes one, the last at least nine unless it is alone; their product is `every` or more.

    >>> stages(1), stages(7), stages(40), stages(1000)
    ((2,), (7,), (3, 14), (4, 16, 16))
    """
    every = max(every, LEAST)
    if every <= MOST:
        return (every,)
    apart = math.ceil(every / MOST)
    before = (apart,) if apart <= MOST else stages(apart)
    return (*before, math.ceil(every / math.prod(before)))


def thinned(pieces, counts):
    """Channels filtered and thinned by one filter after the other.

    Linear-phase filters without delay. Nothing is known before the first and after the last row: a row i from an end is filtered
    by what lies i rows on either side of it, which lets the same amplitudes pass and more of what lies above; the first and the
    last stay as they are.

    Parameters
    ----------
    pieces : iterable of ndarray, shape (rows, c)
        One after the other, ``kept * prod(counts) + 1`` rows in all.
    counts : tuple of int
        Of `stages`.

    Returns
    -------
    ndarray, shape (kept + 1, c)
    """
    return np.concatenate(list(thinned_pieces(pieces, counts)))


def thinned_pieces(pieces, counts):
    """As `thinned`, piece by piece."""
    for count in counts[:-1]:
        pieces = _filtered(pieces, count, SHORT, SHORT_PASSED)
    return _filtered(pieces, counts[-1], REACH, PASSED)


@cache
def _weights(count, reach, passed):
    """Of ``2 reach count + 1`` samples in the one kept of `count`, of which amplitudes below `passed` of its rate stay.

    J. F. Kaiser, Proc. IEEE Int. Symp. Circuits Syst. (1974) 20-23; `scipy.signal.firwin`.
    """
    cut = 2 * (passed + STEEP / 2 / max(reach, 1e-9)) / count
    if cut >= 1:  # nothing to leave out
        return np.eye(1, 2 * reach * count + 1, reach * count)[0]
    return firwin(2 * reach * count + 1, cut, window=("kaiser", WIDTH))


@cache
def _matrix(count, reach, passed):
    """`_weights` in `TOGETHER` rows, each moved on by `count`, so that as many samples are one product."""
    weights = _weights(count, reach, passed)
    rows = np.zeros((TOGETHER, (TOGETHER - 1) * count + weights.size))
    for i, row in enumerate(rows):
        row[i * count : i * count + weights.size] = weights
    return rows


def _filtered(pieces, count, reach, passed):
    """One filter: every `count`-th row, in pieces."""
    waiting, at, whole = None, 0, reach * count  # `at`: the next row kept; on each side of it are `whole`, or all there are

    def ended(rows):
        """Rows near the beginning or the end."""
        near = [min(row, len(waiting) - 1 - row, whole) // count for row in rows]
        parts = (waiting[row - side * count : row + side * count + 1] for row, side in zip(rows, near, strict=True))
        return [_weights(count, side, passed) @ part for side, part in zip(near, parts, strict=True)]

    for piece in pieces:
        waiting = piece if waiting is None else np.concatenate([waiting, piece])
        if len(waiting) <= 2 * whole:
            continue
        if at < whole:
            yield np.array(ended(range(0, whole, count)))
            at = whole
        done, waiting = _taken(waiting, count, _matrix(count, reach, passed))
        yield done
    yield np.array(ended(range(at, len(waiting), count)))


def _taken(waiting, count, matrix):
    """Rows that have enough on either side, filtered; those that later ones still need."""
    length = matrix.shape[1] - (len(matrix) - 1) * count
    ready, out = (len(waiting) - length) // count + 1, []
    for first in range(0, ready, len(matrix)):
        rows = min(len(matrix), ready - first)
        wide = (rows - 1) * count + length
        out.append(matrix[:rows, :wide] @ waiting[first * count : first * count + wide])
    return np.concatenate(out), waiting[ready * count :]
