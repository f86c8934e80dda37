"""Methods of `mesh_stiffness` and their abilities, with one row per method.

`Method.refuses` raises for everything in a case that the method does not model, and `Method.curves` computes the stiffness. The
help of the command line, `compare` and `error_map` list the names. The module imports nothing heavy.

To add a closed form, write one file in ``gearfe/flexibility/energy/closed/`` and one row in `ROWS`:

- kind "sum", if it describes one tooth and the pairs are parallel springs: the file has ``components(gear, material, roll, *,
  damage=ToothDamage(), ...)``, which returns `gearfe.flexibility.energy.closed.beam.Components`, like ``textbook.py``. Its other
  keywords become the variants of the method. The optional ``DEFAULTS`` contains its contact law and root profile;
- kind "section", if it describes a whole gear with all its contacts: the file has ``flexibility(gear, material, *, neighbours,
  state)``, which returns `gearfe.flexibility.plane.Flexibility`, like ``coupled.py``.
"""

from dataclasses import dataclass, replace
from importlib import import_module
from typing import TYPE_CHECKING, Any

from ..core.threads import loading

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..core.case import Case

SPUR = ("spur",)
FACES = ("spur", "helical", "herringbone")  # types of teeth along the width
WAYS = {  # by kind of method: function that computes its curves
    "section": "gearfe.stiffness.section_curves:section_curves",
    "sum": "gearfe.stiffness.section_curves:sum_curves",
    "solid": "gearfe.stiffness.wide_curves:solid_curves",
}


@dataclass(frozen=True, slots=True)
class Method:
    """Method of `mesh_stiffness`, and its abilities.

    Attributes
    ----------
    name : str
    about : str
        Description in one line.
    kind : {"section", "solid", "sum"}
        ``section``: the flexibility of the transverse section, plane. ``solid``: that of gears of finite width. ``sum``: the
        stiffness of uncoupled tooth pairs, sliced along the width.
    home : str
        ``module:function`` that computes it; imported on first use (`load`).
    cost : str
        Computing time of one curve: milliseconds, seconds or minutes.
    converged : bool
        Its discretisation can be refined to the limit; otherwise a closed form.
    cracks : {"", "through", "any"}
        Cracks: none; of one depth through the whole width; also of part of the width, or of variable depth.
    pits, broken : bool
        True if it models pits and spalls, and missing teeth and chipped tips.
    rings : {"yes", "no", "external", "printed"}
        The last two: only with the variant ``foundation``, which defines the ring's body; this one is used for rings of scenes.
    faces : tuple of str
        Permitted types of teeth. A section replaces helical gears by spur gears of the same width.
    variants, teeth, error, extended, flanks : bool
        True if it has variants, can model only some teeth, estimates its error, models tip-corner contact off the path of
        contact, models modified flanks.
    order : int or None
        Default order of its polynomials.
    kept : {"", "process", "disk"}
        Cache of its solved gears: none, in this process, or also on disk.
    crack_models : tuple of str
        Limit lines of a crack in `gearfe.error_map`.
    own : OwnFlexibility or None
        User-defined model of this row.
    """

    name: str
    about: str
    kind: str
    home: str
    cost: str
    converged: bool = False
    cracks: str = ""
    pits: bool = False
    broken: bool = False
    rings: str = "yes"
    faces: tuple[str, ...] = SPUR
    variants: bool = False
    teeth: bool = False
    error: bool = False
    extended: bool = False
    flanks: bool = False
    order: int | None = None
    kept: str = ""
    crack_models: tuple[str, ...] = ()
    own: Any = None

    @property
    def brute(self) -> bool:
        """True for finite elements of whole gears in three dimensions, whose matrices are large."""
        return self.kind == "solid" and self.kept == "disk"

    def load(self) -> Any:
        """Return the function that computes the method, or for a sum its module."""
        return _loaded(self.home)

    def refuses(self, case: "Case", how: Any) -> None:
        """Raise ValueError for anything in a `Case` that the method does not model, and for options that it does not have."""
        _loaded("gearfe.stiffness.refusals:refuses")(self, case, how)

    def curves(self, case: "Case", how: Any, phase: "NDArray") -> list[Any]:
        """Compute stiffness curves of a `Case`, one per load, at phases ``(n,)`` in the mean pose.

        `how` is a `Solve` without open defaults: method, order and resolution are stated.
        """
        return _loaded(WAYS[self.kind])(self, case, how, phase)


def _loaded(home):
    """Return the object named ``module:name``, or the module."""
    module, _, name = home.partition(":")
    with loading:
        loaded = import_module(module)
    return getattr(loaded, name) if name else loaded


