"""Data sets of universal files, as `pyuff` writes them."""

import numpy as np


def data_set(name, values, node, rate, start=0.0, **more):
    """A record of one channel in m/s^2 from `start` [s] on."""
    return {
        "type": 58, "binary": 0, "id1": name, "func_type": 1, "rsp_node": node, "rsp_dir": -3, "ref_node": 0, "ref_dir": 0,
        "abscissa_spacing": 1, "abscissa_min": start, "abscissa_inc": 1 / rate, "abscissa_spec_data_type": 17,
        "ordinate_spec_data_type": 12, "orddenom_spec_data_type": 0, "z_axis_spec_data_type": 0,
        "ordinate_axis_units_lab": "m/s^2", "data": values, "x": start + np.arange(values.size) / rate,
    } | more  # fmt: skip
