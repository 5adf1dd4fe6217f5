// SPDX-License-Identifier: GPL-3.0-or-later
// Roots against those that fifty decimal digits give.
#include "core/polynomial.h"

#include "core/rng.h"
#include "core/types.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace pnr {
namespace {

using Big = boost::multiprecision::cpp_bin_float_50;

Big value(const std::vector<Big>& c, const Big& x) {
    Big y = 0;
    for (std::size_t i = c.size(); i-- > 0;) y = y * x + c[i];
    return y;
}

// All roots of odd multiplicity in [low, high], by the roots of the derivative; each to about 40 digits.
std::vector<Big> exact_roots(const std::vector<Big>& c, const Big& low, const Big& high) {
    std::vector<Big> roots;
    if (c.size() < 2) return roots;
    std::vector<Big> slope;
    for (std::size_t i = 1; i < c.size(); ++i) slope.push_back(c[i] * static_cast<unsigned>(i));
    std::vector<Big> ends = exact_roots(slope, low, high);
    ends.insert(ends.begin(), low);
    ends.push_back(high);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        Big a = ends[i], b = ends[i + 1];
        const bool sign = value(c, a) < 0;
        if (sign == (value(c, b) < 0)) continue;
        Big x = (a + b) / 2;
        for (int step = 0; step < 3000; ++step) { // Newton's steps while they stay inside, else halving
            const Big y = value(c, x);
            ((y < 0) == sign ? a : b) = x;
            Big next = x - y / value(slope, x);
            if (!(next > a && next < b)) next = (a + b) / 2;
            const Big moved = abs(next - x);
            x = next;
            if (moved <= abs(x) * Big(1e-42)) break;
        }
        roots.push_back(x);
    }
    return roots;
}

std::vector<Big> exact_roots(const std::vector<double>& c, double low, double high) {
    return exact_roots(std::vector<Big>(c.begin(), c.end()), Big(low), Big(high));
}

std::vector<double> with_roots(const std::vector<double>& roots, double leading = 1) {
    std::vector<Big> c{Big(leading)};
    for (const double r : roots) {
        c.insert(c.begin(), Big(0));
        for (std::size_t i = 0; i + 1 < c.size(); ++i) c[i] -= Big(r) * c[i + 1];
    }
    std::vector<double> rounded;
    for (const Big& x : c) rounded.push_back(static_cast<double>(x));
    return rounded;
}

std::vector<double> found_roots(const std::vector<double>& c, double low, double high) {
    std::vector<double> roots(std::max<std::size_t>(1, c.size()));
    roots.resize(static_cast<std::size_t>(real_roots(c, low, high, roots.data())));
    return roots;
}

// How far a root may be off: a rounding, and what twice the precision leaves open about the value, over the
// slope.
double uncertainty(const std::vector<double>& c, const Big& root) {
    Big size = 0, slope = 0;
    for (std::size_t i = 0; i < c.size(); ++i) {
        size += abs(Big(c[i]) * pow(root, static_cast<int>(i)));
        if (i > 0) slope += static_cast<int>(i) * Big(c[i]) * pow(root, static_cast<int>(i) - 1);
    }
    const double n = 2.0 * static_cast<double>(c.size()) * 0x1p-53;
    return 5e-16 * std::abs(static_cast<double>(root)) + static_cast<double>(4 * n * n * size / abs(slope));
}

void expect_exact(const std::vector<double>& c, double low, double high) {
    const std::vector<Big> expected = exact_roots(c, low, high);
    const std::vector<double> found = found_roots(c, low, high);
    ASSERT_EQ(found.size(), expected.size());
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_LE(std::abs(static_cast<double>(Big(found[i]) - expected[i])), uncertainty(c, expected[i]))
            << "root " << i << " of " << found.size() << ", " << expected[i];
}

double number(Rng& rng) { return 2 * rng.uniform() - 1; }

