// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/polynomial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pnr {

namespace {

constexpr int room = max_polynomial_degree + 1;
constexpr int small_room = 8; // nearly all polynomials are that small: copies of theirs are cheap
constexpr double unit_roundoff = 0x1p-53;
template <int Room>
using Coefficients = std::array<double, static_cast<std::size_t>(Room)>;

constexpr auto make_binomials() {
    std::array<std::array<double, room>, room> c{};
    for (std::size_t n = 0; n < room; ++n) {
        c[n][0] = 1;
        for (std::size_t k = 1; k <= n; ++k) c[n][k] = c[n - 1][k - 1] + (k < n ? c[n - 1][k] : 0);
    }
    return c;
}
constexpr auto binomials = make_binomials();
// C(j, i) / C(n, i), by which a coefficient of powers counts in Bernstein form.
constexpr auto make_weights() {
    std::array<std::array<std::array<double, small_room>, small_room>, small_room> w{};
    for (std::size_t n = 0; n < small_room; ++n)
        for (std::size_t j = 0; j <= n; ++j)
            for (std::size_t i = 0; i <= j; ++i) w[n][j][i] = binomials[j][i] / binomials[n][i];
    return w;
}
constexpr auto weights = make_weights();
double binomial(int n, int k) { return binomials[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)]; }

double weight(int n, int j, int i) {
    return n < small_room ? weights[static_cast<std::size_t>(n)][static_cast<std::size_t>(j)]
                                   [static_cast<std::size_t>(i)]
                          : binomial(j, i) / binomial(n, i);
}

// ---- evaluation
// ---------------------------------------------------------------------------------------------------

struct Pair {
    double value, rest; // their sum is exact
};

Pair two_sum(double a, double b) {
    const double s = a + b, z = s - a;
    return {s, (a - (s - z)) + (b - z)};
}

Pair two_product(double a, double b) { // Dekker's, with Veltkamp's split
    constexpr double splitter = 0x1p27 + 1;
    const double p = a * b;
    const double ca = splitter * a, ah = ca - (ca - a), al = a - ah;
    const double cb = splitter * b, bh = cb - (cb - b), bl = b - bh;
    return {p, al * bl - (((p - ah * bh) - al * bh) - ah * bl)};
}

// A polynomial in powers. value() has the sign of the polynomial at x, or is 0 where twice the precision does
// not tell.
template <int Room>
struct Powers {
    static constexpr int capacity = Room;
    int degree = 0;
    Coefficients<Room> c{};

    double value(double x) const {
        double y = c[static_cast<std::size_t>(degree)], bound = std::abs(y) / 2;
        for (int i = degree - 1; i >= 0; --i) {
            y = x * y + c[static_cast<std::size_t>(i)];
            bound = std::abs(x) * bound + std::abs(y);
        }
        return std::abs(y) > 2 * unit_roundoff * bound ? y : compensated(x);
    }
    double compensated(double x) const {
        double y = c[static_cast<std::size_t>(degree)], rest = 0, size = std::abs(y);
        for (int i = degree - 1; i >= 0; --i) {
            const double ci = c[static_cast<std::size_t>(i)];
            const Pair p = two_product(y, x), s = two_sum(p.value, ci);
            y = s.value;
            rest = rest * x + (p.rest + s.rest);
            size = size * std::abs(x) + std::abs(ci);
        }
        const double n = 2 * degree * unit_roundoff, result = y + rest;
        return std::abs(result) > 2 * n * n * size ? result : 0;
    }
    double slope(double x) const {
        double y = 0;
        for (int i = degree; i >= 1; --i) y = x * y + i * c[static_cast<std::size_t>(i)];
        return y;
    }
    Powers derivative() const {
        Powers d;
        d.degree = degree - 1;
        for (int i = 0; i < degree; ++i)
            d.c[static_cast<std::size_t>(i)] = (i + 1) * c[static_cast<std::size_t>(i) + 1];
        return d;
    }
};

// One in Bernstein form on [0, 1].
template <int Room>
struct Bernstein {
    static constexpr int capacity = Room;
    int degree = 0;
    Coefficients<Room> b{}; // times the binomials

