"""The pages, one module each: what is computed and how it is told."""
