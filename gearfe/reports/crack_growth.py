"""The section of a report on the growth of a crack."""

from ..figures.growth_plot import plot_growth
from ..strength.growth import grow_crack, single_crack
from .template import picture_data


def growth_section(found):
    """Return the growth of the crack of a spur pair as page data, or None unless the case is a single crack."""
    chosen = found.scene.pair(found.hurt_pair)
    if found.case not in chosen.damage:
        return None
    case = chosen.case(found.case)
    hurt = single_crack(case)
    if case.pair.gear_1.beta or hurt is None or not hurt[1].through:
        return None
    side, crack = hurt

    def draw(path):
        growth = grow_crack(case, crack, side)
        plot_growth(growth, case.pair.gears[side == "wheel"], path)
        return growth

    return picture_data(draw, f"Growth of the crack: {found.scene.name}, {found.hurt_pair}, {found.case}")
