"""Terms of the field that a reader types into the search box: each occurs on the page that answers it."""

from pathlib import Path

import pytest

pytestmark = pytest.mark.quick
SITE = Path(__file__).parents[2] / "gearfe" / "docs"
TERMS = {
    "index.md": ["time-varying mesh stiffness", "TVMS", "static transmission error", "error estimate"],
    "theory/definitions.md": [
        "line of action",
        "loaded transmission error",
        "peak-to-peak transmission error",
        "Harris map",
        "load sharing ratio",
        "contact ratio",
        "single tooth contact",
        "double tooth contact",
        "corner contact",
    ],
    "theory/closed_forms.md": ["potential energy method", "fillet foundation", "Hertzian contact"],
    "theory/ritz.md": ["Ritz solution", "plane strain"],
    "theory/finite_elements.md": ["scikit-fem", "hexahedra", "CalculiX"],
    "theory/contact.md": ["Hertz's half width", "load sharing", "undercut"],
    "theory/damage.md": ["root crack", "missing tooth", "crack closure", "pit", "spall", "stress intensity factor", "limit line"],
    "theory/supports.md": ["Timoshenko beam", "bearing", "tilt"],
    "theory/planetary_sets.md": ["sun gear", "ring gear", "floating sun", "block-circulant"],
    "theory/dynamics.md": ["backlash", "anti-aliasing", "gyroscopic", "sideband", "fault frequency"],
    "theory/indicators.md": [
        "condition indicator",
        "kurtosis",
        "crest factor",
        "FM0",
        "FM4",
        "NA4",
        "residual signal",
        "time synchronous average",
    ],
    "theory/conventions.md": ["helix angle", "profile shift", "tooth number", "units"],
    "theory/scope.md": ["worm gear", "friction", "plasticity"],
    "glossary.md": [
        "TSA",
        "BPFO",
        "backup ratio",
        "Campbell diagram",
        "mode shape",
        "hunting tooth",
        "envelope spectrum",
        "kurtogram",
        "cepstrum",
    ],
}


@pytest.mark.parametrize(("page", "term"), [(page, term) for page, terms in TERMS.items() for term in terms])
def test_the_page_contains_the_term(page, term):
    text = " ".join((SITE / page).read_text(encoding="utf-8").split())
    assert term.lower() in text.lower()


def test_there_are_sixty_terms():
    assert len({term for terms in TERMS.values() for term in terms}) >= 60
