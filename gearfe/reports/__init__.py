"""One self-contained page of a scene: what was assumed, how wrong the numbers are, what they look like, how they were made.

`page` puts it together, `findings` computes, `figures` and `tooth` draw with plotly; ``page.html`` is the template.
"""
