"""Notebooks of tutorials: their code is that of the scripts, it runs in Jupyter, and figures are shown."""

import pytest

from tests.remake import NOTEBOOKS, SITE

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")


@pytest.mark.slow
@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_notebook_runs_and_shows_its_figures(name, tmp_path):
    script = SITE / "tutorials" / f"{name}.py"
    book = nbformat.read(script.with_suffix(".ipynb"), as_version=4)
    code = [cell for cell in book.cells if cell.cell_type == "code"]
    text = script.read_text(encoding="utf-8")
    assert all(cell.source in text for cell in code)
    rest = text
    for cell in code:
        rest = rest.replace(cell.source, "", 1)
    assert all(line.startswith("#") for line in rest.split('"""', 2)[2].splitlines() if line), "a cell is missing"
    nbclient.NotebookClient(book, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    outputs = [one for cell in code for one in cell.outputs]
    assert any("image/png" in one.get("data", {}) for one in outputs)
    assert not [one for one in outputs if one.get("name") == "stderr"]
