"""Common parts of all packages: `Case`, `Material`, supports, checks, files, progress and units."""
