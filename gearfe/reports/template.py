"""HTML page in one file from its template. The file contains style, plotly and pictures."""

import base64
import os
import tempfile
from importlib import resources
from pathlib import Path
from typing import Any

from ..core.files import check_output, written


def page_maker(path: str | os.PathLike[str], name: str) -> Any:
    """Check that a page can be written. Return a function that fills the template `name` and writes the page.

    ValueError if the page could not be written.
    """
    check_output(path, "page")
    import jinja2
    from plotly.offline import get_plotlyjs

    maker = jinja2.Environment(
        loader=jinja2.PackageLoader("gearfe.reports", ""), autoescape=True, trim_blocks=True, lstrip_blocks=True
    )
    template, style = maker.get_template(name), (resources.files("gearfe.reports") / "page.css").read_text(encoding="utf-8")

    def write(**values: Any) -> Path:
        text = template.render(style=style, plotly=get_plotlyjs(), **values)
        with written(path) as place:
            Path(place).write_text(text, encoding="utf-8")
        return Path(path)

    return write


def picture_data(draw, title):
    """Return the picture drawn by ``draw(path)`` and its result as page data, or the reason for a failure."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "picture.png"
        try:
            told = draw(path=file)
        except (RuntimeError, ValueError) as error:
            return {"missing": f"{title}: {error}"}
        return embedded(file, title) | {"told": told}


def embedded(file, title):
    """Return a picture file as page data."""
    return {"data": base64.b64encode(file.read_bytes()).decode(), "title": title}
