"""The pair of `planetary_pitting` by the textbook, a step of stiffness, and files of curves, for tests of models of users."""

import numpy as np

import gearfe as gf

CHOSEN = gf.load_scene("planetary_pitting").pair()
PAIR, WIDTH = CHOSEN.pair, 20e-3  # m
LEAVES = PAIR.eps_alpha % 1.0
PHASE = np.arange(100) / 100
STEP = np.where(PHASE <= LEAVES, 4.0e8, 2.5e8)


def by_textbook(phases, **options):
    return gf.mesh_stiffness(PAIR, CHOSEN.force, CHOSEN.materials, method="textbook", phases=phases, **options)


def write(path, header, x, k, *, separator=",", end="\n"):
    rows = [f"{float(a)!r}{separator}{float(b)!r}" for a, b in zip(x, k, strict=True)]
    path.write_bytes(end.join([*header, *rows, ""]).encode())
    return path
