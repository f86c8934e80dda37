"""`write_contact_inp`: a gear pair in nonlinear contact for CalculiX, as a section or with its whole width."""

import os
from collections.abc import Mapping, Sequence
from typing import Any, TypedDict, Unpack

from ..core.case import Case, case_of
from ..core.files import suffix_of
from ..core.material import Material
from ..geometry.damage.kinds import Damage
from ..geometry.pair.flanks import Misalignment
from ..geometry.pair.gear_pair import GearPair
from ..geometry.tooth.modified import Flank
from .contact_deck import ContactDeck, write_contact_section
from .contact_solid import write_contact_solid
from .pressing import Pressing

FURTHEST = 1e6  # largest phase at which rounding does not move contacts [mesh cycles]

GIVEN = ("face", "damage", "flanks", "misalignment")  # options that define the case


class DeckOptions(TypedDict, total=False):
    """Options of `write_contact_inp`."""

    face: str | None
    damage: Mapping[str, Sequence[Damage]] | None
    flanks: Mapping[str, Flank] | None
    misalignment: Misalignment | None
    pits: str
    pose: str
    per_width: float | None
    layers: int
    penalty: float
    refine: float


def _check_section(case):
    remedy = "give face = 'spur' or 'helical' for three dimensions"
    if case.damaged:
        raise ValueError(f"a deck of a transverse section cannot contain damage: {remedy}")
    if any(form.wide for form in case.forms or ()):
        what = "flanks that change along the width, or misalignment"
        raise ValueError(f"{what}, need three dimensions, but this deck is a section: {remedy}")


def write_contact_inp(
    path: str | os.PathLike[str],
    pair: GearPair | Case,
    phase: float,
    approach: float,
    line_load: float | None = None,
    materials: tuple[Material, Material] | None = None,
    **options: Unpack[DeckOptions],
) -> ContactDeck:
    """Write a deck that rotates the bores of a pair against each other by `approach` along the line of action.

    Contact is frictionless and surface-to-surface for all flanks that may touch, with a linear pressure-overclosure of `penalty`
    times E (50 is 0.8 % too soft, 500 has no error). Displacements are large, so that the flanks touch in the rotated positions.
    The gear whose corner touches (at a tip or at the foot of an undercut flank) is the slave side, with finer edges there: other
    choices are up to 2 % too stiff. ``ccx -i NAME`` prints the bores' reactions, from which `ContactDeck.force` returns the load.

    Without `face`: the transverse section in second-order triangles (CPE6), plane strain. With `face`: both whole gears of finite
    width in 20-node hexahedra (C3D20R), finer along the contact lines. Fillets are among the faces in contact if the edge of an
    undercut flank or the mate's tip touches there. A gear with pits, and its mate if undamaged, is meshed in second-order tets
    (C3D10) with the pits cut out as holes.

    Parameters
    ----------
    path : path
        Ends in ``.inp``.
    pair : GearPair or Case
    phase : float
        Phase of the section; with `face`, of the end face that touches first, like everywhere in three dimensions.
    approach : float
        Rotation of the pinion forward and of the wheel backward, together, as a length on the line of action [mm].
    line_load : float
        Expected load per width [N/mm], for the refinement of flanks. With a `Case`, omit it and the materials.
    materials : (Material, Material)
    **options
        The following options.
    face : {"spur", "helical"}, optional
        Type of teeth in three dimensions.
    damage : dict, optional
        With `face`: ``{"pinion": [...], "wheel": [...]}``, see `gearfe.mesh_stiffness`. Faces of cracks may pass through each
        other. Pits must be in one tooth of a gear; a crack in addition to them runs through the whole width.
    pits : {"cut", "lost", "filled"}
        Treatment of pits, always in the same mesh: cut out as holes; only contact lost, like in `ritz3d`; or no pits. The last is
        the control that separates the effect of pits from that of the mesh.
    pose : {"mean", "pinion", "wheel"}
        Both gears rotate by half the approach, or one of them with the other fixed.
    flanks : dict, optional
        Modifications, see `mesh_stiffness`: the mesh contains them (`gearfe.geometry.mesh.relieved`, with `face`
        `gearfe.geometry.mesh.relieved_solid`); `approach` is then the loaded transmission error, its unloaded part included.
    misalignment : Misalignment, optional
        With `face`: misalignment of the axes, see `mesh_stiffness`; the flanks are inclined, the axes stay.
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
        Its forces are per width [N/mm]; with `face` a `gearfe.decks.contact_solid.SolidDeck`, whose forces are whole [N].

    Raises
    ------
    ValueError
        If an input is impossible, or is not available for this deck.
    RuntimeError
        If elements of the mesh fold, where CalculiX would stop.
    """
    suffix_of(path, "deck")
    of_case: dict[str, Any] = {name: value for name, value in options.items() if name in GIVEN}
    how = Pressing(**{name: value for name, value in options.items() if name not in GIVEN})  # type: ignore[arg-type]
    if not isinstance(pair, Case):
        force = None if line_load is None else line_load * pair.b_w
        of_case |= {"force": force, "material": materials}
    case = case_of(pair, **of_case)
    if not abs(phase) <= FURTHEST:
        raise ValueError(f"phase = {phase} mesh cycles, but give a phase within {FURTHEST:g} cycles")
    if not approach > 0:
        raise ValueError(f"approach = {approach} mm, but it must be positive, so that the flanks touch")
    if case.face is None:
        _check_section(case)
        return write_contact_section(path, case, phase, approach, how)
    if case.face == "herringbone" or (case.face == "spur") == bool(case.pair.gear_1.beta):
        beta = case.pair.gear_1.beta
        raise ValueError(
            f"face = {case.face!r}, but the gears have beta = {beta:g} rad: give 'spur' for beta = 0, else 'helical'"
        )
    if how.pits != "cut" and not any(case.pits):
        raise ValueError(f"pits = {how.pits!r}, but damage contains no pit: give pits, or leave this out")
    return write_contact_solid(path, case, phase, approach, how)
