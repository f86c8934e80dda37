"""Scene files (TOML): parameters, damage and assumptions of a study, and printed results of its source.

Unknown tables and keys are rejected by name. `verdicts` judges printed values against computed ones.
"""
