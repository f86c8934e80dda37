"""Meshes and loads as files for other programs: CalculiX and Abaqus decks of one gear, of a pair in contact, mesh files."""
