"""Tables in which any place is given as something else."""

import copy
import warnings

from gearfe.scene.schema import shown


def places(value, path=()):
    """Paths to every table, list and value, from the outside in; of long lists to the first entries."""
    if path:
        yield path
    if isinstance(value, (dict, list)):
        for key, one in value.items() if isinstance(value, dict) else enumerate(value[:3]):
            yield from places(one, (*path, key))


def replaced(whole, path, value):
    """Tables with another value at a place; only what leads there is copied."""
    out = home = copy.copy(whole)
    for part in path[:-1]:
        home[part] = copy.copy(home[part])
        home = home[part]
    home[path[-1]] = copy.deepcopy(value)
    return out


def judge(attempts, read, names):
    """Judge that each of the tables ``(path, value, tables)`` is read, or refused in one line that begins with one of `names`."""
    wrong, told = [], {"read": 0, "refused": 0}
    for path, value, tables in attempts:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)
            warnings.simplefilter("error", RuntimeWarning)
            try:
                read(tables)
            except Exception as error:
                told["refused"] += 1
                if not isinstance(error, ValueError) or not str(error).startswith(names) or "\n" in str(error):
                    wrong.append(f"{'.'.join(map(str, path))} = {shown(value)}: {type(error).__name__}: {error}")
            else:
                told["read"] += 1
    print(told)
    assert min(told.values()) > 40, told
    assert not wrong, f"{len(wrong)}:\n" + "\n".join(wrong)
