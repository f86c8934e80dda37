"""Strict TOML tables: known keys of known kinds, and messages that name file, table and key. Units stand in the key names."""

REQUIRED = object()
NUMBER, TEXT, WHOLE, TEXTS = "a number", "a text", "a whole number", "a list of texts"
TWO, TRUTH, TABLES, VALUES = "two numbers", "true or false", "a list of tables", "a table of values by dotted key"
NUMBERS = "a list of numbers"
PLAIN = {TEXT: str, TRUTH: bool, VALUES: dict}
LISTS = {TWO: NUMBER, NUMBERS: NUMBER, TEXTS: TEXT, TABLES: VALUES}  # kind of list: kind of its entries
LARGEST, MOST = 1e30, 2**63  # no length, force or stiffness is larger, in any unit; whole numbers that arrays can hold
SHOWN = 60  # characters of a value in a message


def shown(value):
    """A value for a message: no longer than a line, whatever was given."""
    try:
        text = repr(value)
    except ValueError:  # Python writes no whole numbers of more than 4300 digits
        return "a number of thousands of digits"
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."


def checked(file, where, table, keys, extra=()):
    """Check one table against its keys and fill in defaults."""
    if not isinstance(table, dict):
        raise ValueError(f"{file} [{where}]: expected a table of keys and values, got {shown(table)}")
    out = {}
    for key in table:
        if key not in keys:
            raise ValueError(f"{file} [{where}]: unknown key {key!r}; expected {', '.join((*keys, *extra))}")
    for key, (kind, default) in keys.items():
        if key not in table:
            if default is REQUIRED:
                raise ValueError(f"{file} [{where}]: missing key {key!r}; expected {kind}{_unit(key)}")
            out[key] = default
            continue
        if not _fits(table[key], kind):
            raise ValueError(f"{file} [{where}] {key} = {shown(table[key])}: expected {kind}{_unit(key)}{_limits(table[key])}")
        out[key] = table[key]
    return out


def named_tables(file, kind, tables):
    """Refuse anything but a table of named tables, as ``[flank.NAME]`` writes them."""
    if isinstance(tables, list) and all(isinstance(table, dict) for table in tables):
        raise ValueError(f"{file}: [[{kind}]] is a list of tables, but they have names: write [{kind}.NAME]")
    if not isinstance(tables, dict):
        raise ValueError(f"{file}: {kind} = {shown(tables)}, but give tables with names: [{kind}.NAME]")


def listed_tables(file, kind, tables):
    """Refuse anything but a list of tables, as ``[[crack]]`` writes them."""
    if isinstance(tables, dict):
        raise ValueError(f"{file}: [{kind}] is one table, but there may be several: write [[{kind}]]")
    if not isinstance(tables, list):
        raise ValueError(f"{file}: {kind} = {shown(tables)}, but give a list of tables: [[{kind}]]")


def _unit(key):
    if "_per_" in key:
        over, _, under = key.rpartition("_per_")
        return f" in {over.rpartition('_')[2]}/{under}"
    units = {"mm": "mm", "deg": "degrees", "um": "um", "N": "N", "MPa": "MPa"}
    end = key.rpartition("_")[2]
    return f" in {units[end]}" if end in units and "_" in key else ""


def _limits(value):
    """Part of the message on a value: the largest number allowed, if it is a number that is too large."""
    return f", below {LARGEST:g}" if isinstance(value, (int, float)) and abs(value) >= MOST else ""


def _fits(value, kind):
    if kind in PLAIN:
        return isinstance(value, PLAIN[kind])
    if kind in LISTS:
        return isinstance(value, list) and all(_fits(v, LISTS[kind]) for v in value) and (kind != TWO or len(value) == 2)
    if isinstance(value, bool):
        return False
    if isinstance(value, int):
        return abs(value) < MOST
    return kind == NUMBER and isinstance(value, float) and abs(value) < LARGEST


def known(file, where, key, name, names, kind):
    """Refuse a `name` that is not among `names`."""
    if name not in names:
        raise ValueError(f"{file} [{where}] {key} = {shown(name)}: no such {kind}; there is {', '.join(names)}")


def sides(file, where, row, name, pairs, gears, noun="gear"):
    """Sides of the pair `name` on which the gear of a table stands: it counts in all its pairs, or only in its `pair`."""
    known(file, where, "gear", row["gear"], gears, noun)
    if row["pair"] is not None:
        known(file, where, "pair", row["pair"], pairs, "pair")
        if row["gear"] not in (pairs[row["pair"]]["gear_1"], pairs[row["pair"]]["gear_2"]):
            raise ValueError(f"{file} [{where}] pair = {row['pair']!r} has no gear {row['gear']!r}")
    both = ("pinion", "gear_1"), ("wheel", "gear_2")
    return [side for side, key in both if pairs[name][key] == row["gear"] and row["pair"] in (None, name)]


def placed(file, where, make):
    """Result of `make`, with file and table in front of its ValueErrors."""
    try:
        return make()
    except ValueError as error:
        raise ValueError(f"{file} [{where}]: {error}") from error


def known_path(file, where, key, tables):
    """Value of a dotted key such as ``gear.sun.b_mm`` in nested tables; of a list of tables the values of all, one if alike.

    ValueError if there is no such value; the message names what there is.
    """
    value = tables
    for part in key.split("."):
        if isinstance(value, list) and all(isinstance(entry, dict) and part in entry for entry in value):
            values = [entry[part] for entry in value]
            value = values[0] if all(entry == values[0] for entry in values) else values
        elif isinstance(value, dict) and part in value:
            value = value[part]
        else:
            there = ", ".join(value) if isinstance(value, dict) else "no table"
            raise ValueError(f"{file} [{where}]: no value {key!r} in this scene; at {part!r} there is {there}")
    return value
