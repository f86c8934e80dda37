"""Signals, computed or measured: spectra, orders, envelopes, kurtogram, indicators of condition, fault lines.

Needs no gear: anything sampled evenly in time can be read and analysed.
"""
