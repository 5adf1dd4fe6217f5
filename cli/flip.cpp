// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/flip.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace pnr {

namespace {

using Row = std::vector<double>; // of a kernel: 2 radius + 1 weights

// ---- colour spaces
// ---------------------------------------------------------------------------------------------------

constexpr double white_x = 0.4124 + 0.3576 + 0.1805, white_y = 1, white_z = 0.0193 + 0.1192 + 0.9505;

Vec3 xyz_of(Vec3 rgb) { // over the white point's
    return {(0.4124 * rgb.x + 0.3576 * rgb.y + 0.1805 * rgb.z) / white_x,
            (0.2126 * rgb.x + 0.7152 * rgb.y + 0.0722 * rgb.z) / white_y,
            (0.0193 * rgb.x + 0.1192 * rgb.y + 0.9505 * rgb.z) / white_z};
}

Vec3 rgb_of(Vec3 xyz) {
    const glm::dmat3 columns(0.4124 / white_x, 0.2126, 0.0193 / white_z, 0.3576 / white_x, 0.7152,
                             0.1192 / white_z, 0.1805 / white_x, 0.0722, 0.9505 / white_z);
    return glm::inverse(columns) * xyz;
}

// Linearized CIELAB: achromatic, red-green, yellow-blue [sec. 4.1].
Vec3 opponent_of(Vec3 xyz) { return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)}; }
Vec3 xyz_of_opponent(Vec3 c) {
    const double y = (c.x + 16) / 116;
    return {y + c.y / 500, y, y - c.z / 200};
}

// CIELAB with chroma that counts more where it is light [Hunt; eq. 7].
Vec3 hunt_lab_of(Vec3 rgb) {
    const Vec3 xyz = xyz_of(rgb);
    const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116; };
    const double light = 116 * f(xyz.y) - 16;
    return {light, 0.01 * light * 500 * (f(xyz.x) - f(xyz.y)), 0.01 * light * 200 * (f(xyz.y) - f(xyz.z))};
}

