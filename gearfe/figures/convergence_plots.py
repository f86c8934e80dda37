"""Plot (matplotlib) of errors over the resolution."""

import numpy as np

from ..core.files import save_figure
from .look import blank, look


def plot_convergence(method, refine, order, estimate, away, path=None):
    """Draw an estimate (dashed) and the true difference [%] over the resolution. Save to `path` if given.

    Parameters
    ----------
    method : str
        For the title.
    refine, estimate, away : ndarray, shape (n,)
        Resolutions, estimated errors and differences from the finest solve [%]; differences of zero are left out.
    order : sequence of (int or None)
        Polynomial order of each solve; there is a pair of lines for each.
    """
    figure, axes = blank((8.0, 4.0))
    for number, own in enumerate(sorted(set(order), key=lambda p: p or 0)):
        at = np.array([p == own for p in order])
        colour, name = look(number)["color"], "" if own is None else f", order {own}"
        axes.loglog(refine[at], estimate[at], "o--", color=colour, label=f"estimate{name}")
        seen = at & (away > 0)
        axes.loglog(refine[seen], away[seen], "o-", color=colour, label=f"difference from the finest{name}")
    axes.set_xticks(sorted(set(refine.tolist())), [f"{value:g}" for value in sorted(set(refine.tolist()))])
    axes.set_xticks([], minor=True)
    axes.set_xlabel("resolution (refine)")
    axes.set_ylabel("largest over the phases [% of k]")
    axes.set_title(f"Convergence of {method}", fontsize=10)
    axes.legend(fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    return save_figure(figure, path, dpi=120)
