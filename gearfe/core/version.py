"""Version of gearfe, which `pyproject.toml` reads here, so that it is also known in a checkout without installation."""

VERSION = "0.2.0"
