"""
A pitted tooth, in three dimensions
===================================

Pits as real holes, with the load of the pair along its contact line.
"""

import gearfe as gf

scene = gf.load_scene("planetary_pitting")
shown = gf.render_stress(scene.pair("sun_planet"), "pitted.png", case="severe_rows", title="Three rows of five pits")
print(f"{shown['load']:.0f} N on this tooth at phase {shown['phase']:.2f}")
