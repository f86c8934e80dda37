"""The methods of `mesh_stiffness` and what each can: one row for each, read wherever somebody asks.

A row answers for itself: `Method.refuses` what it does not model of a case, `Method.curves` the stiffness. The command line's
help, `compare` and `error_map` list its names. It imports nothing heavy.

To add a closed form, write one file in ``gearfe/flexibility/energy/closed/`` and one row in `ROWS`:

- kind "sum", if it describes one tooth and the pairs are springs side by side: the file has ``components(gear, material, roll,
  *, damage=ToothDamage(), ...)``, which gives `gearfe.flexibility.energy.closed.beam.Components`, as ``textbook.py``;
  its other keywords become the variants of the method. ``DEFAULTS``, if it is there, holds its contact law and root profile;
- kind "section", if it describes what a whole gear gives to all its contacts: the file has ``flexibility(gear, material, *,
  neighbours, state)``, which gives `gearfe.flexibility.plane.Flexibility`, as ``coupled.py``.
"""

from dataclasses import dataclass, replace
from importlib import import_module
from typing import TYPE_CHECKING, Any

from ..core.threads import loading

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..core.case import Case

SPUR = ("spur",)
FACES = ("spur", "helical", "herringbone")  # how teeth run
WAYS = {  # who makes curves of a kind of method
    "section": "gearfe.stiffness.section_curves:section_curves",
    "sum": "gearfe.stiffness.section_curves:sum_curves",
    "solid": "gearfe.stiffness.wide_curves:solid_curves",
}