double hyab(Vec3 a, Vec3 b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

// ---- filters
// ---------------------------------------------------------------------------------------------------------

// Along x with one kernel, along y with another; beyond the border the picture is as at the border.
Image<double> filtered(const Image<double>& image, const Row& along_x, const Row& along_y) {
    Image<double> rows(image.width, image.height), result = rows;
    const auto sum = [](const Row& row, int at, int size, const auto& read) {
        const int radius = static_cast<int>(row.size() / 2);
        double total = 0;
        for (int k = -radius; k <= radius; ++k)
            total += row[static_cast<std::size_t>(k + radius)] * read(std::clamp(at + k, 0, size - 1));
        return total;
    };
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            rows.at(x, y) = sum(along_x, x, image.width, [&](int i) { return image.at(i, y); });
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            result.at(x, y) = sum(along_y, y, image.height, [&](int i) { return rows.at(x, i); });
    return result;
}

template <class F>
Row kernel(int radius, const F& weight) {
    Row row;
    for (int i = -radius; i <= radius; ++i) row.push_back(weight(static_cast<double>(i)));
    return row;
}

// The eye's contrast sensitivity in one channel, as a sum of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x
// in degrees [Table 1].
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr Sensitivity sensitivities[3] = {
    {1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};

Image<double> seen_by_eye(const Image<double>& channel, const Sensitivity& s, double ppd) {
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    Image<double> result(channel.width, channel.height, 0.0);
    double whole = 0;
    for (const auto& [a, b] : {std::pair{s.a1, s.b1}, {s.a2, s.b2}}) {
        if (a == 0) continue;
        const double width = b;
        const Row row =
            kernel(radius, [&](double i) { return std::exp(-pi * pi * i * i / (ppd * ppd * width)); });
        const double along = std::accumulate(row.begin(), row.end(), 0.0), share = a * std::sqrt(pi / b);
        const Image<double> part = filtered(channel, row, row);
        for (std::size_t i = 0; i < part.pixels.size(); ++i) result.pixels[i] += share * part.pixels[i];
        whole += share * along * along;
    }
    for (double& value : result.pixels) value /= whole;
    return result;
}

// Positive weights add up to 1, negative ones to -1.
Row balanced(Row row) {
    double positive = 0, negative = 0;
    for (const double w : row) (w > 0 ? positive : negative) += w;
    for (double& w : row) w /= w > 0 ? positive : -negative;
    return row;
}

// Strength of edges and of points about each pixel [sec. 4.2].
struct Features {
    Image<double> edges, points;
};

Features features_of(const Image<double>& lightness, double ppd) {
    const double deviation = 0.5 * 0.082 * ppd;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const auto gauss = [&](double i) { return std::exp(-i * i / (2 * deviation * deviation)); };
    Row smooth = kernel(radius, gauss);
    const double sum = std::accumulate(smooth.begin(), smooth.end(), 0.0);
    for (double& w : smooth) w /= sum;
    const Row edge = balanced(kernel(radius, [&](double i) { return -i * gauss(i); }));
    const Row point =
        balanced(kernel(radius, [&](double i) { return (i * i / (deviation * deviation) - 1) * gauss(i); }));
    const auto strength = [&](const Row& row) {
        Image<double> across = filtered(lightness, row, smooth);
        const Image<double> down = filtered(lightness, smooth, row);
        for (std::size_t i = 0; i < down.pixels.size(); ++i)
            across.pixels[i] = std::hypot(across.pixels[i], down.pixels[i]);
        return across;
    };
    return {strength(edge), strength(point)};
}

// ---- a picture's two streams
// ----------------------------------------------------------------------------------------

struct Stream {
    Image<Vec3> colors; // as the eye resolves them, Hunt-adjusted
    Features features;
};

Stream stream_of(const Image<Color>& linear, double ppd) {
    Image<double> channels[3];
    for (Image<double>& channel : channels) channel = Image<double>(linear.width, linear.height);
    Image<double> lightness = channels[0];
    for (std::size_t i = 0; i < linear.pixels.size(); ++i) {
        const Vec3 shown = glm::clamp(Vec3(linear.pixels[i]), Vec3(0), Vec3(1));
        const Vec3 c = opponent_of(xyz_of(shown));
        for (int k = 0; k < 3; ++k) channels[k].pixels[i] = c[k];
        lightness.pixels[i] = (c.x + 16) / 116;
    }
    for (int k = 0; k < 3; ++k) channels[k] = seen_by_eye(channels[k], sensitivities[k], ppd);
    Stream stream{Image<Vec3>(linear.width, linear.height), features_of(lightness, ppd)};
    for (std::size_t i = 0; i < linear.pixels.size(); ++i) {
        const Vec3 c(channels[0].pixels[i], channels[1].pixels[i], channels[2].pixels[i]);
        stream.colors.pixels[i] = hunt_lab_of(glm::clamp(rgb_of(xyz_of_opponent(c)), Vec3(0), Vec3(1)));
    }
    return stream;
}

constexpr double color_exponent = 0.7, feature_exponent = 0.5;

// Differences up to the share 0.4 of the largest take the range up to 0.95 [eq. 10].
double color_error(Vec3 a, Vec3 b) {
    static const double largest =
        std::pow(hyab(hunt_lab_of({0, 1, 0}), hunt_lab_of({0, 0, 1})), color_exponent);
    constexpr double share = 0.4, range = 0.95;
    const double off = std::pow(hyab(a, b), color_exponent), turn = share * largest;
    return off < turn ? range / turn * off : range + (off - turn) / (largest - turn) * (1 - range);
}

} // namespace

Image<float> flip(const Image<Color>& reference, const Image<Color>& test, double pixels_per_degree) {
    if (reference.width != test.width || reference.height != test.height)
        throw std::invalid_argument("flip: pictures of two sizes");
    const Stream a = stream_of(reference, pixels_per_degree), b = stream_of(test, pixels_per_degree);
    Image<float> result(test.width, test.height);
    for (std::size_t i = 0; i < result.pixels.size(); ++i) {
        const double color = std::min(1.0, color_error(a.colors.pixels[i], b.colors.pixels[i]));
        const double edges = std::abs(a.features.edges.pixels[i] - b.features.edges.pixels[i]);
        const double points = std::abs(a.features.points.pixels[i] - b.features.points.pixels[i]);
        const double feature =
            std::pow(std::min(1.0, std::max(edges, points) / std::sqrt(2.0)), feature_exponent);
        result.pixels[i] = static_cast<float>(std::pow(color, 1 - feature));
    }
    return result;
}

} // namespace pnr
