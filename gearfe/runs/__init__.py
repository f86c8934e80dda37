"""Many cases: batches, parameter sweeps, labelled data sets, surrogates and error maps, all by one `runner`.

Studies that can be resumed are stored in folders (`store`). Each file is complete or absent, so that a killed process loses only
the cases being computed.
"""
