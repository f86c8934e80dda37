"""Stress of transverse sections: what plane strain says of it, wherever the gear stands."""

import numpy as np
from numpy.testing import assert_allclose

import gearfe as gf
from gearfe.strength.fields import stressed_gears


def test_what_holds_a_section_along_the_width_is_nu_times_the_rest():
    """sigma_zz = nu (sigma_xx + sigma_yy), no shear along the width; von Mises' stress does not change with the axes."""
    chosen = gf.load_scene("planetary_pitting").case()
    for field, material in zip(stressed_gears(chosen, 0.2, 0.5), chosen.materials, strict=True):
        xx, yy, zz, xy, yz, xz = field.stress
        assert np.abs(xx - yy).max() > 10
        assert_allclose(zz, material.nu * (xx + yy), atol=1e-9)
        assert_allclose([yz, xz], 0.0, atol=1e-12)
        whole = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).transpose(2, 0, 1)
        one, two, three = np.linalg.eigvalsh(whole).T  # principal stresses
        assert_allclose(field.mises, np.sqrt(((one - two) ** 2 + (two - three) ** 2 + (three - one) ** 2) / 2), atol=1e-6)
