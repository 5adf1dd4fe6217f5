// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/shape_algebraic.h"

#include "core/polynomial.h"
#include "core/shape_impl.h"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace pnr {

// ---- quadrics
// ------------------------------------------------------------------------------------------------------

namespace {

// f = p A p + b p + c with A symmetric.
struct QuadricForm {
    glm::dmat3 a;
    Vec3 b;
    double c;

    double value(Vec3 p) const { return glm::dot(p, a * p) + glm::dot(b, p) + c; }
    Vec3 gradient(Vec3 p) const { return 2.0 * (a * p) + b; }
};

QuadricForm form_of(const Quadric& s) {
    const auto& q = s.q;
    return {glm::dmat3(q[0], q[3] / 2, q[4] / 2, q[3] / 2, q[1], q[5] / 2, q[4] / 2, q[5] / 2, q[2]),
            {q[6], q[7], q[8]},
            q[9]};
}

} // namespace

// Along each axis that carries a curvature of one sign, f = A (p - m)^2 + ... ends where the rest is used up.
// So ellipsoids end on all sides, cylinders about an axis across it.
Bounds bounds_of(const Quadric& s) {
    const QuadricForm f = form_of(s);
    Bounds all{Vec3(-infinity), Vec3(infinity)};
    // The axes that take part; the others' rows must be empty, or there is no end.
    std::vector<int> axes;
    for (int k = 0; k < 3; ++k)
        if (f.a[k] != Vec3(0)) axes.push_back(k);
    for (int k = 0; k < 3; ++k)
        if (f.a[k] == Vec3(0) && f.b[k] != 0) return all;
    const auto n = static_cast<Eigen::Index>(axes.size());
    if (n == 0) return all;
    Eigen::MatrixXd a(n, n);
    Eigen::VectorXd b(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        b(i) = f.b[axes[static_cast<std::size_t>(i)]];
        for (Eigen::Index k = 0; k < n; ++k)
            a(i, k) = f.a[axes[static_cast<std::size_t>(k)]][axes[static_cast<std::size_t>(i)]];
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(a);
    const double least = eigen.eigenvalues().minCoeff(), greatest = eigen.eigenvalues().maxCoeff();
    if (!(least > 1e-12 * greatest || greatest < 1e-12 * least)) return all; // of both signs
    const Eigen::MatrixXd inverse = a.inverse();
    const Eigen::VectorXd middle = -0.5 * (inverse * b);
    const double level = -(f.c - middle.dot(a * middle)); // (p - m) A (p - m) = level
    for (Eigen::Index i = 0; i < n; ++i) {
        const double reach2 = level * inverse(i, i);
        if (!(reach2 >= 0)) return {}; // no real point
        const auto k = static_cast<glm::length_t>(axes[static_cast<std::size_t>(i)]);
        const double slack = 1e-12 * (std::abs(middle(i)) + std::sqrt(reach2));
        all.low[k] = middle(i) - std::sqrt(reach2) - slack;
        all.high[k] = middle(i) + std::sqrt(reach2) + slack;
    }
    return all;
}

void intersect(const Quadric& s, const Ray& ray, HitList& hits) {
    const QuadricForm f = form_of(s);
    const Vec3 d = ray.direction, ad = f.a * d;
    // From the place of the ray that is closest to the origin, where the numbers are small.
    const double shift = -glm::dot(ray.origin, d) / glm::dot(d, d);
    const Vec3 o = ray.origin + shift * d;
    const double c[3] = {f.value(o), 2 * glm::dot(o, ad) + glm::dot(f.b, d), glm::dot(d, ad)};
    double roots[2];
    const int count = real_roots(c, ray.t_min - shift, ray.t_max - shift, roots);
    for (int i = 0; i < count; ++i) {
        const double slope = c[1] + 2 * c[2] * roots[i];
        const double better = roots[i] - f.value(o + roots[i] * d) / slope;
        const double t =
            std::abs(better - roots[i]) < 1e-9 * (std::abs(roots[i]) + std::abs(shift)) ? better : roots[i];
        add_hit(hits, ray, t + shift, f.gradient(o + t * d));
    }
}

bool is_inside(const Quadric& s, Vec3 p) { return form_of(s).value(p) < 0; }

bool has_endless_inside(const Quadric& s) {
    const Bounds box = bounds_of(s);
    if (is_empty(box)) return is_inside(s, Vec3(0));
    Vec3 beyond(0);
    bool ends = false;
    for (int k = 0; k < 3; ++k)
        if (std::isfinite(box.low[k])) beyond[k] = box.low[k] - 1 - std::abs(box.low[k]), ends = true;
    return ends && is_inside(s, beyond);
}

// ---- polynomials
// ---------------------------------------------------------------------------------------------------

// Terms that are not zero, grouped so that x, then y, then z are multiplied in, each as often as needed.
struct PolynomialData {
    int order = 2;
    std::vector<double> coefficients; // as said
    struct Term {
        int x, y, z;
        double c;
    };
    std::vector<Term> terms; // not zero, in the order said
};

int surface_term(int order, int i, int j, int k) {
    const int a = order - i, b = a - j, c = b - k; // what is left of the order after x, y, z
    return a * (a + 1) * (a + 2) / 6 + b * (b + 1) / 2 + c;
}

Shape make_polynomial_surface(int order, std::span<const double> coefficients) {
    auto data = std::make_shared<PolynomialData>();
    data->order = order;
    data->coefficients.assign(coefficients.begin(), coefficients.end());
    for (int i = order; i >= 0; --i)
        for (int j = order - i; j >= 0; --j)
            for (int k = order - i - j; k >= 0; --k)
                if (const double c = coefficients[static_cast<std::size_t>(surface_term(order, i, j, k))];
                    c != 0)
                    data->terms.push_back({i, j, k, c});
    return PolynomialSurface{std::move(data)};
}

namespace {

constexpr std::size_t room = max_surface_order + 1;
using Powers = std::array<std::array<double, 3>, room>; // of a point's coordinates

Powers powers_of(Vec3 p, int order) {
    Powers powers;
    for (std::size_t k = 0; k < 3; ++k) {
        powers[0][k] = 1;
        for (std::size_t i = 1; i <= static_cast<std::size_t>(order); ++i)
            powers[i][k] = powers[i - 1][k] * p[static_cast<glm::length_t>(k)];
    }
    return powers;
}

double power(const Powers& p, int i, std::size_t axis) { return p[static_cast<std::size_t>(i)][axis]; }

struct ValueAndGradient {
    double value = 0;
    double size = 0; // the sum of the terms' sizes: rounding is relative to it
    Vec3 gradient{0};
};

ValueAndGradient evaluate(const PolynomialData& f, Vec3 at) {
    const Powers p = powers_of(at, f.order);
    ValueAndGradient r;
    for (const auto& [i, j, k, c] : f.terms) {
        const double x = power(p, i, 0), y = power(p, j, 1), z = power(p, k, 2);
        r.value += c * x * y * z;
        r.size += std::abs(c * x * y * z);
        if (i > 0) r.gradient.x += c * i * power(p, i - 1, 0) * y * z;
        if (j > 0) r.gradient.y += c * j * x * power(p, j - 1, 1) * z;
        if (k > 0) r.gradient.z += c * k * x * y * power(p, k - 1, 2);
    }
    return r;
}

struct AlongRay {
    int degree = 0;
    std::array<double, room> c{};

    void times(double o, double d) { // times (o + d t)
        c[static_cast<std::size_t>(degree) + 1] = c[static_cast<std::size_t>(degree)] * d;
        for (auto i = static_cast<std::size_t>(degree); i > 0; --i) c[i] = c[i] * o + c[i - 1] * d;
        c[0] *= o;
        ++degree;
    }
    void times(double o, double d, int power) {
        if (degree == 0 && c[0] == 0) return; // nothing yet
        for (int i = 0; i < power; ++i) times(o, d);
    }
    void add(const AlongRay& other) {
        for (std::size_t i = static_cast<std::size_t>(degree) + 1;
             i <= static_cast<std::size_t>(other.degree); ++i)
            c[i] = 0;
        degree = std::max(degree, other.degree);
        for (std::size_t i = 0; i <= static_cast<std::size_t>(other.degree); ++i) c[i] += other.c[i];
    }
};

// f(o + t d) by Horner's scheme in x, its coefficients in y, theirs in z, all polynomials in t. Terms come by
// falling powers.
AlongRay along_ray(const PolynomialData& f, Vec3 o, Vec3 d) {
    AlongRay in_x, in_y, in_z;
    std::size_t n = 0;
    int x_power = f.order;
    while (n < f.terms.size()) {
        const int i = f.terms[n].x;
        in_y = {};
        int y_power = f.terms[n].y;
        while (n < f.terms.size() && f.terms[n].x == i) {
            const int j = f.terms[n].y;
            in_z = {};
            int z_power = f.terms[n].z;
            for (; n < f.terms.size() && f.terms[n].x == i && f.terms[n].y == j; ++n) {
                in_z.times(o.z, d.z, z_power - f.terms[n].z);
                z_power = f.terms[n].z;
                in_z.c[0] += f.terms[n].c;
            }
            in_z.times(o.z, d.z, z_power);
            in_y.times(o.y, d.y, y_power - j);
            y_power = j;
            in_y.add(in_z);
        }
        in_y.times(o.y, d.y, y_power);
        in_x.times(o.x, d.x, x_power - i);
        x_power = i;
        in_x.add(in_y);
    }
    in_x.times(o.x, d.x, x_power);
    return in_x;
}

} // namespace

Bounds bounds_of(const PolynomialSurface&) { return {Vec3(-infinity), Vec3(infinity)}; }

void intersect(const PolynomialSurface& s, const Ray& ray, HitList& hits) {
    const PolynomialData& f = *s.data;
    const double speed = glm::length(ray.direction);
    const Vec3 d = ray.direction / speed;
    const double shift = -glm::dot(ray.origin, d);
    const Vec3 o = ray.origin + shift * d;
    const AlongRay along = along_ray(f, o, d);
    double roots[room];
    const int count = real_roots({along.c.data(), static_cast<std::size_t>(along.degree) + 1},
                                 ray.t_min * speed - shift, ray.t_max * speed - shift, roots);
    for (int i = 0; i < count; ++i) {
        const double t = roots[i];
        const ValueAndGradient at = evaluate(f, o + t * d);
        const double slope = std::abs(glm::dot(at.gradient, d));
        const double better = t - at.value / glm::dot(at.gradient, d);
        const bool helps = std::abs(better - t) < 1e-6 * (1 + std::abs(t));
        const double error =
            slope > 0 ? std::min(16 * 0x1p-53 * at.size / slope, 1e-6 * (1 + std::abs(t))) : 0;
        add_hit(hits, ray, ((helps ? better : t) + shift) / speed, at.gradient, Vec2(0), error);
    }
}

bool is_inside(const PolynomialSurface& s, Vec3 p) { return evaluate(*s.data, p).value < 0; }

} // namespace pnr
