"""Who carries how much: contacts that can push but not pull share a load.

`plane` for the section, `solid` for contact lines over the width; both read flexibilities and never ask where these came from.
"""
