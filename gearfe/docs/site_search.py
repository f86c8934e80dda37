"""Excerpts in the site search without a web server. The texts are included because browsers do not let scripts read files."""

import html
import json
from pathlib import Path

from docutils import nodes

SCRIPT = """
if (location.protocol === "file:")
  window.fetch = (page) =>
    Promise.resolve(new Response(TEXTS[page.replace(/^(\\.\\/)+/, "").replace(/\\.html$/, "")] || ""));
"""  # Sphinx's search requests pages


def text_page(doctree):
    """Return the texts of a page's sections with their ids, in the form of the search."""
    parts = []
    for section in doctree.findall(nodes.section):
        own = [part.astext() for part in section.children if not isinstance(part, (nodes.section, nodes.raw, nodes.comment))]
        parts.append(f'<div id="{section["ids"][0]}">{html.escape(" ".join(own))} </div>')
    return f'<div role="main">{"".join(parts)}</div>'


def ask(app, pagename, templatename, context, doctree):
    """Load the texts on the search page only."""
    if pagename == "search":
        app.add_js_file("texts.js")


def write(app, exception):
    """Write the texts of all pages as a script."""
    if exception is None and app.builder.format == "html":
        texts = {name: text_page(app.env.get_doctree(name)) for name in sorted(app.env.found_docs)}
        script = f"const TEXTS = {json.dumps(texts)};\n{SCRIPT}"
        (Path(app.outdir) / "_static" / "texts.js").write_text(script, encoding="utf-8")


def setup(app):
    """Tell Sphinx."""
    app.connect("html-page-context", ask)
    app.connect("build-finished", write)
    return {"parallel_read_safe": True}