    double value(double x) const {
        const double y = 1 - x;
        double sum = b[0], power = 1;
        for (int i = 1; i <= degree; ++i) {
            power *= x;
            sum = sum * y + b[static_cast<std::size_t>(i)] * power;
        }
        return sum;
    }
    double slope_term(int i) const { // n C(n-1, i) times the difference of two neighbours
        return (i + 1) * b[static_cast<std::size_t>(i) + 1] - (degree - i) * b[static_cast<std::size_t>(i)];
    }
    double slope(double x) const {
        const double y = 1 - x;
        double sum = slope_term(0), power = 1;
        for (int i = 1; i < degree; ++i) {
            power *= x;
            sum = sum * y + slope_term(i) * power;
        }
        return sum;
    }
    Bernstein derivative() const {
        Bernstein d;
        d.degree = degree - 1;
        for (int i = 0; i < degree; ++i) d.b[static_cast<std::size_t>(i)] = slope_term(i);
        return d;
    }
};

// ---- isolation
// ----------------------------------------------------------------------------------------------------

// Bounds the number of sign changes in b, whose numbers are only known to `slack`.
template <int Room>
int most_changes(const Coefficients<Room>& b, int degree, double slack) {
    constexpr int never = -Room - 1;
    int ends_plus = never, ends_minus = never;
    for (int i = 0; i <= degree; ++i) {
        const double x = b[static_cast<std::size_t>(i)];
        const int plus = i == 0 ? 0 : std::max(ends_plus, ends_minus + 1);
        const int minus = i == 0 ? 0 : std::max(ends_minus, ends_plus + 1);
        ends_plus = x >= -slack ? plus : never;
        ends_minus = x <= slack ? minus : never;
    }
    return std::max(ends_plus, ends_minus);
}

bool negative(double value) { return value < 0; }

// The root between a and b, where f changes its sign.
template <class F>
double close_in(const F& f, double a, double b, double fa, double fb) {
    const double tiny = 0x1p-100 * std::max(std::abs(a), std::abs(b));
    double x = a + (b - a) * (fa / (fa - fb));
    if (!(x > a && x < b)) x = 0.5 * (a + b);
    for (int step = 0; step < 200; ++step) {
        const double fx = f.value(x);
        if (fx == 0) return x;
        (negative(fx) == negative(fa) ? a : b) = x;
        double next = x - fx / f.slope(x);
        if (!(next > a && next < b)) next = 0.5 * (a + b);
        const double moved = std::abs(next - x);
        x = next;
        if (moved <= 2 * unit_roundoff * std::abs(x) + tiny) break;
    }
    return x;
}

template <class F>
struct Isolation {
    static constexpr int capacity = F::capacity;
    using Numbers = Coefficients<capacity>;
    double* roots;
    int most; // that there is room for: the degree
    int count = 0;

    void bracket(const F& f, double x0, double x1, double f0, double f1) {
        if (negative(f0) == negative(f1) || count == most) return;
        roots[count++] = f0 == 0 ? x0 : f1 == 0 ? x1 : close_in(f, x0, x1, f0, f1);
    }

    // b: f's Bernstein coefficients on [x0, x1], known to `slack`; f0 and f1: its values there.
    void solve(const F& f, const Numbers& b, double slack, double x0, double x1, double f0, double f1,
               int depth) {
        const int n = f.degree;
        const int changes = most_changes<capacity>(b, n, slack);
        if (changes == 0) return;
        if (changes == 1 || n == 1) return bracket(f, x0, x1, f0, f1);
        if (depth == 0) return part_by_derivative(f, b, slack, x0, x1, f0, f1);
        Numbers left{}, right = b; // de Casteljau at the middle
        for (int k = 0; k <= n; ++k) {
            left[static_cast<std::size_t>(k)] = right[0];
            for (int i = 0; i < n - k; ++i)
                right[static_cast<std::size_t>(i)] =
                    0.5 * (right[static_cast<std::size_t>(i)] + right[static_cast<std::size_t>(i) + 1]);
        }
        const double middle = 0.5 * (x0 + x1);
        double value = right[0];
        if (std::abs(value) <= slack) value = f.value(middle);
        solve(f, left, slack, x0, middle, f0, value, depth - 1);
        solve(f, right, slack, middle, x1, value, f1, depth - 1);
    }

    void part_by_derivative(const F& f, const Numbers& b, double slack, double x0, double x1, double f0,
                            double f1) {
        const int n = f.degree;
        const F slope = f.derivative();
        Numbers d{};
        for (int i = 0; i < n; ++i)
            d[static_cast<std::size_t>(i)] =
                n * (b[static_cast<std::size_t>(i) + 1] - b[static_cast<std::size_t>(i)]) / (x1 - x0);
        Numbers turns{};
        Isolation<F> inner{turns.data(), n - 1};
        inner.solve(slope, d, 2 * n * slack / (x1 - x0), x0, x1, slope.value(x0), slope.value(x1), 0);
        double a = x0, fa = f0;
        for (int i = 0; i < inner.count; ++i) {
            const double turn = turns[static_cast<std::size_t>(i)], value = f.value(turn);
            bracket(f, a, turn, fa, value);
            a = turn;
            fa = value;
        }
        bracket(f, a, x1, fa, f1);
    }
};

