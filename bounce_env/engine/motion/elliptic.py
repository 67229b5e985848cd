"""Elliptic integrals and functions of our own, from +, -, *, / and square roots: the same bits on every machine.

The modulus is given by its complement 1 - m, which keeps its digits where m is next to 1 (a pendulum next to the top).
"""

import math

from bounce_env.engine.compile.jit import function, routine
from bounce_env.engine.motion.sincos import sin_cos

_ALIKE = 2.0**-27  # two numbers so near that their arithmetic and geometric mean are the same float
_VANISHING = 1e-140  # a sine that is taken for 0: the square of its inverse would overflow


@routine
def carlson_rf(x: float, y: float, z: float) -> float:
    """Return R_F(x, y, z), the symmetric elliptic integral of the first kind; at most one argument is 0.

    Carlson's duplication (B. C. Carlson, Numer. Math. 33, 1979; DLMF 19.36): each step brings the arguments four times
    nearer to their mean, and the series about it ends when its next term is below rounding.
    """
    mean = (x + y + z) / 3.0
    while max(abs(x - mean), abs(y - mean), abs(z - mean)) > 0.0025 * mean:
        rx, ry, rz = math.sqrt(x), math.sqrt(y), math.sqrt(z)
        shift = rx * (ry + rz) + ry * rz
        x, y, z = 0.25 * (x + shift), 0.25 * (y + shift), 0.25 * (z + shift)
        mean = (x + y + z) / 3.0
    dx, dy = 1.0 - x / mean, 1.0 - y / mean
    dz = -(dx + dy)
    second, third = dx * dy - dz * dz, dx * dy * dz
    series = second * (second / 24.0 - 0.1 - third * (3.0 / 44.0)) + third / 14.0
    return (1.0 + series) / math.sqrt(mean)


@function
def quarter_period(complement: float) -> float:
    """Return K(m), the complete elliptic integral of the first kind, by the arithmetic-geometric mean."""
    a, b = 1.0, math.sqrt(complement)
    while abs(a - b) > _ALIKE * a:
        a, b = 0.5 * (a + b), math.sqrt(a * b)
    return math.pi / (a + b)


@routine
def jacobi_sn_cn_dn(u: float, complement: float) -> tuple[float, float, float]:
    """Return sn, cn and dn of u, by descending Landen transformations (R. Bulirsch, Numer. Math. 7, 1965)."""
    cotangent, scaled, dn, sine = _landen(u, 1.0, math.sqrt(complement))
    if sine == 0.0:
        return 0.0, cotangent, 1.0
    sn = math.copysign(1.0 / math.sqrt(scaled * scaled + 1.0), sine)
    return sn, scaled * sn, dn


@routine
def _landen(u: float, a: float, b: float) -> tuple[float, float, float, float]:
    """Return cs(u) / a, cs(u), dn(u) of the modulus whose mean begins with (a, b), and a sine of the sign of sn(u).

    Where that sine is 0 the first of them is cn(u) instead.
    """
    mean = 0.5 * (a + b)
    if abs(a - b) <= _ALIKE * a:
        s, c = sin_cos(mean * u)
        if abs(s) < _VANISHING:
            return c, 0.0, 1.0, 0.0
        ratio, scaled, dn = c / s, mean * (c / s), 1.0
    else:
        ratio, scaled, dn, s = _landen(u, mean, math.sqrt(a * b))
        if s == 0.0:
            return ratio, 0.0, 1.0, 0.0
    product = ratio * scaled
    scaled = scaled * dn
    dn = (b + product) / (a + product)
    return scaled / a, scaled, dn, s
