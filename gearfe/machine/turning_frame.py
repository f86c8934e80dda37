"""What a frame that turns with the carrier adds to the equations of motion: gyroscopic, centripetal and circulatory terms."""

import numpy as np


def frame_terms(dofs, mass, springs, spin):
    """Terms of bodies seen from a frame that turns at `spin` about z.

    A velocity seen in the frame lacks ``spin J r``, J the turn by 90 degrees in the plane, so that a mass has
    ``m (a + 2 spin J v - spin**2 r)``; a damper to the ground feels ``c (v + spin J r)``. Springs to the ground seem to turn, and
    must be alike in x and y.

    Parameters
    ----------
    dofs : tuple of str
    mass : ndarray, shape (n,)
    springs : tuple of Spring
    spin : float
        [rad/s], counter-clockwise.

    Returns
    -------
    gyroscopic, centripetal, circulatory : ndarray, shape (n, n)
        To be added to C, K and K.

    Raises
    ------
    ValueError
        If a body tilts, or is held to the ground otherwise in x than in y.

    References
    ----------
    J. Lin, R. G. Parker, J. Vib. Acoust. 121 (1999) 316-321, eq. 1 (their G and K_Omega); the dampers by the same kinematics.
    """
    n, bodies = len(dofs), [name.partition(".")[0] for name in dofs]
    tilting = [name for name in dofs if name.partition(".")[2].startswith("tilt")]
    if tilting:
        raise ValueError(
            f"spin = {spin} rad/s: gyroscopic moments of bodies that tilt are not modelled ({tilting[0]}); leave it 0"
        )
    turn, plane = np.zeros((n, n)), np.zeros(n)
    for body in dict.fromkeys(bodies):
        x, y = (dofs.index(f"{body}.{axis}") if f"{body}.{axis}" in dofs else None for axis in "xy")
        if (x is None) != (y is None):
            raise ValueError(f"spin = {spin} rad/s: {body} moves in one direction of the plane only; give it x and y")
        if x is not None:
            turn[x, y], turn[y, x], plane[x], plane[y] = -1.0, 1.0, 1.0, 1.0
    held = [s for s in springs if len({bodies[i] for i in np.flatnonzero(s.row)}) == 1]
    for name in ("k", "c"):
        own = sum((getattr(s, name) * np.outer(s.row * plane, s.row * plane) for s in held), np.zeros((n, n)))
        uneven = np.abs(own @ turn - turn @ own).max(axis=1)
        if (uneven > 1e-9 * np.abs(own).max()).any():
            which = bodies[int(np.argmax(uneven))]
            raise ValueError(
                f"spin = {spin} rad/s: {which} is held to the ground otherwise in x than in y, which would turn; leave it 0"
            )
    return 2 * spin * mass[:, None] * turn, -(spin**2) * np.diag(mass * plane), spin * own @ turn