constexpr int halvings = 5; // more of them, or the derivative sooner, was slower on lathes and quartics

// Roots of p in [0, 1].
template <int Room>
int roots_in_unit(const Powers<Room>& p, double* roots) {
    const int n = p.degree;
    if (n < 1) return 0;
    // All weights are positive, so that the error is a few roundings of the sum of sizes.
    Coefficients<Room> b{};
    double size = 0;
    for (int i = 0; i <= n; ++i) size += std::abs(p.c[static_cast<std::size_t>(i)]);
    for (int j = 0; j <= n; ++j) {
        double sum = 0;
        for (int i = 0; i <= j; ++i) sum += weight(n, j, i) * p.c[static_cast<std::size_t>(i)];
        b[static_cast<std::size_t>(j)] = sum;
    }
    const double slack = 4 * (n + 2) * unit_roundoff * size;
    if (most_changes<Room>(b, n, slack) == 0) return 0;
    Isolation<Powers<Room>> isolation{roots, n};
    isolation.solve(p, b, slack, 0, 1, p.c[0], p.value(1), halvings);
    return isolation.count;
}

// ---- the line, cut into pieces that are each like [0, 1]
// ------------------------------------------------------------------------------------------------------------

// p(2^k x), times a power of two where overflow is near.
template <int Room>
Powers<Room> stretched(const Powers<Room>& p, int k) {
    Powers<Room> q = p;
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (int i = 0; i <= p.degree; ++i)
        if (const double c = std::abs(p.c[static_cast<std::size_t>(i)]); c != 0)
            least = std::min(least, c), most = std::max(most, c);
    if (least > 0x1p-300 && most < 0x1p300 && std::abs(k) * p.degree < 600) {
        const double factor = std::ldexp(1.0, k);
        double power = 1;
        for (int i = 1; i <= p.degree; ++i) q.c[static_cast<std::size_t>(i)] *= power *= factor;
        return q;
    }
    int top = std::numeric_limits<int>::min();
    for (int i = 0; i <= p.degree; ++i)
        if (const double c = p.c[static_cast<std::size_t>(i)]; c != 0)
            top = std::max(top, std::ilogb(c) + i * k);
    for (int i = 0; i <= p.degree; ++i)
        q.c[static_cast<std::size_t>(i)] = std::ldexp(p.c[static_cast<std::size_t>(i)], i * k - top);
    return q;
}

template <int Room>
Powers<Room> reversed(const Powers<Room>& p) {
    Powers<Room> q = p;
    std::reverse(q.c.begin(), q.c.begin() + p.degree + 1);
    return q;
}

// The exponent of a length that parts small roots from large ones: the mean of their sizes.
template <int Room>
int middle_exponent(const Powers<Room>& p) {
    int first = 0;
    while (first < p.degree && p.c[static_cast<std::size_t>(first)] == 0) ++first;
    if (first == p.degree) return 0;
    return (std::ilogb(p.c[static_cast<std::size_t>(first)]) -
            std::ilogb(p.c[static_cast<std::size_t>(p.degree)])) /
           (p.degree - first);
}

// Roots with 0 < x <= high, in increasing order.
template <int Room>
int positive_roots(const Powers<Room>& p, double high, double* roots) {
    constexpr int far = 60; // a range so long that it is better cut in two
    const int middle = middle_exponent(p);
    const int end = std::isfinite(high) ? std::ilogb(high) + 1 : std::numeric_limits<int>::max();
    const bool cut = end > middle + far;
    const int k = cut ? middle : end;
    const Powers<Room> near = stretched(p, k);
    int count = roots_in_unit(near, roots);
    for (int i = 0; i < count; ++i) roots[i] = std::ldexp(roots[i], k);
    if (cut) { // beyond: x = 2^k / u
        Coefficients<Room> inverse{};
        const int more = roots_in_unit(reversed(near), inverse.data());
        for (int i = more - 1; i >= 0; --i) {
            const double x = 1 / inverse[static_cast<std::size_t>(i)],
                         better = x - near.value(x) / near.slope(x);
            if (std::isfinite(x))
                roots[count++] = std::ldexp(std::abs(better - x) < 1e-14 * x ? better : x, k);
        }
    }
    while (count > 0 && roots[count - 1] > high) --count;
    return count;
}

