"""The how-to page on planetary sets, its scene, and scenes made of its text."""

import re
from pathlib import Path

import gearfe as gf

PAGE = (Path(__file__).parents[1] / "gearfe/docs/howto/planetary_set.md").read_text(encoding="utf-8")
SCENE = re.search(r"```toml\n(title.*?)```", PAGE, re.DOTALL)[1]


def loaded(tmp_path, text):
    path = tmp_path / "s.toml"
    path.write_text(text)
    return gf.load_scene(path)
