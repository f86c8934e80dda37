"""Many cases at once: batches, sweeps, labelled data sets, surrogates, error maps, all by one `runner`.

What is resumed stands in folders of a `store`: each file is whole or not there, so that a killed process costs what was under way.
"""
