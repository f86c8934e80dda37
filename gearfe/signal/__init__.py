"""Signals, computed or measured: spectra, orders, envelopes, kurtogram, condition indicators, fault frequencies.

Needs no gear: anything sampled evenly in time can be read and analysed.
"""
