"""Folders of results that survive a killed process: notes and locks (`folder`), rows in Parquet files (`shards`)."""
