"""Signals, computed or measured: spectra, orders, envelopes, kurtogram, condition indicators, fault frequencies.

No gear is required: any quantity sampled evenly in time can be read and analysed.
"""
