"""The ``gearfe`` command and its arguments: ``verbs.toml`` lists the verbs with their options and the functions that run them."""

import argparse
import os
import re
import tomllib
from pathlib import Path

from ...stiffness.methods import NAMES, described, having
from . import comparing, exchange, filling, pictures, sets, shell, signals, tools, verbs

# Values inserted into help texts. The suffixes must equal those of gearfe.core.files.
WORDS = {
    "methods": ", ".join(name for name in NAMES if name != "auto"),
    "estimating": having("error"),
    "signals": ".csv, .txt, .mat, .npz, .h5, .wav, .uff, .tdms, .parquet, .lvm",
}


def _ratio(text):
    """Convert a speed ratio such as ``0.305`` or ``29/95`` to a float."""
    from fractions import Fraction

    try:
        return Fraction(text)
    except (ValueError, ZeroDivisionError):
        raise argparse.ArgumentTypeError(f"{text!r} is not a speed ratio: give for example 29/95 or 0.305") from None


class _Parser(argparse.ArgumentParser):
    """Parser whose messages are plain sentences and suggest the nearest verb or option."""

    def parse_known_args(self, args=None, namespace=None):
        """Parse arguments. Each verb rejects unknown options with a separate message."""
        found, rest = super().parse_known_args(args, namespace)
        if rest:
            options = [option for action in self._actions for option in action.option_strings]
            near = _nearest(rest[0].partition("=")[0], options)
            self.error(f"unknown argument {rest[0]!r}{near}; {self.prog} --help lists all")
        return found, rest

    def error(self, message):
        """End with the usage and a message."""
        if choice := re.search(r"invalid choice: '(.*?)' \(choose from (.*)\)$", message, re.DOTALL):
            names = re.findall(r"'(.*?)'", choice[2])
            message = (
                f"{message[: choice.start()]}unknown choice {choice[1]!r}{_nearest(choice[1], names)}; give {', '.join(names)}"
            )
        message = re.sub(r"invalid int value: (.*)", r"\1, but give a whole number", message)
        super().error(re.sub(r"invalid float value: (.*)", r"\1, but give a number", message))


def _nearest(word, names):
    from difflib import get_close_matches

    near = get_close_matches(word, names, 1)
    return f" (nearest: {near[0]})" if near else ""


TYPES = {"int": int, "float": float, "ratio": _ratio}
MODULES = {one.__name__.rpartition(".")[2]: one for one in (comparing, exchange, filling, pictures, sets, signals, tools, verbs)}


def main(argv=None):
    """Run the command line, and return the exit code."""
    # Set before numpy loads: for small matrices, additional threads only wait for each other.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    parser = _Parser(prog="gearfe", description="Compute gear mesh stiffness, transmission error and gearbox vibration.")
    parser.add_argument("--version", action=_Version, help="print the version and exit")
    known = parser.add_subparsers(dest="verb", required=True, metavar="VERB")
    tables = tomllib.loads(Path(__file__).with_name("verbs.toml").read_text(encoding="utf-8"))
    for name, table in tables["verbs"].items():
        _add_verb(known, name, table, tables["shared"])
    known.choices["completion"].set_defaults(verbs=known.choices)
    arguments = parser.parse_args(argv)
    _refuse_nothing(known.choices[arguments.verb], arguments)
    module, _, function = arguments.run.partition(".")

    def work():
        _check_outputs(arguments)
        getattr(MODULES[module], function)(arguments)

    return shell.run(work, [name for name in vars(arguments) if name not in ("verb", "run", "writes", "verbs")])


def _refuse_nothing(parser, arguments):
    """Reject an empty list of values, which argparse of older Pythons returns for ``--force=--``."""
    for action in parser._actions:
        value = getattr(arguments, action.dest, None)
        if action.nargs is None and value != action.default and (value == [] or value == [[]]):
            parser.error(f"argument {'/'.join(action.option_strings)}: expected one argument")


def _check_outputs(arguments):
    """Raise ValueError if the file of an option is not writable, before any computation."""
    given = {option: path for option in arguments.writes if (path := getattr(arguments, option)) is not None}
    if given:
        from ...core.files import check_output

        for option, path in given.items():
            check_output(path, arguments.writes[option])
    if len(set(given.values())) < len(given):
        raise ValueError(f"{' and '.join(f'--{option}' for option in given)} name the same file: give a separate file for each")


class _Version(argparse.Action):
    """Option that prints the version. The version is read only on request, because reading takes time."""

    def __init__(self, option_strings, dest, help=None):
        super().__init__(option_strings, dest, nargs=0, help=help)

    def __call__(self, parser, *_):
        from ...core.extras import installed_version

        print(f"gearfe {installed_version('gearfe')}")
        parser.exit()


def _add_verb(known, name, table, shared):
    """Add a verb of ``verbs.toml`` to the parser. `shared` holds the groups of options that several verbs have."""
    text, form = table["text"], {}
    if table.get("methods"):
        form = {"formatter_class": argparse.RawDescriptionHelpFormatter, "epilog": f"methods:\n{described()}"}
    about = {"help": text, "description": f"{text[0].upper()}{text[1:]}.", "aliases": table.get("aliases", ())}
    verb = known.add_parser(name, **about, **form)
    writes = {}
    verb.set_defaults(run=table["run"], writes=writes)
    groups = [*(shared[group] for group in table.get("shared", ())), table.get("options", {})]
    groups += [shared[group] for group in table.get("further", ())]
    for names, row in [option for group in groups for option in group.items()]:
        options = {"help": row} if isinstance(row, str) else dict(row)
        content = options.pop("writes", None)
        action = _add_option(verb, names.split(), options)
        if content:
            writes[action.dest] = content


def _add_option(verb, flags, options):
    """Add an option to a verb. The last of the `flags` may be the name of its value. Without a value the option is a switch."""
    if len(flags) > 1 and not flags[-1].startswith("-"):
        options["metavar"] = flags.pop()
    elif flags[0].startswith("-") and len(options) == 1:
        options["action"] = "store_true"
    if "type" in options:
        options["type"] = TYPES[options["type"]]
    elif isinstance(options.get("default"), (int, float)):
        options["type"] = type(options["default"])
    if isinstance(options.get("metavar"), list):
        options["metavar"] = tuple(options["metavar"])
    options["help"] = argparse.SUPPRESS if options.pop("hidden", False) else options["help"].format(**WORDS)
    return verb.add_argument(*flags, **options)
