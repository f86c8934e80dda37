"""Install wheel and sdist in empty environments of every Python at hand, and try what a newcomer does first, with its seconds."""

import os
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

from gearfe.files import written

from ..shared import machine
from ..shared.places import PAGES, ROOT

PAGE = PAGES / "install.md"
VERSIONS = ("3.11", "3.12", "3.13", "3.14")
BUILT = ("pyproject.toml", "README.md", "gearfe", "geometry")  # what a distribution is made of
TABLE = "stiffness planetary_pitting"
TRIED = (  # what is run in each environment; a name and the arguments of gearfe
    ("version", "--version"),
    ("first curve", TABLE),
    ("first table", "compare planetary_pitting --phases 16"),
    ("vibration", "dynamics planetary_pitting --duration 0.2"),
)
HIDDEN = ("libEGL.so.1", "libOSMesa.so.8")  # VTK loads one of them when it draws without a screen
MESHER = ("libGL.so.1", "libGLU.so.1")  # gmsh does not load without them
WITHOUT = (  # where libraries cannot be loaded: name, libraries, arguments, exit code, words of the answer
    ("stiffness without what draws", HIDDEN, TABLE, 0, "N/um"),
    ("picture of a curve without what draws", HIDDEN, f"{TABLE} --plot k.png", 0, "written: k.png"),
    ("vibration without what draws", HIDDEN, "dynamics planetary_pitting --duration 0.2", 0, "kurtosis"),
    ("stress picture without what draws", HIDDEN, "render planetary_pitting -o s.png", 1, "apt-get install"),
    ("closed form without gmsh's libraries", MESHER, f"{TABLE} --method textbook", 0, "N/um"),
    ("energy model without gmsh's libraries", MESHER, TABLE, 1, "libglu1-mesa"),
)


class Step(NamedTuple):
    """One thing tried: in which environment, what, its seconds, whether it did what it should, and what it said last."""

    python: str
    kind: str
    what: str
    seconds: float
    right: bool
    said: str


def pythons():
    """Executables by version: on the path, else among those of pyenv."""
    out = {}
    for version in VERSIONS:
        own = [shutil.which(f"python{version}"), *sorted((Path.home() / ".pyenv" / "versions").glob(f"{version}.*/bin/python"))]
        for path in filter(None, own):
            done = subprocess.run([path, "-c", "import venv, ensurepip"], capture_output=True, check=False)
            if done.returncode == 0:
                out[version] = str(path)
                break
    return out


def run_in(folder, command, **environment):
    """Seconds, exit code and what was printed of a command, run in `folder` with the user's settings but no path of ours."""
    kept = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "GEARFE_CACHE", "LD_LIBRARY_PATH")}
    kept |= {"PIP_DISABLE_PIP_VERSION_CHECK": "1", "GEARFE_CACHE": str(Path(folder) / "cache"), **environment}
    started = time.perf_counter()
    done = subprocess.run(command, cwd=folder, env=kept, capture_output=True, text=True, check=False)
    return time.perf_counter() - started, done.returncode, (done.stdout + done.stderr).strip()


def build(folder, python):
    """Wheel and sdist of this checkout, by the build tool that ``pyproject.toml`` names."""
    source, tool = Path(folder) / "source", Path(folder) / "tool"
    source.mkdir()
    for name in BUILT:
        place = ROOT / name
        ignored = shutil.ignore_patterns("__pycache__", "_made")
        shutil.copytree(place, source / name, ignore=ignored) if place.is_dir() else shutil.copy(place, source.joinpath(name))
    for command in ([python, "-m", "venv", tool], [tool / "bin/pip", "install", "-q", "hatchling"]):
        _must(run_in(folder, command))
    _must(run_in(source, [tool / "bin/python", "-m", "hatchling", "build", "-d", Path(folder) / "dist"]))
    return {"wheel": next(Path(folder).glob("dist/*.whl")), "sdist": next(Path(folder).glob("dist/*.tar.gz"))}


def _must(result):
    if result[1]:
        raise RuntimeError(f"{result[2][-2000:]}")


