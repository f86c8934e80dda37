"""Meshes and loads for other programs: CalculiX and Abaqus decks of one gear and of a pair in contact, mesh files."""
