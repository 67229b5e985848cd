"""Real roots of polynomials over any number type, for the oracle."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

Num = Any  # float or mpmath.mpf
Poly = list[Num]  # coefficients, constant first


def evaluate(poly: Sequence[Num], t: Num) -> Num:
    value = 0 * t
    for coefficient in reversed(poly):
        value = value * t + coefficient
    return value


def derivative(poly: Sequence[Num]) -> Poly:
    return [k * c for k, c in enumerate(poly)][1:]


def add(p: Sequence[Num], q: Sequence[Num]) -> Poly:
    n = max(len(p), len(q))
    return [(p[k] if k < len(p) else 0) + (q[k] if k < len(q) else 0) for k in range(n)]


def multiply(p: Sequence[Num], q: Sequence[Num]) -> Poly:
    product = [0 * p[0]] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            product[i + j] += a * b
    return product


def roots(poly: Sequence[Num], end: Num) -> list[Num]:
    """The real roots in (0, end] at which the polynomial changes its sign, ascending."""
    poly = list(poly)
    while poly and poly[-1] == 0:
        poly.pop()
    if len(poly) < 2:
        return []
    if len(poly) == 2:
        root = -poly[0] / poly[1]
        return [root] if 0 < root <= end else []
    cuts = [0 * end, *roots(derivative(poly), end), end]
    found = []
    for lo, hi in pairwise(cuts):
        root = bracketed_root(poly, lo, hi)
        if root is not None and root > 0:
            found.append(root)
    return found


def bracketed_root(poly: Sequence[Num], lo: Num, hi: Num) -> Num | None:
    """The root in (lo, hi], where the polynomial is monotonic; Newton if it stays inside, else bisection."""
    at_lo, at_hi = evaluate(poly, lo), evaluate(poly, hi)
    if at_hi == 0:
        return hi
    if at_lo == 0 or (at_lo < 0) == (at_hi < 0):
        return None
    slope = derivative(poly)
    t = (lo + hi) / 2
    while lo < t < hi:
        at_t = evaluate(poly, t)
        if at_t == 0:
            return t
        if (at_t < 0) == (at_lo < 0):
            lo = t
        else:
            hi = t
        rate = evaluate(slope, t)
        newton = t - at_t / rate if rate != 0 else lo
        if not lo < newton < hi:
            newton = (lo + hi) / 2
        if newton == t:
            break
        t = newton
    return t
