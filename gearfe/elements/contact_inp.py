"""`write_contact_inp`: a gear pair in nonlinear contact for CalculiX, its section or the whole width."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from geometry.damage.kinds import Damage, by_side
from geometry.pair.flanks import Misalignment, flank_forms
from geometry.pair.gear_pair import GearPair
from geometry.tooth.modified import Flank

from ..files import suffix_of
from ..material import Material
from .contact_deck import PINION, ContactDeck, write_contact_section
from .contact_solid import PITS, write_contact_solid

SECTION, SOLID = 8.0, 1.5  # edges per Hertz half width


def write_contact_inp(
    path: str | os.PathLike[str],
    pair: GearPair,
    phase: float,
    approach: float,
    line_load: float,
    materials: tuple[Material, Material],
    *,
    face: str | None = None,
    damage: Mapping[str, Sequence[Damage]] | None = None,
    pits: str = "cut",
    pose: str = "mean",
    flanks: Mapping[str, Flank] | None = None,
    misalignment: Misalignment | None = None,
    per_width: float | None = None,
    layers: int = 3,
    penalty: float = 500.0,
    refine: float = 1.0,
) -> ContactDeck:
    """Write a deck that turns the bores of a pair against each other by `approach` along the line of action.

    Frictionless surface-to-surface contact of all flanks that may touch, with a linear pressure-overclosure of `penalty` times
    E (50 is 0.8 % too soft, 500 is not distinguishable from more); large displacements, so that the flanks touch where the
    turned gears have them. The gear whose corner touches, of a tip or at the foot of an undercut flank, is the slave side of its
    pair, with the finer edges there: other choices are up to 2 % too stiff. ``ccx -i NAME`` prints the bores' reactions, from
    which `ContactDeck.force` gives the load.

    Without `face`: the transverse section in second-order triangles (CPE6), plane strain. With it: both whole gears of their
    finite width, real teeth, in 20-node hexahedra (C3D20R), finer along the contact lines, fillets among the faces in contact
    where the edge of an undercut flank or the mate's tip touches there; a gear with pits, and its mate if that
    is undamaged, in second-order tets (C3D10) with the pits cut out as holes.

    Parameters
    ----------
    path : path
        Ends in ``.inp``.
    pair : GearPair
    phase : float
        Of the section; with `face`, as in three dimensions everywhere, of the end face that touches first.
    approach : float
        Turn of the pinion forward and of the wheel backward, together, as a length on the line of action [mm].
    line_load : float
        Expected load per width [N/mm]; decides where the flanks are refined.
    materials : (Material, Material)
    face : {"spur", "helical"}, optional
        Three dimensions.
    damage : dict, optional
        With `face`: ``{"pinion": [...], "wheel": [...]}`` as of `gearfe.mesh_stiffness`. Faces of cracks may pass through each
        other. Pits of one tooth of a gear; a crack beside them runs through the whole width.
    pits : {"cut", "lost", "filled"}
        What becomes of them, always in the same mesh: cut out as holes; material there, but no contact, as in `ritz3d`; or as
        if they were not there. The last is the control that tells what pits do from what the mesh does.
    pose : {"mean", "pinion", "wheel"}
        Whether both gears turn by half the approach, or one of them against the held other.
    flanks : dict, optional
        Modifications, as of `mesh_stiffness`: the mesh carries them (`geometry.mesh.relieved`, with `face`
        `geometry.mesh.relieved_solid`); `approach` is the transmission error under load, its unloaded part included.
    misalignment : Misalignment, optional
        With `face`: of the axes, as of `mesh_stiffness`; the flanks lie askew, the axes stay.
    per_width : float, optional
        Edges per Hertz half width in the contact zones; default 8, in three dimensions 1.5. Rims of pits follow.
    layers : int
        Element layers along the width, before `refine`.
    penalty : float
    refine : float
        Divides the other edge lengths; with `face` all of them.

    Returns
    -------
    ContactDeck
        Its forces are per width [N/mm]; with `face` a `gearfe.elements.contact_solid.SolidDeck`, whose forces are whole [N].

    Raises
    ------
    ValueError
        If an input is impossible, or asked for where it cannot be.
    RuntimeError
        If elements of the mesh fold, where CalculiX would stop.
    """
    suffix_of(path, "deck")
    if pose not in PINION:
        raise ValueError(f"pose = {pose!r}, but it must be one of {', '.join(PINION)}")
    if not approach > 0:
        raise ValueError(f"approach = {approach} mm, but the gears are pressed together: give approach > 0")
    rest: dict[str, Any] = {"pose": pose, "penalty": penalty, "refine": refine}
    if face is None:
        if damage:
            raise ValueError("damage of a section's deck, which has none: give face = 'spur' or 'helical' for three dimensions")
        if any(form.wide for form in flank_forms(pair, flanks, misalignment) or ()):
            raise ValueError(
                "flanks that change along the width, or misalignment, of a section, which knows no width: give face = 'spur' "
                "or 'helical' for three dimensions"
            )
        return write_contact_section(
            path, pair, phase, approach, line_load, materials, flanks=flanks, per_width=per_width or SECTION, **rest
        )
    if face not in ("spur", "helical") or (face == "spur") == bool(pair.gear_1.beta):
        raise ValueError(f"face = {face!r} of gears with beta = {pair.gear_1.beta:g} rad: give 'spur' or 'helical' as they are")
    if pits not in PITS:
        raise ValueError(f"pits = {pits!r}, but it must be one of {', '.join(PITS)}")
    if pits != "cut" and not any(one.removes_contact for own in (damage or {}).values() for one in own):
        raise ValueError(f"pits = {pits!r}, but there is no pit in damage: give pits, which the mesh follows")
    rest |= {"damage": damage_by_gear(damage), "pits": pits, "forms": flank_forms(pair, flanks, misalignment)}
    return write_contact_solid(
        path, pair, phase, approach, line_load, materials, per_width=per_width or SOLID, layers=layers, **rest
    )


def damage_by_gear(damage: Mapping[str, Sequence[Damage]] | None) -> tuple[tuple[Damage, ...], tuple[Damage, ...]]:
    """Damage of pinion and wheel with the teeth numbered in each gear's own frame, the wheel's against the pairs."""
    pinion, wheel = by_side(damage)
    return tuple(pinion), tuple(replace(one, tooth=-one.tooth) for one in wheel)
