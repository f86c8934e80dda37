"""Many cases at once: sweeps, labelled data sets, surrogates of them, and the store that their results are kept in."""
