"""Studies of many cases: what varies (`study`, `samples`), one case (`kinds`), all of them over one machine or many (`run`).

Results stand in a folder of shards (`gearfe.runs.store`) and are read by `runs`; `effects` says what they show.
"""
