"""Folders of results that survive a process killed at any moment: what they are (`folder`), rows in them (`shards`)."""
