"""
Stress in a planet and its ring
===============================

An internal mesh of the scene ``planetary_pitting``. The bore of the planet and the outside of the ring are held.
"""

import gearfe as gf

scene = gf.load_scene("planetary_pitting")
shown = gf.render_stress(scene.pair("planet_ring"), "ring.png", title="Planet and ring")
print(f"von Mises stress on the loaded fillets: {shown['root']:.0f} MPa under {shown['load']:.0f} N")