ROWS = (
    Method(
        "ritz", "converged energy model of the transverse section", "section", "gearfe.flexibility.energy.ritz.plane:flexibility",
        "milliseconds", converged=True, cracks="through", broken=True, error=True, extended=True, flanks=True,
        order=4, kept="process",
    ),
    Method(
        "ritz3d", "converged energy model of gears of finite width: helical, herringbone, pits", "solid",
        "gearfe.flexibility.energy.ritz.solid:flexibility3d", "seconds", converged=True, cracks="any", pits=True, broken=True,
        faces=FACES, error=True, extended=True, flanks=True, order=3, kept="process",
    ),
    Method(
        "fe", "finite elements of the transverse section, with other mesh, elements and solver than ritz", "section",
        "gearfe.stiffness.cache:solved_gear", "seconds", converged=True, cracks="through", broken=True, teeth=True, error=True,
        extended=True, flanks=True, kept="disk",
    ),
    Method(
        "fe3d", "finite elements of whole gears of finite width, with other mesh, elements and solver than ritz3d", "solid",
        "gearfe.stiffness.cache:solved_solid", "minutes", converged=True, cracks="any", pits=True, broken=True, faces=FACES,
        error=True, extended=True, flanks=True, kept="disk",
    ),
    Method(
        "coupled", "closed form: tapered beams on one elastic ring that couples them; healthy external gears", "section",
        "gearfe.flexibility.energy.closed.coupled:flexibility", "milliseconds", rings="no", flanks=True, kept="process",
    ),
    Method(
        "textbook", "closed form: potential energy method with Sainsot's fillet foundation; tooth pairs in parallel", "sum",
        "gearfe.flexibility.energy.closed.textbook", "milliseconds", cracks="through", pits=True, rings="external", faces=FACES,
        variants=True, flanks=True, crack_models=("constant", "straight", "parabola"),
    ),
    Method(
        "herringbone_article", "closed form: beams of the herringbone article (S4), corrected; tooth pairs in parallel", "sum",
        "gearfe.flexibility.energy.closed.herringbone_article", "milliseconds", cracks="through", pits=True,
        rings="printed", faces=FACES,
        variants=True, flanks=True, crack_models=("constant",),
    ),
)  # fmt: skip
METHODS = {row.name: row for row in ROWS}
FORMER = {"published": "herringbone_article"}  # former names of methods and their replacements
NAMES = ("auto", *METHODS)
SUMS = tuple(row.name for row in ROWS if row.kind == "sum")
RING_FOUNDATIONS = {  # by variant of `foundation`: treatment of the ring body
    "external": "has no foundation for a ring: the ring's body is left out",
    "none": "is computed without foundations",
    "printed": "has the printed foundation of the ring, by the formula of discs with h = 1",
}


def current(name: Any) -> Any:
    """Return the present name of a method. A former name causes a DeprecationWarning. Other values are unchanged."""
    if isinstance(name, str) and name in FORMER:
        from ..geometry.renamed import warn_renamed  # imported here, because it loads numpy, which the help texts do not need

        warn_renamed(f"method {name!r}", repr(FORMER[name]))
        return FORMER[name]
    return name


def described():
    """Return one line of text for each method: name, description, cost."""
    return "\n".join(f"  {row.name:19s} {row.about}; {row.cost}" for row in ROWS)


def having(what, kind=None):
    """Return the names of methods with the attribute `what` of `Method` as text, such as 'ritz, fe or fe3d'."""
    names = [row.name for row in ROWS if getattr(row, what) and kind in (None, row.kind)]
    return " or ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


def fitted(method, case):
    """Return the part of a case that a method models, its variants (or None), and the neglected parts in words.

    This is the only rule for face, groove and variants of each method:

    - a transverse section replaces a helical or herringbone pair by a spur pair of the loaded width, b less the groove;
    - two-dimensional methods neglect the tilt of gears on their shafts, and keep the deflection;
    - a plain sum treats a ring's body as its row states: without it, or as its article prints it.

    `method` is one of `NAMES`; ``auto`` models everything. `gearfe.solve` itself rejects such cases, so that a section never
    silently replaces a helical gear.
    """
    if method not in METHODS:
        return case, None, ()
    row, pair, changed, variants, left_out = METHODS[method], case.pair, {}, None, []
    if case.runs not in row.faces:
        changed |= {"face": None, "groove": 0.0}
        width = pair.b_w
        if case.groove:
            width -= case.groove
            changed["pair"] = replace(pair, gear_1=replace(pair.gear_1, b=width), gear_2=replace(pair.gear_2, b=width))
        less = f", b less the groove of {case.groove:g} mm" if case.groove else ""
        left_out.append(f"{method} is the transverse section: {case.runs} teeth are taken as spur teeth {width:g} mm wide{less}")
    if row.kind != "solid" and any(held.tilts for held in case.held or () if held):
        changed["supports"] = {name: held and held.untilted() for name, held in case.supports.items()}
        left_out.append(f"{method} is two-dimensional: shafts deflect, but do not tilt their gears")
    if pair.gear_2.internal and row.rings in RING_FOUNDATIONS:
        variants = {"foundation": row.rings}
        left_out.append(f"{method} {RING_FOUNDATIONS[row.rings]}")
    return replace(case, **changed) if changed else case, variants, tuple(left_out)
