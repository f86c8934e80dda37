"""Names of types that are used in many annotations."""

import os
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
StrPath: TypeAlias = str | os.PathLike[str]
