"""
Stress around a crack, in the section
=====================================

Both gears under the load of the scene. The displacement is enlarged, so that the crack opens.
"""

import gearfe as gf

scene = gf.load_scene("compound_planetary")
shown = gf.render_stress(scene.pair("sun_planet"), "stress.png", case="crack50", title="A crack to the centre-line")
print(f"von Mises stress on the loaded fillets: {shown['root']:.0f} MPa; displacements {shown['enlarged']:.0f} times enlarged")
