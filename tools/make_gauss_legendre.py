"""Write src/numerics/gauss_legendre.hpp: Gauss-Legendre nodes and weights, rounded from 40 digits.

Weights computed in double precision (numpy.polynomial.legendre.leggauss) have errors of about
1e-15, more than all other errors of the quadrature. This table is therefore computed with 40
digits.

Run:  python tools/make_gauss_legendre.py > src/numerics/gauss_legendre.hpp    (needs mpmath)
"""

from mpmath import cos, mp, mpf, pi

SIZES = (
    *range(2, 11), 12, 14, 16, 18, 20, 22, 24, 28, 32, 36, 40, 48, 56, 64, 80, 96, 128,
)  # fmt: skip
DIGITS = 40

HEADER = """\
// Gauss-Legendre rules on [-1, 1], correctly rounded from {digits} digits.
// Written by tools/make_gauss_legendre.py: change that script, not this file.
#pragma once

namespace rolling_ellipse {{

// Nodes x >= 0 of a symmetric rule, ascending, and their weights. The rule takes +x and -x with the
// same weight, and a node at 0 only once.
struct GaussRule {{
    int size;
    double nodes[{half}];
    double weights[{half}];
}};

inline constexpr GaussRule gauss_rules[] = {{
"""


def legendre_and_slope(n: int, x: mpf) -> tuple[mpf, mpf]:
    """P_n(x) and P_n'(x) by the three-term recurrence."""
    before, value = mpf(1), x
    for k in range(2, n + 1):
        before, value = value, ((2 * k - 1) * x * value - (k - 1) * before) / k
    return value, n * (x * value - before) / (x * x - 1)


def half_rule(n: int) -> list[tuple[mpf, mpf]]:
    """Pairs (node, weight) for the nodes >= 0, ascending."""
    rule = []
    for k in range(n // 2 + 1, n + 1):
        if 2 * k == n + 1:
            x = mpf(0)
        else:
            x = -cos(pi * (k - mpf(1) / 4) / (n + mpf(1) / 2))
            for _ in range(60):
                value, slope = legendre_and_slope(n, x)
                x -= value / slope
                if abs(value / slope) < mpf(10) ** (-DIGITS + 5):
                    break
        slope = legendre_and_slope(n, x)[1]
        rule.append((x, 2 / ((1 - x * x) * slope * slope)))
    return sorted(rule)


def braced(values: tuple[mpf, ...]) -> str:
    return f"{{{', '.join(repr(float(value)) for value in values)}}}"


def main() -> None:
    mp.dps = DIGITS + 10
    print(HEADER.format(digits=DIGITS, half=max(SIZES) // 2), end="")
    for n in SIZES:
        nodes, weights = zip(*half_rule(n), strict=True)
        print(f"    {{{n}, {braced(nodes)}, {braced(weights)}}},")
    print("};\n\n}  // namespace rolling_ellipse")


if __name__ == "__main__":
    main()
