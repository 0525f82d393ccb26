#include "polynomial.hpp"

#include <algorithm>
#include <cmath>

#include "scene.hpp"

namespace rolling_ellipse {
namespace {

// Units of rounding that a computed coefficient may be off, relative to its magnitude: degree-10
// coefficients pass some 60 additions and products, each good to half an ulp, and the parameters
// they start from are rounded themselves.
constexpr double rounding_units = 64;

// Bisections after which an interval of [0, 1] counts as a point.
constexpr int deepest = 48;

struct Halves {
    Bernstein left;
    Bernstein right;
};

Tracked middle(Tracked x, Tracked y) {
    return {0.5 * (x.value + y.value), 0.5 * (x.magnitude + y.magnitude)};
}

// De Casteljau's subdivision at 1/2.
Halves halves(const Bernstein& p) {
    Halves result{p, p};
    auto& work = result.right.coefficients;
    const int n = p.degree;
    for (int level = 0; level < n; ++level) {
        result.left.coefficients[level] = work[0];
        for (int i = 0; i < n - level; ++i) work[i] = middle(work[i], work[i + 1]);
    }
    result.left.coefficients[n] = work[0];
    return result;
}

bool all_positive(const Bernstein& p) {
    return std::all_of(p.coefficients.begin(), p.coefficients.begin() + p.degree + 1,
                       [](Tracked c) { return sign(c) == Sign::positive; });
}

// Nothing but rounding is left.
bool all_undecided(const Bernstein& p) {
    return std::all_of(p.coefficients.begin(), p.coefficients.begin() + p.degree + 1,
                       [](Tracked c) { return sign(c) == Sign::undecided; });
}

Sign sign_below(const Bernstein& p, int depth) {
    if (sign(p.coefficients[0]) == Sign::negative) return Sign::negative;
    if (sign(p.coefficients[p.degree]) == Sign::negative) return Sign::negative;
    if (all_positive(p)) return Sign::positive;
    if (depth == deepest || all_undecided(p)) return Sign::undecided;
    const Halves parts = halves(p);
    const Sign left = sign_below(parts.left, depth + 1);
    if (left != Sign::positive) {
        // Undecided here does not hide a proof of the contrary there.
        return left == Sign::negative || sign_below(parts.right, depth + 1) != Sign::negative
                   ? left
                   : Sign::negative;
    }
    return sign_below(parts.right, depth + 1);
}

int sign_changes(const Bernstein& p) {
    int changes = 0;
    double last = 0.0;
    for (int i = 0; i <= p.degree; ++i) {
        const double value = p.coefficients[i].value;
        if (value == 0.0) continue;
        if (last != 0.0 && (value > 0) != (last > 0)) ++changes;
        last = value;
    }
    return changes;
}

// The one sign change of p in (0, 1), by bisection with Newton's speed (regula falsi, Illinois).
double single_root(const Bernstein& p) {
    double low = 0.0;
    double high = 1.0;
    double f_low = p.coefficients[0].value;
    double f_high = p.coefficients[p.degree].value;
    int kept = 0;
    for (int i = 0; i < 100 && high - low > epsilon * high; ++i) {
        double x =
            i % 4 == 3 ? 0.5 * (low + high) : (low * f_high - high * f_low) / (f_high - f_low);
        if (!(x > low && x < high)) x = 0.5 * (low + high);
        if (x == low || x == high) break;
        const double f = evaluate(p, x).value;
        if (f == 0.0) return x;
        if ((f > 0) == (f_high > 0)) {
            high = x;
            f_high = f;
            if (kept == 1) f_low /= 2;
            kept = 1;
        } else {
            low = x;
            f_low = f;
            if (kept == -1) f_high /= 2;
            kept = -1;
        }
    }
    return 0.5 * (low + high);
}

void collect_roots(const Bernstein& p, double start, double width, int depth,
                   std::vector<double>& roots) {
    const int changes = sign_changes(p);
    if (changes == 0) return;
    const double first = p.coefficients[0].value;
    const double last = p.coefficients[p.degree].value;
    if (changes == 1 && first != 0.0 && last != 0.0) {
        roots.push_back(start + width * single_root(p));
        return;
    }
    if (depth == deepest || all_undecided(p)) {
        roots.push_back(start + 0.5 * width);
        return;
    }
    const Halves parts = halves(p);
    collect_roots(parts.left, start, width / 2, depth + 1, roots);
    if (parts.right.coefficients[0].value == 0.0) roots.push_back(start + 0.5 * width);
    collect_roots(parts.right, start + width / 2, width / 2, depth + 1, roots);
}

}  // namespace

Tracked tracked(double value) { return {value, std::abs(value)}; }

Tracked operator+(Tracked x, Tracked y) { return {x.value + y.value, x.magnitude + y.magnitude}; }

Tracked operator-(Tracked x, Tracked y) { return {x.value - y.value, x.magnitude + y.magnitude}; }

Tracked operator*(Tracked x, Tracked y) { return {x.value * y.value, x.magnitude * y.magnitude}; }

Polynomial polynomial(std::initializer_list<double> coefficients) {
    Polynomial p;
    p.degree = static_cast<int>(coefficients.size()) - 1;
    std::transform(coefficients.begin(), coefficients.end(), p.coefficients.begin(), tracked);
    return p;
}

Polynomial operator+(const Polynomial& p, const Polynomial& q) {
    Polynomial sum;
    sum.degree = std::max(p.degree, q.degree);
    for (int i = 0; i <= sum.degree; ++i) {
        sum.coefficients[i] = p.coefficients[i] + q.coefficients[i];
    }
    return sum;
}

Polynomial operator-(const Polynomial& p, const Polynomial& q) { return p + (-1.0) * q; }

Polynomial operator*(const Polynomial& p, const Polynomial& q) {
    Polynomial product;
    product.degree = p.degree + q.degree;
    for (int i = 0; i <= p.degree; ++i) {
        for (int j = 0; j <= q.degree; ++j) {
            Tracked& target = product.coefficients[i + j];
            target = target + p.coefficients[i] * q.coefficients[j];
        }
    }
    return product;
}

Polynomial operator*(double factor, const Polynomial& p) {
    Polynomial scaled = p;
    for (Tracked& c : scaled.coefficients) c = tracked(factor) * c;
    return scaled;
}

Polynomial derivative(const Polynomial& p) {
    Polynomial slope;
    slope.degree = std::max(p.degree - 1, 0);
    for (int i = 1; i <= p.degree; ++i) {
        slope.coefficients[i - 1] = tracked(i) * p.coefficients[i];
    }
    return slope;
}

// physics (37)
Bernstein bernstein(const Polynomial& p) {
    Bernstein result;
    result.degree = p.degree;
    for (int i = 0; i <= p.degree; ++i) {
        double ratio = 1.0;  // binomial(i, j)/binomial(degree, j)
        for (int j = 0; j <= i; ++j) {
            result.coefficients[i] = result.coefficients[i] + tracked(ratio) * p.coefficients[j];
            ratio *= double(i - j) / double(p.degree - j);
        }
    }
    return result;
}

Tracked evaluate(const Bernstein& p, double x) {
    auto work = p.coefficients;
    for (int level = p.degree; level > 0; --level) {
        for (int i = 0; i < level; ++i) {
            work[i] = tracked(1 - x) * work[i] + tracked(x) * work[i + 1];
        }
    }
    return work[0];
}

Sign sign(Tracked value) {
    const double margin = rounding_units * epsilon * value.magnitude;
    if (value.value > margin) return Sign::positive;
    if (value.value < -margin) return Sign::negative;
    return Sign::undecided;
}

Sign sign_on_unit_interval(const Bernstein& p) { return sign_below(p, 0); }

std::vector<double> roots_on_unit_interval(const Bernstein& p) {
    std::vector<double> roots;
    if (p.coefficients[0].value == 0.0) roots.push_back(0.0);
    collect_roots(p, 0.0, 1.0, 0, roots);
    if (p.coefficients[p.degree].value == 0.0) roots.push_back(1.0);
    std::sort(roots.begin(), roots.end());
    return roots;
}

}  // namespace rolling_ellipse
