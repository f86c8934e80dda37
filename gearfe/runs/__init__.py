"""Many cases: batches, parameter sweeps, labelled data sets, surrogates and error maps, all by one `runner`.

What can be gone on with stands in folders of a `store`: each file is whole or not there, so that a process that is killed
costs only what was under way.
"""
