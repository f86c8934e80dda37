"""User-defined stiffness models, functions or files, as curves to compare."""

import importlib.util
import math
import os
import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..core.case import Case
from ..core.material import Material
from ..geometry.aliases import Floats, StrPath
from ..geometry.pair.contacts import contacts
from ..stiffness.curve import StiffnessCurve
from ..stiffness.own_flexibility import OwnFlexibility
from ..stiffness.solve import Solve, solve
from .model_file import ModelFile, read_model

SHARED_META = ("force_N", "width_mm", "gear_1", "gear_2", "a_mm", "eps_alpha", "materials", "versions")
SAME = ("force_N", "gear_1", "gear_2", "a_mm")  # entries that a curve written by gearfe must share with the scene
FAR = 10.0  # ratio to the reference that hints at a wrong unit


@dataclass(frozen=True, slots=True)
class PairModel:
    """Stiffness of one tooth pair as a function of its contact point. The mesh stiffness is the sum over the pairs in contact.

    Parameters
    ----------
    function : callable
        ``f(radius_1, radius_2) -> k``: contact radii on pinion and wheel [mm], ndarrays of shape (n,), to the stiffness of the
        pair [N/m] over the whole width, shape (n,). It is asked for contacts on the path of contact only.
    """

    function: Callable[[Floats, Floats], Floats]

    def __post_init__(self) -> None:
        """Raise ValueError if the model is not a function."""
        if not callable(self.function):
            raise ValueError(f"PairModel({self.function!r}): give a function f(radius_1, radius_2) -> k [N/m]")


# a function of the phase, or a model object with a label and options
OneModel = Callable[[Floats], Floats] | PairModel | OwnFlexibility | ModelFile | StrPath
OwnModel = OneModel | tuple[OneModel, OneModel]  # models of the damaged and of the healthy pair


def own_models(models, taken=()):
    """Return models by name. Models given as files are read.

    A model is one of these:
    - a function ``f(phase) -> k`` of mesh phases from 0 to 1, an ndarray of shape (n,), that returns the total stiffness [N/m]
      over the whole face width;
    - a `PairModel` or an `OwnFlexibility`;
    - ``"file.py:name"`` of one of these in a Python file, which is run;
    - the path of a table (see `read_model`), or a `ModelFile`;
    - a tuple ``(damaged, healthy)`` of two of them, or text ``"damaged.csv,healthy.csv"``: a damaged pair and the same pair
      healthy.
    """
    if callable(models) or isinstance(models, (str, os.PathLike, PairModel, OwnFlexibility, ModelFile)):
        raise ValueError(f"models = {models!r}, but give a list, models=[...], or a dict, models={{'name': ...}}")
    items = list(models.items()) if isinstance(models, dict) else [(_name(m, i), m) for i, m in enumerate(models, 1)]
    out = {}
    for name, model in items:
        parts = _parts(model)
        if len(parts) > 2:
            raise ValueError(f"model {name!r} has {len(parts)} parts, but give one, or the damaged and the healthy one")
        read = [_read(name, one) for one in parts]
        if name in taken or name in out:
            clash = "is a formulation of gearfe" if name in taken else "stands for two models"
            raise ValueError(f"the name {name!r} {clash}; rename the file or function, or give models={{'another name': ...}}")
        out[name] = read[0] if len(read) == 1 else tuple(read)
    return out


def _parts(model):
    """Split a model into the models of the damaged and the healthy pair, if it states both.

    A comma within the name of an existing file does not separate two models.
    """
    if isinstance(model, tuple):
        return model
    return model.split(",") if isinstance(model, str) and not Path(model).is_file() else (model,)


def _read(name, model):
    """Return a model, read from its file if a path is given. Raises ValueError for anything that is not a model."""
    if isinstance(model, (str, os.PathLike)):
        match = re.fullmatch(r"(.+\.py)(?::(.*))?", str(model), re.DOTALL)
        return _in_file(*match.groups()) if match else read_model(model)
    if not callable(model) and not isinstance(model, (PairModel, OwnFlexibility, ModelFile)):
        raise ValueError(
            f"model {name!r} is {type(model).__name__}, but give f(phase) -> k [N/m], PairModel(f), OwnFlexibility(f), "
            "or the path of a file"
        )
    return model


def _in_file(path, name):
    """Return the model with this name in a Python file."""
    if not Path(path).is_file():
        raise ValueError(f"{path}: no such file")
    spec = importlib.util.spec_from_file_location(Path(path).stem, path)
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as error:  # A user's file may raise any exception.
        raise ValueError(f"{path} failed with {type(error).__name__}: {error}") from error
    kinds = (PairModel, OwnFlexibility)
    has = [
        key
        for key, value in vars(module).items()
        if isinstance(value, kinds) or getattr(value, "__module__", "") == module.__name__
    ]
    if name not in has:
        known = f"it has {', '.join(has)}" if has else "it has no function"
        raise ValueError(f"{path}: no model {name or ''!r}; {known}: give {path}:NAME, of a function f(phase) -> k [N/m]")
    return getattr(module, name)


def _name(model, number):
    model = _parts(model)[0]
    if isinstance(model, OwnFlexibility):
        return model.name if model.name.isidentifier() else f"model {number}"
    if isinstance(model, PairModel):
        model = model.function
    if isinstance(model, ModelFile):
        model = model.path
    if isinstance(model, (str, os.PathLike)):
        return re.sub(r".+\.py:", "", str(model)) if ".py:" in str(model) else Path(model).stem
    name = getattr(model, "__name__", "")
    return name if name.isidentifier() else f"model {number}"


