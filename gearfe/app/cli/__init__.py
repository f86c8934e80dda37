"""The ``gearfe`` command: one function per verb, without computations.

``verbs.toml`` lists verbs and options, `arguments` parses them, and the other modules hold the functions of the verbs.
"""

from .arguments import main

__all__ = ["main"]
