"""Self-contained report of a scene: assumptions, errors, pictures, and how the numbers were computed.

`page` assembles it, `findings` computes, `figures` and `tooth` draw with plotly; ``page.html`` is the template.
"""