def own_curve(name, model, pair, reference, healthy=None):
    """`StiffnessCurve` of a user-defined model (from `own_models`) at the phases and the load of a reference curve.

    With a `healthy` model of tooth pairs, `model` is used for the damaged tooth pairs only. The curve has ``k_tangent = k``
    and ``deflection = F / k``. Pressures are nan, and so are the forces of the pairs if the model gives only their total. An
    `OwnFlexibility` gives all quantities, because it is solved by `solve`. ValueError if the model fails, if k has the wrong
    shape or is not finite and positive, or if a file does not cover the requested phases.
    """
    if isinstance(model, OwnFlexibility):
        materials = tuple(Material(**constants) for constants in reference.meta["materials"])
        curve = solve(Case(pair, reference.meta["force_N"], materials), Solve(model, reference.phase))
        _hint(name, model, curve.k, reference)
        return replace(curve, meta=curve.meta | {"method": name})
    touch = contacts(pair, reference.phase, extended=False)
    touching = np.isfinite(touch.gap)
    meta = {key: reference.meta[key] for key in SHARED_META} | {"method": name, "model": _kind(model)}
    if isinstance(model, PairModel) or getattr(model, "abscissa", None) == "radius":
        of_pair = np.zeros(touching.shape)
        damaged = [one["tooth"] for side in reference.meta.get("damage", {}).values() for one in side]
        whole = touching & ~np.isin(touch.order, damaged) & (healthy is not None)
        for one, where in ((model, touching & ~whole), (healthy, whole)):
            if where.any():
                of_pair[where] = _single(name, one, pair, touch.roll_1[where], touch.roll_2[where], meta["width_mm"])
        k = of_pair.sum(axis=1)
        force = meta["force_N"] * of_pair / k[:, None]
    else:
        k = _total(name, model, pair, reference.phase, meta["width_mm"])
        force = np.where(touching, np.nan, 0.0)
    _hint(name, model, k, reference)
    used = touching.any(axis=0)
    nothing = np.full((k.size, np.count_nonzero(used)), np.nan)
    deflection = meta["force_N"] / k
    return StiffnessCurve(reference.phase, k, k, deflection, touch.order[used], force[:, used], nothing, meta=meta)


def _kind(model):
    if isinstance(model, ModelFile):
        return {"file": model.path, "abscissa": model.abscissa, "per_width": model.per_width, "phase_offset": model.phase_offset}
    return "stiffness of a tooth pair, plain sum" if isinstance(model, PairModel) else "total mesh stiffness"


def _single(name, model, pair, roll_1, roll_2, width):
    """Return the stiffness of the tooth pairs [N/m] at their contact points."""
    radius_1, radius_2 = np.hypot(pair.gear_1.r_b, roll_1), np.hypot(pair.gear_2.r_b, roll_2)
    if isinstance(model, ModelFile):
        return model.single(pair, radius_1) * (width * 1e-3 if model.per_width else 1.0)
    return _called(name, model.function, (radius_1, radius_2), "radius_1 = {:.6g} mm, radius_2 = {:.6g} mm")


def _total(name, model, pair, phase, width):
    """Total mesh stiffness [N/m]. A function is called with phases from 0 up to, not including, 1."""
    if isinstance(model, ModelFile):
        return model.total(pair, phase) * (width * 1e-3 if model.per_width else 1.0)
    phase = phase % 1.0
    phase[phase >= 1.0] = 0.0  # -1e-17 % 1.0 is 1.0 in floating point.
    return _called(name, model, (phase,), "phase {:.6g}")


def _called(name, function, given, where):
    """Call the function of a user's model, and return the checked result."""
    n = given[0].size
    once = f"it is called once, with arrays of {n} values; numpy.vectorize(f) makes a function of single numbers fit"
    try:
        k = np.asarray(function(*given))
    except Exception as error:  # A user's function may raise any exception.
        raise ValueError(f"model {name!r} failed with {type(error).__name__}: {error} ({once})") from error
    if k.shape != (n,):
        raise ValueError(f"model {name!r} returned an array of shape {k.shape}, but give ({n},): one k for each value ({once})")
    if k.dtype.kind not in "fiu":
        raise ValueError(f"model {name!r} returned values of type {k.dtype}, but k is a real number [N/m]")
    k = k.astype(float)
    bad = np.flatnonzero(~(np.isfinite(k) & (k > 0)))
    if bad.size:
        at = where.format(*(values[bad[0]] for values in given))
        raise ValueError(f"model {name!r} returned k = {k[bad[0]]:g} N/m at {at}, but k must be finite and positive")
    return k


def _hint(name, model, k, reference):
    """Warn of a probable mistake in the unit, or if the curve seems to belong to another pair or load."""
    ratio = math.exp(np.log(k / reference.k).mean())
    if not 1 / FAR < ratio < FAR:
        warnings.warn(
            f"model {name!r} is {ratio:.3g} times the reference: check that k is for the whole width, in N/m or the stated unit",
            stacklevel=4,
        )
    written = getattr(model, "meta", None)
    if written and (other := [key for key in SAME if written.get(key) != reference.meta[key]]):
        warnings.warn(f"{model.path} was computed for another {', '.join(other)} than this scene's pair", stacklevel=4)
