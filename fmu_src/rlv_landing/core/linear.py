"""Linear equations."""

from __future__ import annotations

from math import fabs

from .memory import Doubles


def solve(a: Doubles, b: Doubles, n: int) -> bool:
    """Solve a x = b by Gauss' elimination with row pivots.

    `a` [n x n], row by row, is used up, `b` [n] becomes x.

    Returns:
        False where the matrix is singular.
    """
    for k in range(n):
        p = _pivot(a, k, n)
        if not fabs(a[p * n + k]) > 0.0:
            return False
        if p != k:
            _swap(a, b, k, p, n)
        for i in range(k + 1, n):
            part = a[i * n + k] / a[k * n + k]
            if part != 0.0:
                for j in range(k + 1, n):
                    a[i * n + j] -= part * a[k * n + j]
                b[i] -= part * b[k]
    for k in range(n - 1, -1, -1):
        value = b[k]
        for j in range(k + 1, n):
            value -= a[k * n + j] * b[j]
        b[k] = value / a[k * n + k]
    return True


def _pivot(a: Doubles, k: int, n: int) -> int:
    """The row from `k` on whose number in column `k` is largest."""
    best = k
    for i in range(k + 1, n):
        if fabs(a[i * n + k]) > fabs(a[best * n + k]):
            best = i
    return best


def _swap(a: Doubles, b: Doubles, k: int, p: int, n: int) -> None:
    """Exchange the rows `k` and `p`."""
    for j in range(n):
        kept = a[k * n + j]
        a[k * n + j] = a[p * n + j]
        a[p * n + j] = kept
    kept = b[k]
    b[k] = b[p]
    b[p] = kept
