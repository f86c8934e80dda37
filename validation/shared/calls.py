"""Which functions of the project a process called, and what its modules mean with these functions alone.

`begin` loads modules so that each function that stands in no other one notes, as its first act, that it was called: in any
thread and however it was reached. What was called counts with all that stands in it. Of what was not called a method counts
with decorators, name and signature, since it may hide another one; a function of a module counts so only if it is decorated
or named as a builtin, since one more or less changes nothing for the others. Everything outside functions always counts.
Notes are never taken back, so that what a memory cache gives brings the functions that filled it. A module counts whole if it
was loaded otherwise, as tests are by pytest, or speaks of numba or stands in `COMPILED`, since compiled calls are not seen.
"""

import ast
import builtins
import gc
import hashlib
import sys
import tomllib
from functools import cache
from importlib.machinery import PathFinder, SourceFileLoader
from pathlib import Path

from . import places

WHOLE = "*"
SILENT = {"ctx", "kind", "type_comment"}  # fields of a syntax tree that follow from the rest
NOTE = "__called__"  # a builtin while functions are noted
COMPILED = ("gearfe/dynamics/machine/laws/",)  # whose functions numba compiles although they do not speak of it
called: set[str] = set()  # path below the root, colon, name
noted: set[str] = set()  # modules whose functions are noted, as paths below the root


def below(path):
    """Path below the root; as it is given where it is not there."""
    path = Path(path).resolve()
    return path.relative_to(places.ROOT).as_posix() if path.is_relative_to(places.ROOT) else path.as_posix()


def begin(packages):
    """Note from now on which functions of the modules of these packages are called; of those loaded before, none are."""

    class Loader(SourceFileLoader):
        def get_code(self, fullname):
            text = self.get_data(self.path)
            if b"numba" in text or below(self.path).startswith(COMPILED):
                return super().get_code(fullname)
            tree, name = ast.parse(text), below(self.path)
            for function, node in functions(tree):
                said = ast.parse(f"{NOTE}({f'{name}:{function}'!r})").body[0]
                for part in ast.walk(said):
                    ast.copy_location(part, node.body[0])
                node.body.insert(ast.get_docstring(node, clean=False) is not None, said)
            noted.add(name)
            return compile(tree, self.path, "exec", dont_inherit=True)

    class Finder(PathFinder):
        @classmethod
        def find_spec(cls, fullname, path=None, target=None):
            spec = super().find_spec(fullname, path, target) if fullname.partition(".")[0] in packages else None
            if spec and type(spec.loader) is SourceFileLoader:
                spec.loader = Loader(spec.loader.name, spec.loader.path)
            return spec

    setattr(builtins, NOTE, called.add)
    sys.meta_path.insert(0, Finder)


def functions(tree):
    """(name, node) of each function that stands in no other one, but for generators, which do not run when they are called."""
    todo = [("", tree)]
    while todo:
        inside, node = todo.pop()
        if not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            inside += f"{node.name}." if isinstance(node, ast.ClassDef) else ""
            todo += [(inside, part) for part in ast.iter_child_nodes(node)]
        elif not any(isinstance(part, (ast.Yield, ast.YieldFrom)) for part in ast.walk(node)):
            yield inside + node.name, node


def here():
    """Names of the functions called, by modules whose functions are noted; a module of which numba compiled one counts whole."""
    out = {name: [] for name in noted}
    for one in list(called):
        name, _, function = one.partition(":")
        out[name].append(function)
    if compiler := sys.modules.get("numba.core.dispatcher"):
        compiled = [one for one in gc.get_objects() if isinstance(one, compiler.Dispatcher)]
        out |= {below(one.py_func.__code__.co_filename): [WHOLE] for one in compiled}
    return {name: both(words) for name, words in out.items()}


def both(words):
    """Texts of names of functions as one, sorted, each name once."""
    names = {name for text in words for name in text.split()}
    return WHOLE if WHOLE in names else " ".join(sorted(names))


def folded(names):
    """Names by path as names by folder and stem."""
    out = {}
    for name, words in names.items():
        folder, _, stem = name.rpartition("/")
        out.setdefault(folder, {})[stem.removesuffix(".py")] = words
    return out


@cache
def meaning(path, names=WHOLE):
    """Digest of a file: of a module without docstrings, with these functions; of the values of a TOML file, else of its bytes."""
    if not path.is_file():
        return "missing"
    if names != WHOLE:
        known = _parts(path)
        return _hash("\n".join([known[""], *(f"{name} {known.get(name, 'missing')}" for name in names.split())]).encode())
    text = path.read_bytes()
    if path.suffix == ".py":
        return _spelt(ast.parse(text))
    return _hash(repr(tomllib.loads(text.decode())).encode() if path.suffix == ".toml" else text)


@cache
def _parts(path):
    """Digests of the functions of a module by name, those of one name together; by the empty name of the rest."""
    tree, out, silent = ast.parse(path.read_bytes()), {}, []
    for name, node in functions(tree):
        out[name] = out.get(name, "") + _spelt(node)
        node.body = []
        if not node.decorator_list and not hasattr(builtins, name):
            silent.append(node)
    tree.body = [node for node in tree.body if node not in silent]
    return out | {"": _spelt(tree)}


def _hash(text):
    return hashlib.sha256(text).hexdigest()


def _spelt(node):
    words = []
    _spell(node, words)
    return _hash(" ".join(words).encode())


def _inner(function):
    """What a function calls its own variables, those of functions and lambdas inside it too: numbers by name, all as yet unset.

    Arguments of `def` are left out, since they may be given by name, and names of the module; all are if a class stands inside.
    """
    parts = list(ast.walk(function))
    named = {part.arg for own in parts if isinstance(own, ast.FunctionDef | ast.AsyncFunctionDef) for part in _arguments(own)}
    named |= {name for part in parts if isinstance(part, ast.Global) for name in part.names}
    inner = {part.id for part in parts if isinstance(part, ast.Name) and not isinstance(part.ctx, ast.Load)}
    inner |= {part.arg for own in parts if isinstance(own, ast.Lambda) for part in _arguments(own)}
    return {} if any(isinstance(part, ast.ClassDef) for part in parts) else dict.fromkeys(inner - named)


def _arguments(function):
    return [part for part in ast.walk(function.args) if isinstance(part, ast.arg)]


def _spell(node, words, inner=None):
    """Append a syntax tree, unlike `ast.dump` the same in all versions of Python: without docstrings, inner names as numbers.

    A function's own variables are numbered as they come, so that another word for one changes nothing.
    """
    if inner is None and isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
        inner = _inner(node)
    words.append(type(node).__name__)
    for name in node._fields:
        value = getattr(node, name, None)
        if value is None or value == [] or name in SILENT:
            continue
        words.append(name)
        for one in value if isinstance(value, list) else [value]:
            if isinstance(one, ast.AST):
                if not _says_nothing(node, one):
                    _spell(one, words, inner)
            elif inner and one in inner and isinstance(node, ast.Name | ast.arg | ast.Nonlocal):
                if inner[one] is None:
                    inner[one] = sum(number is not None for number in inner.values())
                words.append(str(inner[one]))
            else:
                words.append(repr(one))
    words.append(")")


def _says_nothing(node, part):
    """Whether a part is a constant that stands alone, as docstrings do, or nothing in an f-string, which Python 3.12.1 adds."""
    if isinstance(part, ast.Expr):
        return isinstance(part.value, ast.Constant)
    return isinstance(node, ast.JoinedStr) and isinstance(part, ast.Constant) and part.value == ""
