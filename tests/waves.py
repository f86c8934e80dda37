"""Signals that several tests share."""

import numpy as np


def sine(amplitude, frequency, n, rate=5120.0, phase=0.3):
    return amplitude * np.cos(2 * np.pi * frequency * np.arange(n) / rate + phase)


def noise(n, seed=0):
    return np.random.default_rng(seed).standard_normal(n)
