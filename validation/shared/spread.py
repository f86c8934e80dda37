"""Spread of differences and estimates of two methods."""

import numpy as np


def spread_table(found, brute, energy):
    """Return the lines of a table with differences, errors and error estimates of two methods."""
    texts = {"difference": f"`{brute}` against `{energy}`"}
    for name in (brute, energy):
        texts |= {f"{name}_error": f"error of `{name}`", f"{name}_estimate": "its estimate"}
    out = ["| in percent of k | median | 95th percentile | worst | of the pair |", "|---|---|---|---|---|"]
    for name, text in texts.items():
        values = np.array([row[name] for _, row in found])
        spread = f"{np.median(values):.3f} | {np.quantile(values, 0.95):.3f} | {values.max():.3f}"
        out.append(f"| {text} | {spread} | {found[int(values.argmax())][0]} |")
    return out


def ratio(found, name):
    """Return median estimate over median error of a method."""
    said, off = (np.median([row[f"{name}_{what}"] for _, row in found]) for what in ("estimate", "error"))
    return float(said / off)
