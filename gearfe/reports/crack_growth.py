"""The section of a report on the growth of a crack."""

from ..figures.growth_plot import plot_growth
from ..geometry.damage.crack import Crack
from ..strength.growth import grow_crack
from .template import picture_data


def growth_section(found):
    """Return the growth of the crack of a spur pair as data of the page, or None unless a case has just one such crack."""
    chosen = found.scene.pair(found.hurt_pair)
    if found.case not in chosen.damage:
        return None
    case = chosen.case(found.case)
    hurt = [(side, one) for side, damage in (case.damage or {}).items() for one in damage]
    if case.pair.gear_1.beta or len(hurt) != 1 or not isinstance(hurt[0][1], Crack) or not hurt[0][1].through:
        return None
    side, crack = hurt[0]

    def draw(path):
        growth = grow_crack(case, crack, side)
        plot_growth(growth, (case.pair.gear_1, case.pair.gear_2)[side == "wheel"], path)
        return growth

    return picture_data(draw, f"Growth of the crack: {found.scene.name}, {found.hurt_pair}, {found.case}")
