"""What every package needs: `Case`, `Material`, supports, checks, files, progress and units."""