def tried(folder, version, python, kind, file, without):
    """Steps of one environment: made empty, `file` installed, what a newcomer runs; its size in MB."""
    place = Path(folder) / f"{version}-{kind}"
    place.mkdir()
    seconds, code, said = run_in(place, [python, "-m", "venv", ".venv"])
    more, code, said = run_in(place, [".venv/bin/pip", "install", "-q", file])
    steps = [Step(version, kind, "install", seconds + more, code == 0, _last(said))]
    for what, words in TRIED:
        seconds, code, said = run_in(place, [".venv/bin/gearfe", *words.split()])
        steps.append(Step(version, kind, what, seconds, code == 0, _last(said)))
    for what, libraries, words, wanted, told in WITHOUT if without else ():
        empty = place / "-".join(libraries)
        empty.mkdir(exist_ok=True)
        for name in libraries:  # found first and no library: as good as missing
            (empty / name).touch()
        options = {"LD_LIBRARY_PATH": str(empty), "DISPLAY": ""}
        seconds, code, said = run_in(place, [".venv/bin/gearfe", *words.split()], **options)
        right = code == wanted and told in said and "Traceback" not in said
        steps.append(Step(version, kind, what, seconds, right, _last(said)))
    size = sum(path.stat().st_size for path in place.glob(".venv/**/*") if path.is_file() and not path.is_symlink())
    shutil.rmtree(place / ".venv")
    return steps, size / 1e6


def _last(said):
    return said.splitlines()[-1] if said else ""


def text(steps, sizes, files):
    """The page."""
    lines = [
        "# Installing, tried",
        "",
        f"Made by `python -m validation install` on {machine.describe()}.",
        "Each row is an environment that was empty before: seconds of the clock (other programs were running), and whether what",
        "was tried did what it should. `install` downloads all dependencies.",
        "",
    ]
    names = list(dict.fromkeys(step.what for step in steps if step.what not in {row[0] for row in WITHOUT}))
    lines += [f"| Python | from | {' | '.join(names)} | size [MB] |", "|---" * (3 + len(names)) + "|"]
    for key in dict.fromkeys((step.python, step.kind) for step in steps):
        own = {step.what: step for step in steps if (step.python, step.kind) == key}
        cells = [f"{own[name].seconds:.1f} s{'' if own[name].right else ' **failed**'}" for name in names]
        lines.append(f"| {key[0]} | {key[1]} | {' | '.join(cells)} | {sizes[key]:.0f} |")
    lines += ["", "Files: " + ", ".join(f"{kind} {file.stat().st_size / 1e6:.2f} MB" for kind, file in files.items()) + "."]
    missing = [version for version in VERSIONS if version not in {step.python for step in steps}]
    lines += [f"Not at hand, so not tried: Python {', '.join(missing)}.", ""] if missing else [""]
    lines += [
        "## Where libraries cannot be loaded",
        "",
        f"Drawing stress without a screen needs one of {', '.join(HIDDEN)}, gmsh needs {', '.join(MESHER)}. They are hidden by empty",
        "files of their names that are found first.",
        "",
        "| tried | as it should | last line printed |",
        "|---|---|---|",
    ]
    apart = [step for step in steps if step.what in {row[0] for row in WITHOUT}]
    lines += [f"| {one.what} | {'yes' if one.right else '**no**'} | {_shortened(one.said)} |" for one in apart]
    return "\n".join(lines) + "\n"


def _shortened(said):
    """Without the folders of this machine."""
    words = [Path(word).name if word.startswith(("/", "(/")) else word for word in said.replace("|", ",").split()]
    return " ".join(words)


def run():
    """Try all, and write the page; raises RuntimeError if something did not do what it should."""
    steps, sizes, found = [], {}, pythons()
    with tempfile.TemporaryDirectory() as folder:
        files = build(folder, next(iter(found.values())))
        for version, python in found.items():
            for kind, file in files.items():
                first = not steps
                done, size = tried(folder, version, python, kind, file, first)
                steps, sizes[version, kind] = steps + done, size
                for step in done:
                    told = "" if step.right else f": {step.said}"
                    print(
                        f"  {version} {kind}, {step.what}: {step.seconds:.1f} s {'done' if step.right else 'FAILED'}{told}",
                        flush=True,
                    )
        with written(PAGE) as name:
            Path(name).write_text(text(steps, sizes, files), encoding="utf-8")
    failed = [step for step in steps if not step.right]
    if failed:
        raise RuntimeError(f"{len(failed)} steps failed: {'; '.join(f'{one.python} {one.kind}, {one.what}' for one in failed)}")
    print(f"wrote {PAGE.name}")
