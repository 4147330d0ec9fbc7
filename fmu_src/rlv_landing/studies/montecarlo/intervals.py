"""Intervals of a rate and of quantiles that hold for any distribution."""

from __future__ import annotations

from math import ceil, sqrt

from scipy.stats import binom, norm


def wilson(successes: int, runs: int, level: float) -> tuple[float, float]:
    """Wilson's interval of a rate of success.

    Args:
        successes: The successes.
        runs: The runs.
        level: Confidence, 0 to 1.

    Returns:
        Its ends, 0 to 1; the whole range without any runs.
    """
    if not runs:
        return 0.0, 1.0
    z = float(norm.ppf(0.5 + 0.5 * level))
    rate, z2 = successes / runs, z * z / runs
    middle = (rate + 0.5 * z2) / (1.0 + z2)
    half = z * sqrt(rate * (1.0 - rate) / runs + 0.25 * z2 / runs) / (1.0 + z2)
    low = 0.0 if successes == 0 else max(middle - half, 0.0)
    return low, 1.0 if successes == runs else min(middle + half, 1.0)


def order_statistics(runs: int, part: float, level: float) -> tuple[int, int | None, int | None]:
    """Which of the sorted values of so many runs are a quantile and its interval.

    Values beyond the interval's ends on either side have a probability of (1 - level)/2 at most,
    whatever the distribution: the number of values below the quantile is binomial.

    Args:
        runs: The values.
        part: The quantile, 0 to 1.
        level: Confidence, 0 to 1.

    Returns:
        Places from 0 of the quantile and of both ends; None for an end that so few values do not
        show.
    """
    beyond = 0.5 * (1.0 - level)
    at = min(max(ceil(part * runs) - 1, 0), runs - 1)
    # the quantile is above the value of rank r with the probability of r values or more below it
    low = int(binom.ppf(beyond, runs, part)) - 1
    high = int(binom.ppf(1.0 - beyond, runs, part))
    return at, low if low >= 0 else None, high if high < runs else None
