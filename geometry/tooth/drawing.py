"""Small drawing of a gear (SVG) for notebooks; nothing is computed from it."""

import math

import numpy as np

from .profile import cartesian, fillet_length, flank, root_curve


def outline_points(gear, *, points=5):
    """Return the closed transverse outline of all teeth ``(2, n)`` [mm], coarsely: for drawings only."""
    rise = np.linspace(0.0, fillet_length(gear), points), np.linspace(gear.roll_f, gear.roll_a, points)
    radius, angle = (np.concatenate(pair) for pair in zip(root_curve(gear, rise[0]), flank(gear, rise[1]), strict=True))
    radius, angle = np.concatenate([radius, radius[::-1]]), np.concatenate([-angle, angle[::-1]])
    turns = 2 * math.pi * np.arange(gear.z)[:, None] / gear.z
    return cartesian(np.tile(radius, gear.z), (angle + turns).ravel())


def path_data(points):
    """Path of an SVG through points ``(2, n)``, closed; y points down in a page."""
    return "M" + "L".join(f"{x:.3g},{-y:.3g}" for x, y in points.T) + "Z"


def gear_svg(*placed, size=140):
    """SVG of gears in their transverse section, `size` px high: each a gear, the height of its centre [mm] and its turn [rad]."""
    drawn, low, high, wide = [], math.inf, -math.inf, 0.0
    for gear, height, turn in placed:
        cos, sin = math.cos(turn), math.sin(turn)
        x, y = np.array([[cos, sin], [-sin, cos]]) @ outline_points(gear)
        edge = gear.r_rim if gear.internal else gear.r_bore
        outer = edge if gear.internal else gear.r_a
        low, high, wide = min(low, height - outer), max(high, height + outer), max(wide, outer)
        half = f"a{edge:.4g},{edge:.4g} 0 1 0 "
        ring = f"M{edge:.4g},{-height:.4g}{half}{-2 * edge:.4g},0{half}{2 * edge:.4g},0Z"
        drawn.append(f'<path d="{path_data(np.array([x, y + height]))}{ring}"/>')
    tall = high - low
    box = f"{-1.02 * wide:.4g} {-high - 0.01 * tall:.4g} {2.04 * wide:.4g} {1.02 * tall:.4g}"
    look = f'fill="#9db8d2" fill-rule="evenodd" stroke="#1f3b57" stroke-width="{tall / size:.3g}"'
    width = round(size * 2.04 * wide / (1.02 * tall))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{size}" viewBox="{box}" role="img" '
        f'aria-label="transverse section"><g {look}>{"".join(drawn)}</g></svg>'
    )


def gear_html(gear):
    """Return a table of a gear's numbers with its drawing."""
    rows = {
        "teeth z": gear.z,
        "normal module": f"{gear.m_n:g} mm",
        "pressure angle": f"{math.degrees(gear.alpha_n):g}°",
        "helix angle": f"{math.degrees(gear.beta):g}°",
        "profile shift x": f"{gear.x:g}",
        "face width b": f"{gear.b:g} mm",
        "root, reference, tip radius": f"{gear.r_f:.4g}, {gear.r:.4g}, {gear.r_a:.4g} mm",
        "held rim" if gear.internal else "held bore": f"{gear.r_rim if gear.internal else gear.r_bore:g} mm",
    }
    return beside(gear_svg((gear, 0.0, 0.0)), "ring" if gear.internal else "gear", rows)


def pair_html(pair):
    """Return a table of a pair's numbers with its drawing, in mesh at the pitch point's phase."""
    pinion, wheel = pair.gear_1, pair.gear_2
    turns = pair.turn(pair.path[0] + pair.pitch_phase * pair.p_bt)
    rows = {
        "teeth": f"{pinion.z} / {wheel.z}{' (ring)' if wheel.internal else ''}",
        "normal module": f"{pinion.m_n:g} mm",
        "centre distance": f"{pair.a:.5g} mm",
        "transverse contact ratio": f"{pair.eps_alpha:.4g}",
        "overlap ratio": f"{pair.eps_beta:.4g}",
        "face widths": f"{pinion.b:g} / {wheel.b:g} mm",
    }
    return beside(gear_svg((pinion, 0.0, float(turns[0])), (wheel, pair.centre_2, float(turns[1])), size=180), "gear pair", rows)


def beside(picture, title, rows):
    """HTML: a picture, and a table of names and values at its right."""
    cells = "".join(
        f'<tr><td style="text-align:left">{name}</td><td style="text-align:left">{value}</td></tr>'
        for name, value in rows.items()
    )
    style = "display:flex;gap:1em;align-items:center;flex-wrap:wrap"
    return f'<div style="{style}">{picture}<table><caption>{title}</caption>{cells}</table></div>'
