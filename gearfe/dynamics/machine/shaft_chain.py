"""Shafts of a gearbox as chains of stations: lumped masses between exact massless pieces of a Timoshenko beam."""

import math
from typing import NamedTuple

import numpy as np

from ...core.supports.beam import ShaftPiece, pieces_between
from ...scene.train import TrainShaft
from .layout import SPACE, Layout
from .springs import Spring

DAMPED = 0.02  # default damping ratio of bearings


class Chain(NamedTuple):
    """Shaft as stations from left to right: positions [mm], names of the bodies, and the shaft piece after each station."""

    shaft: TrainShaft
    places: list[float]
    names: list[str]
    pieces: list[tuple[float, ShaftPiece]]

    def at(self, place: float) -> str:
        """Name of the station at a position [mm]."""
        return self.names[int(np.argmin(np.abs(np.array(self.places) - place)))]


def chain(name: str, shaft: TrainShaft, places: dict[str, float]) -> Chain:
    """Stations at the gears, bearings, steps and ends of a shaft, and at further named `places` [mm].

    A station has the name of its gear, else of the place, else of the bearing, else of its number on the shaft.
    """
    bearings = {f"{name}_bearing{i + 1}": at for i, at in enumerate(shaft.bearings)}
    nodes, pieces = pieces_between(shaft.sections, [*shaft.gears.values(), *places.values(), *bearings.values()])
    names = [f"{name}_station{i + 1}" for i in range(nodes.size)]
    for named in (bearings, places, shaft.gears):
        for body, at in named.items():
            names[int(np.argmin(np.abs(nodes - at)))] = body
    return Chain(shaft, nodes.tolist(), names, pieces)


def lumps(made: Chain, density: float) -> list[list[float]]:
    """Return mass [kg] and polar and diametral moments of inertia [kg m2] at each station: half of each adjacent piece.

    Half a piece is a uniform rod that begins at the station. Its diametral moment of inertia contains ``m l**2 / 3``.
    """
    out = np.zeros((len(made.names), 3))
    for i, (length, section) in enumerate(made.pieces):
        half, second = 0.5e-3 * length, 1e-12 * section.second_moment
        mass = density * 1e-6 * section.area * half
        out[i : i + 2] += mass, 2 * density * second * half, density * second * half + mass * half**2 / 3
    rows: list[list[float]] = out.tolist()
    return rows


def shaft_springs(layout: Layout, made: Chain, name: str, damping: float) -> list[Spring]:
    """Springs of the pieces of a shaft, all called `name`. Dampers are `damping` [s] times the stiffness.

    Twice the strain energy of a uniform piece of Timoshenko's beam is a sum of squares (J. S. Przemieniecki, Theory of Matrix
    Structural Analysis, 1968, section 5.6), in each plane with displacement w and slope s::

        E I / l (s2 - s1)**2 + 12 E I / (l**3 (1 + phi)) (w2 - w1 - l (s1 + s2) / 2)**2
    """
    out, material = [], made.shaft.material
    zero = np.zeros(len(layout.dofs))
    for one, two, (length, section) in zip(made.names, made.names[1:], made.pieces, strict=False):
        a, b = ({dof: _row(layout, body, dof, zero) for dof in SPACE.split()} for body in (one, two))
        span, bending = 1e-3 * length, 1e-6 * material.E * section.second_moment
        area = section.area
        phi = 12e6 * bending / (section.shear_factor(material.nu) * material.shear_modulus * area * length**2)
        parts = [(1e-6 * 2 * material.shear_modulus * section.second_moment / span, b["theta"] - a["theta"])]
        parts.append((material.E * area / span, b["z"] - a["z"]))
        for w, slope, sense in (("x", "tilt_y", 1), ("y", "tilt_x", -1)):  # dx/dz = tilt_y, dy/dz = -tilt_x
            turned = sense * (a[slope] + b[slope])
            parts.append((bending / span, b[slope] - a[slope]))
            parts.append((12 * bending / (span**3 * (1 + phi)), b[w] - a[w] - span / 2 * turned))
        out += [Spring(name, row, k, damping * k) for k, row in parts if row.any()]
    return out


def _row(layout, body, dof, zero):
    return layout.unit(body, dof) if f"{body}.{dof}" in layout.place else zero


def bearing_springs(layout: Layout, made: Chain, name: str) -> list[Spring]:
    """Bearing springs of a shaft in x, y and z. The default damping has the ratio `DAMPED` for half of the shaft mass."""
    shaft, out = made.shaft, []
    mass = sum(layout.bodies[body].mass for body in made.names) / 2
    for i, at in enumerate(shaft.bearings):
        body = made.at(at)
        for dof, k in zip("xyz", (shaft.radial[i], shaft.radial[i], shaft.axial[i]), strict=True):
            c = shaft.damping[i] if shaft.damping else 2 * DAMPED * math.sqrt(k * mass)
            if k > 0:
                out.append(Spring(f"{name}{i + 1} {dof}", layout.unit(body, dof), k, c))
    return out
