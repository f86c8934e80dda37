"""What became of a hostile input: a clear answer, a traceback, a hang, or silent nonsense."""

import contextlib
import io
import math
import re
import signal
import warnings
from collections import Counter

import numpy as np

import gearfe as gf
from gearfe.app.cli import main

CLEAR, TRACEBACK, HANG, NONSENSE = "clear answer", "traceback", "hang", "silent nonsense"
LIMIT = 20  # seconds of an input before it counts as a hang
STIFFEST, SOFTEST = 40.0, 0.5  # k of gears of steel, over E b / 207 GPa [N/(mm um)]: whole range of sensible gears


class Hang(BaseException):
    """The time is over; no Exception, so that nothing catches it."""


@contextlib.contextmanager
def limited(seconds=LIMIT):
    """Raise `Hang` after so many seconds."""

    def stop(*_):
        raise Hang

    before = signal.signal(signal.SIGALRM, stop)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def judged(work, names, *, must_say=True):
    """Class and text of an input: `work` does it; `names` are words one of which an answer in words must hold.

    With `must_say` a result without a word is nonsense; otherwise it must be sound, see `unsound`.
    """
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        try:
            with limited():
                result = work()
        except Hang:
            return HANG, ""
        except (ValueError, RuntimeError) as error:
            text = str(error)
            named = "\n" not in text.strip() and len(text) > 15 and any(re.search(name, text) for name in names)
            return (CLEAR if named else NONSENSE), f"{type(error).__name__}: {text}"
        except Exception as error:
            return TRACEBACK, f"{type(error).__name__}: {error}"
    told = [str(one.message) for one in said if issubclass(one.category, UserWarning)]
    if any(issubclass(one.category, RuntimeWarning) for one in said):
        return NONSENSE, f"numpy warns: {said[-1].message}"
    if any(re.search(name, text) for name in names for text in told):
        return CLEAR, told[0]
    wrong = "a result without a word" if must_say else unsound(result)
    return (NONSENSE, wrong) if wrong else (CLEAR, "a sound result")


def unsound(result):
    """What is wrong with a result; empty if nothing that can be seen."""
    if isinstance(result, gf.StiffnessCurve):
        meta = result.meta
        stiff = [one["E"] for one in meta["materials"]]
        unit = meta["width_mm"] * 1e6 * 2 / sum(207e3 / one for one in stiff)
        if not (np.isfinite(result.k).all() and (result.k > 0).all()):
            return "k is not positive"
        if not (SOFTEST * unit < result.k.min() and result.k.max() < STIFFEST * unit):
            return f"k of {result.k.min() / unit:.3g} to {result.k.max() / unit:.3g} N/(mm um)"
        if np.isfinite(result.force).all() and not np.allclose(result.force.sum(axis=1), meta["force_N"], rtol=1e-6):
            return "forces do not add up to the load"
        if result.error is not None and not (np.isfinite(result.error).all() and (result.error >= 0).all()):
            return "an error estimate that is none"
    if isinstance(result, gf.Response) and not np.isfinite(result.states).all():
        return "a response that is not finite"
    if isinstance(result, (float, np.floating)) and not math.isfinite(result):
        return f"a result of {result}"
    return ""


def judged_command(arguments, names, *, must_fail=True):
    """The same of a command line, in this process: exit code 1 or 2 and words on standard error, or (not `must_fail`) 0."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            with limited():
                code = main(arguments)
        except Hang:
            return HANG, ""
        except SystemExit as error:
            code = error.code
        except Exception as error:
            return TRACEBACK, f"{type(error).__name__}: {error}"
    text = err.getvalue()
    if "Traceback" in text:
        return TRACEBACK, text
    if code in (1, 2):
        named = any(re.search(name, text) for name in names)
        short = code == 2 or len(text.strip().splitlines()) == 1 or "note:" in text
        return (CLEAR if named and short else NONSENSE), text
    if code == 0 and not must_fail:
        return (NONSENSE if re.search(r"\b(nan|inf)\b", out.getvalue()) else CLEAR), "done"
    return (CLEAR if any(re.search(name, text) for name in names) else NONSENSE), f"code {code}: {text}"


def tally(found):
    """Counts by class, and what went wrong in words, of ``{input: (class, text)}``."""
    counts = Counter(kind for kind, _ in found.values())
    wrong = [f"{name}: {kind}: {text[:200]}" for name, (kind, text) in found.items() if kind != CLEAR]
    print(f"{len(found)} inputs: " + ", ".join(f"{counts[kind]} {kind}" for kind in (CLEAR, TRACEBACK, HANG, NONSENSE)))
    return counts, "\n".join(wrong)
