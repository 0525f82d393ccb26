"""Write src/integrator/collocation.hpp: Gauss and Radau IIA methods, rounded from 40 digits.

Gauss's method with s stages has its nodes c at the roots of P_s(2c - 1), Radau IIA at those of
P_s - P_(s-1); the matrix a and the weights b integrate polynomials of degree s - 1 exactly (Hairer,
Norsett, Wanner, Solving ODEs I, II.7).

Run:  python tools/make_collocation.py > src/integrator/collocation.hpp    (needs mpmath)
"""

from mpmath import eig, inverse, lu_solve, matrix, mp, mpf, polyroots, taylor

DIGITS = 40
STAGES = (2, 3, 4)

HEADER = """\
// Collocation methods, rounded from {digits} digits.
// Written by tools/make_collocation.py: change that script, not this file.
#pragma once

namespace rolling_ellipse {{
"""

GAUSS = """\

// Gauss-Legendre: nodes c, weights b; a_ij = b_j mu_ij with mu_ij + mu_ji = 1 exactly, which keeps
// the rounded method symplectic (Antonana, Makazaga, Murua, Numer. Algorithms 76 (2017) 861).
// nu_ij b_j extrapolates the polynomial of this step to predict the stages of the next one.
template <int Stages>
struct GaussCoefficients;
"""

RADAU = """\

// Radau IIA with three stages. Its matrix a has inverse(a) = transform . eigenvalues .
// inverse(transform), the eigenvalues being gamma and the pair alpha +- i beta in the real form
// [alpha, -beta; beta, alpha] (Hairer, Wanner, Solving ODEs II, IV.8).
struct RadauCoefficients {"""


def weights(c: list[mpf], end: mpf) -> matrix:
    """Weights w of the nodes: the sum of w_j p(c_j) is the integral of p from 0 to end."""
    powers = range(len(c))
    moments = matrix([end ** (k + 1) / (k + 1) for k in powers])
    return lu_solve(matrix([[node**k for node in c] for k in powers]), moments)


def nodes(degree: int, less: int = 0) -> list[mpf]:
    """Roots c of P_s(2c - 1) - less P_(s-1)(2c - 1), ascending, with s = degree."""

    def polynomial(c: mpf) -> mpf:
        return mp.legendre(degree, 2 * c - 1) - less * mp.legendre(degree - 1, 2 * c - 1)

    coefficients = taylor(polynomial, 0, degree)[::-1]
    return sorted(r.real for r in polyroots(coefficients, maxsteps=200, extraprec=200))


def butcher_matrix(c: list[mpf]) -> matrix:
    return matrix([list(weights(c, end)) for end in c])


def symplectic(mu: matrix) -> list[list[float]]:
    """Round mu so that mu_ij + mu_ji = 1 holds exactly: 1 - x is exact for 1/2 <= x <= 2."""
    rounded = [[float(mu[i, j]) for j in range(mu.cols)] for i in range(mu.rows)]
    for i in range(mu.rows):
        rounded[i][i] = 0.5
        for j in range(mu.cols):
            if rounded[i][j] > 0.5:
                rounded[j][i] = 1 - rounded[i][j]
                assert 1 - rounded[j][i] == rounded[i][j]
    return rounded


def literal(values: list[mpf]) -> str:
    return "{" + ", ".join(repr(float(v)) for v in values) + "}"


def print_vector(name: str, values: list[mpf]) -> None:
    print(f"    static constexpr double {name}[{len(values)}] = {literal(values)};")


def print_matrix(name: str, rows: list[list[mpf]]) -> None:
    print(f"    static constexpr double {name}[{len(rows)}][{len(rows[0])}] = {{")
    for row in rows:
        print(f"        {literal(row)},")
    print("    };")


def print_gauss(s: int) -> None:
    c = nodes(s)
    b = list(weights(c, mpf(1)))
    mu = butcher_matrix(c) * mp.diag([1 / w for w in b])
    nu = [[w / own - 1 for w, own in zip(weights(c, 1 + end), b, strict=True)] for end in c]
    print(f"\ntemplate <>\nstruct GaussCoefficients<{s}> {{")
    print_vector("c", c)
    print_vector("b", b)
    print_matrix("mu", symplectic(mu))
    print_matrix("nu", nu)
    print("};")


def print_radau() -> None:
    s = 3
    c = nodes(s, 1)
    values, vectors = eig(inverse(butcher_matrix(c)))
    real = min(range(s), key=lambda k: abs(values[k].imag))
    lower = min(range(s), key=lambda k: values[k].imag)  # the eigenvalue alpha - i beta
    # eigenvectors are scaled so that the last element is 1
    first = [vectors[i, real].real / vectors[s - 1, real].real for i in range(s)]
    pair = [vectors[i, lower] / vectors[s - 1, lower] for i in range(s)]
    transform = matrix([[first[i], pair[i].real, pair[i].imag] for i in range(s)])
    print(RADAU)
    print_vector("c", c)
    for name, value in {"gamma": values[real].real, "alpha": values[lower].real,
                        "beta": -values[lower].imag}.items():  # fmt: skip
        print(f"    static constexpr double {name} = {float(value)!r};")
    print_matrix("transform", transform.tolist())
    print_matrix("inverse_transform", inverse(transform).tolist())
    print("};")


def main() -> None:
    mp.dps = DIGITS + 10
    print(HEADER.format(digits=DIGITS), end="")
    print(GAUSS, end="")
    for s in STAGES:
        print_gauss(s)
    print_radau()
    print("\n}  // namespace rolling_ellipse")


if __name__ == "__main__":
    main()