@dataclass(frozen=True, slots=True)
class Method:
    """One method, and what it takes.

    Attributes
    ----------
    name : str
    about : str
        What it is, in one line.
    kind : {"section", "solid", "sum"}
        ``section``: the flexibility of the transverse section, plane; ``solid``: of gears of finite width; ``sum``: no
        flexibility of a gear, but the stiffness of tooth pairs that ignore each other, sliced along the width.
    home : str
        ``module:function`` that computes it; imported on first use (`load`).
    cost : str
        Of one curve: milliseconds, seconds or minutes.
    converged : bool
        Its discretisation can be refined to the limit; otherwise a closed form.
    cracks : {"", "through", "any"}
        None; of one depth through the whole width; also of part of the width, or of a depth that changes along it.
    pits, broken : bool
        Whether it has pits and spalls, and missing teeth and chipped tips.
    rings : {"yes", "no", "external", "printed"}
        The last two: only with the variant ``foundation`` saying what a ring's body does; of a scene's rings it is this one.
    faces : tuple of str
        How the teeth may run. A section takes helical gears as spur gears of the same width.
    variants, teeth, error, extended, flanks : bool
        Whether it has variants, can leave out teeth, estimates its error, lets tip corners touch off the path of contact, takes
        modified flanks.
    order : int or None
        Default order of its polynomials.
    kept : {"", "process", "disk"}
        Whether its function takes ``cache``, and keeps solved gears there: in this process, or also on disk, as finite elements.
    crack_models : tuple of str
        Limit lines of a crack with which `gearfe.error_map` judges it.
    own : OwnFlexibility or None
        A model of the user's own, of which this is the row.
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
        """Whether it is finite elements of whole gears in three dimensions, whose matrices are large."""
        return self.kind == "solid" and self.kept == "disk"

    def load(self) -> Any:
        """The function, or for a sum the module, that computes it."""
        return _loaded(self.home)

    def refuses(self, case: "Case", how: Any) -> None:
        """Raise ValueError for what the method does not model of a `Case`, or has no option for (`gearfe.stiffness.refusals`)."""
        _loaded("gearfe.stiffness.refusals:refuses")(self, case, how)

    def curves(self, case: "Case", how: Any, phase: "NDArray") -> list[Any]:
        """Stiffness curves of a `Case`, one for each of its loads, at phases ``(n,)`` of the mean pose.

        In `how`, a `Solve`, what its defaults stand for is filled in.
        """
        return _loaded(WAYS[self.kind])(self, case, how, phase)


def _loaded(home):
    """What ``module:name`` names, or the module."""
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
        "fe", "finite elements of the transverse section; mesh, elements and solution are not those of ritz", "section",
        "gearfe.stiffness.cache:solved_gear", "seconds", converged=True, cracks="through", broken=True, teeth=True, error=True,
        extended=True, flanks=True, kept="disk",
    ),
    Method(
        "fe3d", "finite elements of whole gears of finite width; mesh, elements and solution are not those of ritz3d", "solid",
        "gearfe.stiffness.cache:solved_solid", "minutes", converged=True, cracks="any", pits=True, broken=True, faces=FACES,
        error=True, extended=True, flanks=True, kept="disk",
    ),
    Method(
        "coupled", "closed form: tapered beams on a common annulus, neighbours coupled; healthy external gears", "section",
        "gearfe.flexibility.energy.closed.coupled:flexibility", "milliseconds", rings="no", flanks=True, kept="process",
    ),
    Method(
        "textbook", "closed form: beams on Sainsot's foundation, plain sum of tooth pairs", "sum",
        "gearfe.flexibility.energy.closed.textbook", "milliseconds", cracks="through", pits=True, rings="external", faces=FACES,
        variants=True, flanks=True, crack_models=("constant", "straight", "parabola"),
    ),
    Method(
        "herringbone_article", "closed form: the beams of the article, as printed and corrected, plain sum of tooth pairs", "sum",
        "gearfe.flexibility.energy.closed.herringbone_article", "milliseconds", cracks="through", pits=True,
        rings="printed", faces=FACES,
        variants=True, flanks=True, crack_models=("constant",),
    ),
)  # fmt: skip
METHODS = {row.name: row for row in ROWS}
FORMER = {"published": "herringbone_article"}  # former names of methods
NAMES = ("auto", *METHODS)
SUMS = tuple(row.name for row in ROWS if row.kind == "sum")
RING_FOUNDATIONS = {  # variants `foundation` that say what a ring's body does
    "external": "has no foundation for a ring: the ring's body is left out",
    "none": "is taken without foundations",
    "printed": "takes the ring's foundation as its article prints it, by the formula of discs with h = 1",
}


def current(name: Any) -> Any:
    """Return the present name of a method, with a DeprecationWarning for a former one; anything else unchanged."""
    if isinstance(name, str) and name in FORMER:
        from ..geometry.renamed import warn_renamed  # here: it loads numpy, and the command's help needs none

        warn_renamed(f"method {name!r}", repr(FORMER[name]))
        return FORMER[name]
    return name


def described():
    """One line of text for each method: its name, what it is, what it costs."""
    return "\n".join(f"  {row.name:19s} {row.about}; {row.cost}" for row in ROWS)


def having(what, kind=None):
    """Names of the methods that have `what`, an attribute of `Method`, as text: 'ritz, fe or fe3d'."""
    names = [row.name for row in ROWS if getattr(row, what) and kind in (None, row.kind)]
    return " or ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


def fitted(method, case):
    """A case as far as a method knows it, with the variants it needs (or None), and in words what is left out.

    This is the one rule for which face, groove and variants go to which method:

    - a transverse section takes a helical or herringbone pair as a spur pair of the width that carries, b less the groove;
    - whatever knows no width takes shafts that tilt their gears as such that only give way;
    - a plain sum takes a ring's body as its row says: left out, or as its article prints it.

    `method` is one of `NAMES`; ``auto`` takes everything. `gearfe.solve` itself refuses such cases, so that nobody gets a section
    who asked for a helical gear.
    """
    if method not in METHODS:
        return case, None, ()
    row, pair, changed, variants, left_out = METHODS[method], case.pair, {}, None, []
    if case.runs not in row.faces:
        changed |= {"face": None, "groove": 0.0}
        width = min(pair.gear_1.b, pair.gear_2.b)
        if case.groove:
            width -= case.groove
            changed["pair"] = replace(pair, gear_1=replace(pair.gear_1, b=width), gear_2=replace(pair.gear_2, b=width))
        less = f", b less the groove of {case.groove:g} mm" if case.groove else ""
        left_out.append(f"{method} is the transverse section: {case.runs} teeth are taken as spur teeth {width:g} mm wide{less}")
    if row.kind != "solid" and any(held.tilts for held in case.held or () if held):
        changed["supports"] = {name: held and held.untilted() for name, held in case.supports.items()}
        left_out.append(f"{method} knows no width: shafts give way, but do not tilt their gears")
    if pair.gear_2.internal and row.rings in RING_FOUNDATIONS:
        variants = {"foundation": row.rings}
        left_out.append(f"{method} {RING_FOUNDATIONS[row.rings]}")
    return replace(case, **changed) if changed else case, variants, tuple(left_out)
