"""Gyroscopic and centripetal terms in the equations of motion: of a rotating frame (carrier) and of tilting rotors."""

from itertools import product

import numpy as np

from ...core.record import ranged


def frame_terms(dofs, mass, springs, spin, rotors=None):
    """Return the matrices for bodies in a frame that rotates at `spin` about z, and for rotors that tilt.

    With J the rotation by 90 degrees in the plane, the absolute velocity is ``v + spin J r``. The inertia force of a mass is
    ``m (a + 2 spin J v - spin**2 r)``, and a damper to the ground has the force ``c (v + spin J r)``. Springs to the ground
    rotate relative to the frame and must be equal in x and y. The same holds for the tilts p of a body, with its moment of
    inertia across the axis. A moment of inertia ``J_p`` about the axis that rotates at W relative to the ground adds
    ``J_p W (spin p - J p')``.

    Parameters
    ----------
    dofs : tuple of str
    mass : ndarray, shape (n,)
    springs : tuple of Spring
    spin : float
        [rad/s], counter-clockwise.
    rotors : dict of str to float, optional
        Angular velocities of bodies that tilt, against the ground [rad/s].

    Returns
    -------
    gyroscopic, centripetal, circulatory : ndarray, shape (n, n)
        To be added to C, K and K.

    Raises
    ------
    ValueError
        If a body tilts in a frame that turns and its own speed is not given, or if a body is held to the ground otherwise in x
        than in y.

    References
    ----------
    J. Lin, R. G. Parker, J. Vib. Acoust. 121 (1999) 316-321, eq. 1 (their G and K_Omega); the dampers by the same kinematics.
    G. Genta, Dynamics of Rotating Systems (2005), section 2.6: tilting rotors.
    """
    n, bodies, rotors = len(dofs), [name.partition(".")[0] for name in dofs], rotors or {}
    turn, plane, momenta = np.zeros((n, n)), np.zeros(n), np.zeros(n)  # `momenta`: angular momenta of bodies that tilt
    for body, one in product(dict.fromkeys(bodies), ("", "tilt_")):
        at = [dofs.index(name) for axis in "xy" if (name := f"{body}.{one}{axis}") in dofs]
        if spin and len(at) == 1:
            raise ValueError(
                f"spin = {spin} rad/s: {body} moves in one direction of the plane only; it needs the degrees of freedom {one}x "
                f"and {one}y"
            )
        if len(at) == 2:
            turn[at, at[::-1]], plane[at] = (-1.0, 1.0), 1.0
            momenta[at] = _momentum(dofs, mass, body, rotors, spin) if one else 0.0
    unknown = sorted(set(rotors) - {bodies[i] for i in np.flatnonzero(plane)})
    if unknown:
        raise ValueError(
            f"rotors: {unknown[0]} is no body that moves in two directions; there are {', '.join(dict.fromkeys(bodies))}"
        )
    gyroscopic = (2 * spin * mass - momenta)[:, None] * turn
    centripetal = np.diag(spin * momenta - spin**2 * mass * plane)
    if not spin:
        return gyroscopic, centripetal, np.zeros((n, n))
    damping = [_held_by(springs, name, plane, turn, bodies, spin) for name in ("k", "c")][1]
    return gyroscopic, centripetal, spin * damping @ turn


def _held_by(springs, name, plane, turn, bodies, spin):
    """Return the matrix of ground stiffness (`name` k) or damping (c) in the plane, which must be equal in x and y."""
    held = [s for s in springs if len({bodies[i] for i in np.flatnonzero(s.row)}) == 1]
    out = sum((getattr(s, name) * np.outer(s.row * plane, s.row * plane) for s in held), np.zeros(turn.shape))
    uneven = np.abs(out @ turn - turn @ out).max(axis=1)
    if (uneven > 1e-9 * np.abs(out).max()).any():
        which = bodies[int(np.argmax(uneven))]
        raise ValueError(
            f"spin = {spin} rad/s: {which} has different supports in x and y, which would rotate with the frame; use spin = 0"
        )
    return out


def _momentum(dofs, mass, body, rotors, spin):
    """Return the angular momentum of a tilting body about its axis [kg m2/s], or 0 without rotating frame and given speed."""
    if body not in rotors and spin:
        raise ValueError(
            f"spin = {spin} rad/s: {body} tilts, so that its rotation speed matters: give the speed by rotors, or set spin = 0"
        )
    if body not in rotors:
        return 0.0
    ranged(f"rotors: {body}", rotors[body], " rad/s")
    if f"{body}.theta" not in dofs:
        raise ValueError(f"rotors: {body} has no moment of inertia about its axis; give it theta")
    return rotors[body] * mass[dofs.index(f"{body}.theta")]
