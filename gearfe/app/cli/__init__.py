"""The ``gearfe`` command: one function per verb, no computing.

`arguments` holds the options, `verbs` what is done with them.
"""

from .arguments import main

__all__ = ["main"]
