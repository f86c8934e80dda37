"""Exit of a verb: one line on standard error for each kind of error, and an exit code, without traceback.

Texts of files (titles, names of cases and columns, paths) are printed by every verb. Control characters in all output are escaped
here.

Exit codes: 0: done. 1: an input is impossible, or a file cannot be written; see standard error. 2: wrong options (argparse). 130:
interrupted. 143: terminated. 141: the program that read the output has ended (as after SIGPIPE).
"""

import codecs
import contextlib
import contextvars
import errno
import os
import re
import signal
import sys
import warnings

# replacements for terminals that have only ASCII
SPELLED = {"±": "+-", "µ": "u", "·": "*", "°": "deg", "→": "->", "–": "-", "…": "..."}

# control characters and direction marks
STEERING = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")


def harmless(text):
    """Return text with escaped control characters of terminals. Line ends and tabs stay."""
    return STEERING.sub(lambda control: ascii(control[0])[1:-1], text)


class Harmless:
    """Output stream that escapes control characters in written text. Other attributes are those of the wrapped stream."""

    def __init__(self, stream):
        self._stream = stream

    def write(self, text):
        """Write text with escaped control characters."""
        return self._stream.write(harmless(text))

    def __getattr__(self, name):
        return getattr(self._stream, name)


def spelled(error):
    """Replace characters that the output cannot encode by an ASCII spelling or a question mark (codec error handler)."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(SPELLED.get(letter, "?") for letter in error.object[error.start : error.end]), error.end


def tell(text):
    """Print a line to standard error, if the process has a standard error."""
    if sys.stderr is not None:
        # The stream is closed or the disk is full, so the message cannot be printed.
        with contextlib.suppress(OSError, ValueError):
            print(harmless(f"gearfe: {text}"), file=sys.stderr, flush=True)


def as_options(error, options):
    """Return an error message in which Python arguments such as ``unit=`` are written as `options` such as ``--unit``."""
    text, names = str(error), "|".join(map(re.escape, options))
    if not names:
        return text
    # The message begins with the name of the option. Each value of `--forces` is a single `force` in Python.
    text = re.sub(rf"^({names})(?= = )", lambda match: f"--{match[1].replace('_', '-')}", text)
    text = text.replace("force = ", "--forces = ", 1) if "forces" in options and text.startswith("force = ") else text
    text = re.sub(rf"(?<=give )({names})='(\w+)'", r"--\1 \2", text)
    # `mesh_frequency` and `fault_frequency` are the options --mesh and --fault of `gearfe signal`.
    text = re.sub(rf"\b({names})_frequency = ", lambda match: f"--{match[1]} ", text)
    return re.sub(rf"(?<![\w.-])({names})=(?![=\w]),?", lambda match: f"--{match[1]}", text)


_ended: list[int] = []  # exit code after a signal, because libraries convert or drop the exception


def _end_tidily(number, _):
    """Exit by an exception, so that temporary files are removed (signal handler)."""
    _ended.append(128 + number)
    raise SystemExit(128 + number)


def _prepare():
    """Install the handler of SIGTERM, and replace characters that a stream cannot encode by an ASCII spelling."""
    with contextlib.suppress(ValueError):  # Python sets signal handlers only in the main thread.
        signal.signal(signal.SIGTERM, _end_tidily)
    codecs.register_error("spelled", spelled)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="spelled")


def run(work, options=()):
    """Run `work`, a function without arguments, and return the exit code. `options` are the names of the verb's options."""
    _prepare()
    try:
        with warnings.catch_warnings(), contextlib.redirect_stdout(sys.stdout and Harmless(sys.stdout)):
            for kind in (UserWarning, FutureWarning):
                warnings.simplefilter("always", kind)
            warnings.filterwarnings("always", ".*the old name leaves", DeprecationWarning)
            told: dict[str, None] = {}  # A note that several parts of an input cause is printed once.
            warnings.showwarning = lambda message, *_: _note(as_options(message, options), told)
            contextvars.copy_context().run(work)  # A separate context removes the progress listeners of a failed verb.
            if sys.stdout is not None:
                sys.stdout.flush()
    except KeyboardInterrupt:
        # These verbs fill folders and can be resumed.
        resumed = "; the same command goes on where it was" if "dry_run" in options else ""
        tell(f"interrupted; no incomplete file remains{resumed}")
        return 130
    except Exception as error:  # After a signal, libraries convert the exit to an exception of any type.
        if not _ended:
            return _told(error, options)
    return _ended.pop() if _ended else 0


def _note(text, told):
    """Print a note that is not yet among those `told`."""
    if text not in told:
        told[text] = None
        tell(f"note: {text}")


def _told(error, options):
    """Print the line of an error and return the exit code. An error of an unexpected kind is raised again."""
    if isinstance(error, (ValueError, RuntimeError)):
        tell(as_options(error, options))
    elif isinstance(error, MemoryError) or (isinstance(error, ImportError) and "failed to map segment" in str(error)):
        tell(f"not enough memory{f': {error}' if str(error) else ''}; a smaller --refine or fewer --phases need less")
    elif isinstance(error, OSError):
        _forget_output()
        if error.errno == errno.EPIPE:
            return 141
        place = f" {error.filename}" if error.filename else ""
        tell(f"cannot read or write{place}: {error.strerror or error}")
    else:
        raise error
    return 1


def _forget_output():
    """Discard buffered output, so that the interpreter does not try to write it at exit."""
    if sys.stdout is not None:
        with contextlib.suppress(OSError, ValueError):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, sys.stdout.fileno())
            os.close(nowhere)
