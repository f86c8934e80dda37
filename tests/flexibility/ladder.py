"""What each ingredient changes on the way from the textbook to the coupled closed form, with finite elements as the end."""

import math
from dataclasses import dataclass, replace

import numpy as np

from gearfe.contact.pair_contact import PairContact
from gearfe.core.material import Material
from gearfe.flexibility.energy.closed import coupled, textbook
from gearfe.geometry.pair.contacts import contacts
from gearfe.stiffness.mesh_stiffness import mesh_stiffness


@dataclass(frozen=True, slots=True)
class Rung:
    """One model of a `ladder`.

    `k` (phases,) over one mesh cycle, and its means where one pair (`single`) and where several pairs (`double`) are on the
    path of contact, nan if nowhere; all [N/m].
    """

    name: str
    k: np.ndarray
    single: float
    double: float

    @property
    def mean(self):
        """Mean over the cycle [N/m]."""
        return float(self.k.mean())

    def error(self, reference):
        """Relative errors against another rung: of `single`, of `double`, of the mean, and the largest at any phase."""
        zones = [getattr(self, zone) / getattr(reference, zone) - 1 for zone in ("single", "double", "mean")]
        return *zones, float(np.abs(self.k / reference.k - 1).max())


def plane_strain_textbook(gear, material, roll):
    """`textbook.components` with ``E / (1 - nu**2)`` for E in bending and compression; shear and foundation as they were."""
    tooth = textbook.components(gear, material, roll)
    wide = material.E / material.plane_modulus("plane strain")
    return replace(tooth, bending=wide * tooth.bending, axial=wide * tooth.axial)


def tapered_textbook(gear, material, roll):
    """`coupled.beam` on the textbook's foundation."""
    return coupled.Components(*coupled.beam(gear, material, roll), textbook.components(gear, material, roll).foundation)


def ladder(pair, force, material, phases=64):
    """Stiffness of an external, healthy pair by a row of models, each with one ingredient more than the one before.

    1. ``textbook``: `textbook`, linear contact, sum of the pairs as separate springs.
    2. ``line contact``: Weber's local deflection under the load each pair carries.
    3. ``plane strain``: ``E / (1 - nu**2)`` in the beams.
    4. ``tapered beam``: from the 30-degree section up, with the shear stress of a taper.
    5. ``annulus``: the body by its Fourier series, work-conjugate to the section forces, for Sainsot's fit.
    6. ``coupled``: teeth of a gear move each other through their body; `coupled.flexibility`.
    7. ``fe``: finite elements. All without contact beyond the path of contact.

    Weber's deflection and the shared body are the same functions in every rung that has them.

    Parameters
    ----------
    pair : GearPair
    force : float
        Along the line of action, over the whole width [N].
    material : Material or (Material, Material)
    phases : int

    Returns
    -------
    list of Rung
    """
    materials = (material, material) if isinstance(material, Material) else tuple(material)
    phase = np.arange(phases) / phases
    sum_of_pairs = mesh_stiffness(pair, force, materials, method="textbook", phases=phase)
    reference = mesh_stiffness(pair, force, materials, method="fe", phases=phase, extended=False)
    gears = list(zip((pair.gear_1, pair.gear_2), materials, strict=True))
    neighbours = math.ceil(pair.eps_alpha)
    alone = {
        "line contact": textbook.components,
        "plane strain": plane_strain_textbook,
        "tapered beam": tapered_textbook,
        "annulus": coupled.components,
    }
    models = {name: [coupled.isolated(g, m, formula) for g, m in gears] for name, formula in alone.items()}
    models["coupled"] = [coupled.flexibility(g, m, neighbours=neighbours) for g, m in gears]
    width = min(pair.gear_1.b, pair.gear_2.b)
    curves = {"textbook": sum_of_pairs.k}
    for name, flexible in models.items():
        solved = PairContact(pair, materials, flexible, phase, extended=False, state="plane strain").solve(force / width)
        curves[name] = force / (solved.closing * 1e-3)
    curves["fe"] = reference.k
    alone_there = np.isfinite(contacts(pair, phase, extended=False).gap).sum(axis=1) == 1
    return [Rung(name, k, _mean(k[alone_there]), _mean(k[~alone_there])) for name, k in curves.items()]


def _mean(values):
    return float(values.mean()) if values.size else math.nan
