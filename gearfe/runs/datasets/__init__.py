"""Simulated vibration windows with labels for machine learning: healthy and faulty, split without leakage, with a data card.

The modules contain the definition (`plan`), types of fault (`faults`), conditions and their split (`conditions`), simulation of
one condition (`windows`) and of all (`make`), reading (`opened`), data card (`card`).
"""
