"""Text of CalculiX decks for bodies in contact: contact definitions, load step, and a reader of the results."""

from pathlib import Path

from ..core.files import written


def pressing(stiffness, contacts, motions, step="*STEP, INC=200, NLGEOM"):
    """Return deck lines: contacts of surfaces (slave, master) of a stiffness (pressure over overlap) [N/mm^3], and motions."""
    yield f"*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{stiffness:.6e}"
    for surfaces in contacts:
        yield from ("*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE", ", ".join(surfaces))
    yield from (f"{step}\n*STATIC\n1., 1.", "*BOUNDARY", *motions)


def write_lines(path, lines):
    """Write the lines of a deck."""
    with written(path) as name:
        Path(name).write_text("\n".join(lines), encoding="ascii")


def read_rows(path, heading=None):
    """Read three values of every node from a ``.dat`` file of CalculiX.

    Only rows under lines that begin with the word `heading` are read, by default all. RuntimeError if the file is missing or
    has no such rows, because CalculiX ended before it printed them.
    """
    try:
        lines = Path(path).read_text(encoding="ascii").splitlines()
    except FileNotFoundError as error:
        raise RuntimeError(
            f"{path} does not exist: run 'ccx -i NAME'; if CalculiX has run, its output states the reason"
        ) from error
    out, in_part = {}, heading is None
    for row in map(str.split, lines):
        if row and not row[0].isdigit():
            in_part = heading in (None, row[0])
        elif in_part and len(row) == 4:
            out[int(row[0])] = tuple(map(float, row[1:]))
    if not out:
        noun = heading or "values"
        raise RuntimeError(f"{path} holds no {noun}: CalculiX found no equilibrium; see its .sta and .cvg files")
    return out
