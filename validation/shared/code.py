"""The code that a number was computed with: a hash of the sources and library versions, and the commit."""

import hashlib
import subprocess
from functools import cache
from importlib.metadata import version

from .places import ROOT

PACKAGES = ("geometry", "gearfe")
KINDS = (".py", ".toml", ".csv")
LIBRARIES = ("numpy", "scipy", "scikit-fem", "gmsh", "vtk")


@cache
def _sources():
    """Digest of both packages with their scenes, and of the versions of the libraries."""
    digest = hashlib.sha256(repr([(name, version(name)) for name in LIBRARIES]).encode())
    for package in PACKAGES:
        for file in sorted(one for one in (ROOT / package).rglob("*") if one.suffix in KINDS):
            digest.update(str(file.relative_to(ROOT)).encode() + file.read_bytes())
    return digest.digest()


def fingerprint(test=None):
    """Ten hexadecimal digits of the packages, the libraries and, if given, a test file (a path below the root)."""
    digest = hashlib.sha256(_sources())
    if test is not None:
        digest.update((ROOT / test).read_bytes())
    return digest.hexdigest()[:10]


def commit():
    """Short name of the git commit, with a plus if sources or tests differ from it; empty outside a repository."""
    head = _git("rev-parse", "--short", "HEAD")
    changed = _git("status", "--porcelain", "--", *PACKAGES, "tests")
    return head + ("+" if head and changed else "")


def _git(*words):
    try:
        return subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""
