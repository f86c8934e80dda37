"""Parameter studies: variables (`study`, `samples`), one case (`kinds`), parallel runs (`run`).

Results are in a folder of shards (`gearfe.runs.store`) and are read by `runs`. `effects` evaluates them.
"""
