"""XML files of this package as templates."""

from importlib import resources
from typing import Any


def filled(file: str, /, **values: Any) -> str:
    """Return the text of a template with values in it."""
    import jinja2

    text = resources.files(__package__).joinpath(file).read_text(encoding="utf-8")
    template = jinja2.Template(text, autoescape=True, trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True)
    return template.render(values)
