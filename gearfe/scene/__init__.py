"""Scene files (TOML): parameters, damage and assumptions of a study, and printed results of its source.

Read strictly: what is not understood is refused by name. `verdicts` judges printed values against computed ones.
"""
