"""The validation pages, one module each: computation and text."""