TEST(RealRoots, Known) {
    EXPECT_EQ(found_roots({-6, 11, -6, 1}, -infinity, infinity), (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(found_roots({-6, 11, -6, 1}, 1.5, infinity), (std::vector<double>{2, 3}));
    EXPECT_EQ(found_roots({-6, 11, -6, 1}, -4, 2.5), (std::vector<double>{1, 2}));
    EXPECT_EQ(found_roots({-3, 2}, -10, 10), (std::vector<double>{1.5}));
    EXPECT_EQ(found_roots({1, 0, 1}, -infinity, infinity), (std::vector<double>{}));
    EXPECT_EQ(found_roots({5}, -infinity, infinity), (std::vector<double>{}));
    EXPECT_EQ(found_roots({0, 0, 0}, -1, 1), (std::vector<double>{}));
    EXPECT_EQ(found_roots({0, 1}, -1, 1), (std::vector<double>{0}));
    EXPECT_EQ(found_roots({0, -1, 0, 1}, -infinity, infinity), (std::vector<double>{-1, 0, 1}));
    EXPECT_EQ(found_roots({-1, 0, 0, 0, 1, 0, 0}, -infinity, infinity), (std::vector<double>{-1, 1}))
        << "leading zeros";
    EXPECT_EQ(found_roots({std::nan(""), 1}, -1, 1), (std::vector<double>{}));
    EXPECT_EQ(found_roots(std::vector<double>(37, 1.0), -1, 1), (std::vector<double>{}));
}

TEST(RealRoots, AreThoseOfFiftyDigits) {
    Rng rng = make_rng(1, Pass::test, 0);
    for (int i = 0; i < 150; ++i) {
        std::vector<double> c(static_cast<std::size_t>(2 + i % 14));
        for (double& x : c) x = number(rng) * std::pow(10.0, i % 3 == 0 ? 8 * number(rng) : 0);
        if (i % 5 == 0) c.back() = 0;
        expect_exact(c, -5, 3);
        expect_exact(c, 0, 1);
    }
}

TEST(RealRoots, OnTheWholeLine) {
    Rng rng = make_rng(2, Pass::test, 0);
    for (int i = 0; i < 100; ++i) {
        std::vector<double> roots(static_cast<std::size_t>(1 + i % 8));
        for (double& r : roots) r = number(rng) * std::pow(10.0, 6 * number(rng));
        const std::vector<double> c = with_roots(roots, std::pow(10.0, 20 * number(rng)));
        const std::vector<double> found = found_roots(c, -infinity, infinity);
        const std::vector<Big> expected = exact_roots(c, -1e30, 1e30);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t k = 0; k < found.size(); ++k)
            EXPECT_LE(std::abs(static_cast<double>(Big(found[k]) - expected[k])),
                      uncertainty(c, expected[k]));
    }
}

// Two, three and four roots close together, others elsewhere; their coefficients are rounded, and it is the
// roots of these that count.
TEST(RealRoots, NearMultiple) {
    Rng rng = make_rng(3, Pass::test, 0);
    for (int multiplicity = 2; multiplicity <= 4; ++multiplicity)
        for (int digits = 1; digits <= 12; ++digits)
            for (int i = 0; i < 6; ++i) {
                const double center = number(rng);
                std::vector<double> roots;
                for (int k = 0; k < multiplicity; ++k)
                    roots.push_back(center + std::pow(10.0, -digits) * (k + 0.3 * rng.uniform()));
                for (int k = 0; k < i % 6; ++k) roots.push_back(2 * number(rng));
                SCOPED_TRACE(multiplicity * 100 + digits);
                expect_exact(with_roots(roots), -3, 3);
                expect_exact(with_roots(roots), center, 2); // an end in the middle of them
            }
}

TEST(RealRoots, Stiff) {
    std::vector<double> wilkinson;
    for (int i = 1; i <= 20; ++i) wilkinson.push_back(i);
    expect_exact(with_roots(wilkinson), 0, 25);
    std::vector<double> before{1}, now{0, 1};
    for (int n = 2; n <= 35; ++n) { // Chebyshev
        std::vector<double> next(now.size() + 1, 0);
        for (std::size_t i = 0; i < now.size(); ++i) next[i + 1] += 2 * now[i];
        for (std::size_t i = 0; i < before.size(); ++i) next[i] -= before[i];
        before = std::exchange(now, next);
        if (n % 11 == 2) expect_exact(now, -1.5, 1.5);
    }
    ASSERT_EQ(found_roots(now, -1.5, 1.5).size(), 35u);
    std::vector<double> mignotte(21, 0.0); // x^20 - 2 (1000 x - 1)^2: two roots 1e-30 apart
    mignotte[20] = 1, mignotte[2] = -2e6, mignotte[1] = 4e3, mignotte[0] = -2;
    EXPECT_EQ(found_roots(mignotte, 0.5, 10).size(), exact_roots(mignotte, 0.5, 10).size());
    EXPECT_EQ(found_roots(mignotte, 0, 0.5).size() % 2, 0u);
}

TEST(RealRoots, DoubleRootsComeTwiceOrNotAtAll) {
    for (const double sign : {-1.0, 1.0}) {
        const std::vector<double> found = found_roots({sign, -2 * sign, sign}, -5, 5);
        EXPECT_EQ(found.size() % 2, 0u);
        for (const double root : found) EXPECT_NEAR(root, 1, 1e-7);
    }
    EXPECT_EQ(found_roots({-1, 3, -3, 1}, -5, 5).size() % 2, 1u); // (x - 1)^3
}

TEST(BernsteinRoots, AreThoseOfTheSamePolynomialInPowers) {
    Rng rng = make_rng(4, Pass::test, 0);
    int seen = 0;
    for (int i = 0; i < 1000; ++i) {
        const std::size_t n = 1 + static_cast<std::size_t>(i % 10);
        std::vector<double> b(n + 1), roots(n + 1);
        for (double& x : b) x = number(rng);
        std::vector<Big> c(n + 1, 0); // sum over j of b[j] C(n, j) x^j (1-x)^(n-j)
        for (std::size_t j = 0; j <= n; ++j) {
            std::vector<Big> term{b[j]};
            for (std::size_t k = 0; k < n; ++k) {
                std::vector<Big> next(term.size() + 1, 0);
                for (std::size_t m = 0; m < term.size(); ++m)
                    if (k < j)
                        next[m + 1] += term[m] * static_cast<unsigned>(n - k) / static_cast<unsigned>(k + 1);
                    else
                        next[m] += term[m], next[m + 1] -= term[m];
                term = next;
            }
            for (std::size_t m = 0; m <= n; ++m) c[m] += term[m];
        }
        const std::vector<Big> expected = exact_roots(c, Big(0), Big(1));
        const int count = bernstein_roots(b, roots.data());
        ASSERT_EQ(static_cast<std::size_t>(count), expected.size()) << i;
        seen += count;
        for (std::size_t k = 0; k < expected.size(); ++k) {
            EXPECT_NEAR(roots[k], static_cast<double>(expected[k]), 1e-9);
            EXPECT_NEAR(bernstein_value(b, roots[k]), 0, 1e-14);
        }
    }
    EXPECT_GT(seen, 500);
}

// Neighbouring pieces of a curve share an end: a crossing there is seen by one of them.
TEST(BernsteinRoots, AnEndBelongsToOnePiece) {
    double r[4];
    const double up0[] = {-1, -0.5, 0}, up1[] = {0, 0.5, 1}, down0[] = {1, 0.5, 0}, down1[] = {0, -0.5, -1};
    EXPECT_EQ(bernstein_roots(up0, r) + bernstein_roots(up1, r), 1);
    EXPECT_EQ(bernstein_roots(down0, r) + bernstein_roots(down1, r), 1);
    const double touch0[] = {1, 0.5, 0}, touch1[] = {0, 0.5, 1};
    EXPECT_EQ(bernstein_roots(touch0, r) + bernstein_roots(touch1, r), 0);
}

TEST(BernsteinProduct, IsTheProductOfValues) {
    const double a[] = {1, -2, 3}, b[] = {0.5, 4, -1, 2};
    double r[6];
    bernstein_product(a, b, r);
    for (const double s : {0.0, 0.3, 0.77, 1.0})
        EXPECT_NEAR(bernstein_value(r, s), bernstein_value(a, s) * bernstein_value(b, s), 1e-13);
}

} // namespace
} // namespace pnr
