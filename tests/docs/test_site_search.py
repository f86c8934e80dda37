"""The search of the built site lists the page that answers a term among its first results."""

import html
import json
import re
import shutil
import subprocess
import sys

import pytest
from test_terms import SITE, TERMS

FIRST = 3  # results that a reader looks at
SCRIPTS = ("documentation_options", "doctools", "sphinx_highlight", "language_data", "searchtools")
RUN = """
const first = (term) => Search._performSearch(...Search._parseQuery(term)).reverse().slice(0, FIRST).map((found) => found[0]);
addEventListener("load", () => {
  document.body.textContent = JSON.stringify(Object.fromEntries(TERMS.map((term) => [term, first(term)])));
});
"""  # the search page shows the same list from its end


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Built site without the pictures of the gallery, which no search reads."""
    for module in ("sphinx", "furo", "sphinx_gallery", "myst_parser"):
        pytest.importorskip(module)
    site = tmp_path_factory.mktemp("site")
    subprocess.run([sys.executable, "-m", "sphinx", "-q", "-D", "plot_gallery=0", str(SITE), str(site)], check=True)
    return site


def results(site, terms):
    """First results of the site's own search in a browser, by term."""
    names = [*(f"_static/{name}.js" for name in SCRIPTS), "searchindex.js"]
    page = site / "terms.html"
    code = f"const FIRST = {FIRST}, TERMS = {json.dumps(terms)};{RUN}"
    scripts = "".join(f'<script src="{name}"></script>' for name in names)
    page.write_text(f'<html data-content_root="./"><body>{scripts}<script>{code}</script></body></html>', encoding="utf-8")
    options = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={site / 'browser'}", "--dump-dom"]
    shown = subprocess.run(["chromium", *options, f"file://{page}"], capture_output=True, text=True, check=True).stdout
    return json.loads(html.unescape(re.search(r"<body>(.*)</body>", shown, re.S)[1]))


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("chromium") is None, reason="no chromium")
def test_each_term_has_its_page_among_the_first_results(built):
    found = results(built, [term for terms in TERMS.values() for term in terms])
    missed = {
        f"{term}: {page}": found[term]
        for page, terms in TERMS.items()
        for term in terms
        if page.removesuffix(".md") not in found[term]
    }
    assert not missed
