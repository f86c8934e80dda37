"""Simulated vibration windows with labels for machine learning: healthy and faulty, split without leakage, with a data card.

`plan` reads what is asked for, `faults` names the kinds of fault, `conditions` spells out and splits them, `windows` simulates
one, `make` all of them, `opened` reads them back and `card` describes them.
"""