// c[0] + c[1] t + c[2] t^2 with its discriminant right to a rounding [Kahan 2004]. False where that
// overflows.
bool quadratic_roots(std::span<const double> c, double low, double high, double* roots, int& count) {
    const Pair square = two_product(c[1], c[1]), product = two_product(4 * c[2], c[0]);
    const double discriminant = (square.value - product.value) + (square.rest - product.rest);
    if (!(std::abs(discriminant) < 0x1p900) || !(square.value > 0x1p-900 || square.value == 0)) return false;
    count = 0;
    if (!(discriminant > 0)) return true;
    const double q = -0.5 * (c[1] + std::copysign(std::sqrt(discriminant), c[1]));
    double a = q / c[2], b = c[0] / q;
    if (a > b) std::swap(a, b);
    for (const double x : {a, b})
        if (x >= low && x <= high) roots[count++] = x;
    return true;
}

template <int Room>
int real_roots_in(std::span<const double> c, double low, double high, double* roots) {
    Powers<Room> p;
    p.degree = static_cast<int>(c.size()) - 1;
    std::copy(c.begin(), c.end(), p.c.begin());
    int count = 0;
    Coefficients<Room> found{};
    if (low < 0) {
        Powers<Room> mirrored = p;
        for (std::size_t i = 1; i < c.size(); i += 2) mirrored.c[i] = -mirrored.c[i];
        const int below = positive_roots(mirrored, -low, found.data());
        for (int i = below - 1; i >= 0; --i)
            if (const double x = -found[static_cast<std::size_t>(i)]; x <= high) roots[count++] = x;
    }
    if (high > 0) {
        const int above = positive_roots(p, high, found.data());
        for (int i = 0; i < above; ++i)
            if (const double x = found[static_cast<std::size_t>(i)]; x >= low) roots[count++] = x;
    }
    return count;
}

template <int Room>
int bernstein_roots_in(std::span<const double> b, double* roots) {
    const int n = static_cast<int>(b.size()) - 1;
    Bernstein<Room> f;
    f.degree = n;
    Coefficients<Room> plain{};
    for (int i = 0; i <= n; ++i) {
        plain[static_cast<std::size_t>(i)] = b[static_cast<std::size_t>(i)];
        f.b[static_cast<std::size_t>(i)] = binomial(n, i) * b[static_cast<std::size_t>(i)];
    }
    Isolation<Bernstein<Room>> isolation{roots, n};
    isolation.solve(f, plain, 0, 0, 1, b.front(), b.back(), halvings);
    return isolation.count;
}

} // namespace

int real_roots(std::span<const double> c, double low, double high, double* roots) {
    if (c.size() > room || !(low <= high)) return 0;
    while (!c.empty() && c.back() == 0) c = c.first(c.size() - 1);
    if (c.size() < 2 || !std::all_of(c.begin(), c.end(), [](double x) { return std::isfinite(x); })) return 0;
    int count = 0;
    if (c.size() == 3 && quadratic_roots(c, low, high, roots, count)) return count;
    return c.size() <= small_room ? real_roots_in<small_room>(c, low, high, roots)
                                  : real_roots_in<room>(c, low, high, roots);
}

int bernstein_roots(std::span<const double> b, double* roots) {
    const int n = static_cast<int>(b.size()) - 1;
    if (n < 1 || n > max_polynomial_degree) return 0;
    const bool all_one_side = std::all_of(b.begin(), b.end(), [](double x) { return x > 0; }) ||
                              std::all_of(b.begin(), b.end(), [](double x) { return x < 0; });
    if (all_one_side) return 0;
    return n < small_room ? bernstein_roots_in<small_room>(b, roots) : bernstein_roots_in<room>(b, roots);
}

double bernstein_value(std::span<const double> b, double s) {
    const int n = static_cast<int>(b.size()) - 1;
    double sum = b[0], power = 1;
    for (int i = 1; i <= n; ++i) {
        power *= s;
        sum = sum * (1 - s) + binomial(n, i) * b[static_cast<std::size_t>(i)] * power;
    }
    return sum;
}

void bernstein_product(std::span<const double> a, std::span<const double> b, double* r) {
    const int n = static_cast<int>(a.size()) - 1, m = static_cast<int>(b.size()) - 1;
    for (int k = 0; k <= n + m; ++k) {
        double sum = 0;
        for (int i = std::max(0, k - m); i <= std::min(n, k); ++i)
            sum += binomial(n, i) * binomial(m, k - i) * a[static_cast<std::size_t>(i)] *
                   b[static_cast<std::size_t>(k - i)];
        r[k] = sum / binomial(n + m, k);
    }
}

} // namespace pnr
