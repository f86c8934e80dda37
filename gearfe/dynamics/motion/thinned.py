"""Anti-aliasing filter and decimation of the channels of a run.

Forces and accelerations are products of the motion and of stiffnesses that vary with the rotation. They have harmonics that the
motion does not have. Therefore the channels are filtered, and not only the states.
"""

import math
from functools import cache

import numpy as np

PASSED = 0.4  # pass band, as a part of the rate; amplitudes above half the rate are reduced by 80 dB
# pass band of all filters but the last, relative to their output rate, which is at least nine times the final rate
SHORT_PASSED = 1 / 14
REACH, SHORT = 26, 3  # half-length of a filter [output samples]: last filter, filters before it
LEAST, MOST = 2, 16  # least number of steps per output sample; largest decimation factor of one filter
WIDTH = 7.857  # shape parameter of Kaiser's window for 80 dB
TOGETHER = 16  # output samples computed per matrix product
STEEP = 2.509  # half-length of the filter times its transition width, relative to the rate, for 80 dB


def stages(every):
    """Return the decimation of each filter. The last one is at least nine unless it is the only one.

    Their product is `every` or more.

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
    """Filter and decimate channels by a sequence of filters, one after the other.

    The filters have linear phase and no delay. There are no data before the first and after the last row. A row i from an end is
    therefore filtered over i rows on either side, with the same pass band and less attenuation above it. The first and the last
    row are not filtered.

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
    """Iterate over the blocks of the result of `thinned`. The whole record is not in memory."""
    for count in counts[:-1]:
        pieces = _filtered(pieces, count, SHORT, SHORT_PASSED)
    return _filtered(pieces, counts[-1], REACH, PASSED)


@cache
def _weights(count, reach, passed):
    """Return ``2 reach count + 1`` filter weights for a decimation by `count`. The pass band is `passed` of the output rate.

    J. F. Kaiser, Proc. IEEE Int. Symp. Circuits Syst. (1974) 20-23.
    """
    from scipy.signal import firwin  # 0.2 s to load

    cut = 2 * (passed + STEEP / 2 / max(reach, 1e-9)) / count
    if cut >= 1:  # No sample is discarded.
        return np.eye(1, 2 * reach * count + 1, reach * count)[0]
    return firwin(2 * reach * count + 1, cut, window=("kaiser", WIDTH))


@cache
def _matrix(count, reach, passed):
    """Return `_weights` in `TOGETHER` rows, each shifted by `count`, so that one product computes as many samples."""
    weights = _weights(count, reach, passed)
    rows = np.zeros((TOGETHER, (TOGETHER - 1) * count + weights.size))
    for i, row in enumerate(rows):
        row[i * count : i * count + weights.size] = weights
    return rows


def _filtered(pieces, count, reach, passed):
    """Apply one filter, and yield every `count`-th row in pieces."""
    # `at` is the next output row; `whole` rows are on each side of it, or all there are
    waiting, at, whole = None, 0, reach * count

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
    """Return the filtered rows that have enough neighbours, and the input rows that later output rows require."""
    length = matrix.shape[1] - (len(matrix) - 1) * count
    ready, out = (len(waiting) - length) // count + 1, []
    for first in range(0, ready, len(matrix)):
        rows = min(len(matrix), ready - first)
        wide = (rows - 1) * count + length
        out.append(matrix[:rows, :wide] @ waiting[first * count : first * count + wide])
    return np.concatenate(out), waiting[ready * count :]
