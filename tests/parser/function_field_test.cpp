// SPDX-License-Identifier: GPL-3.0-or-later
// Functions as programs: the same values as those of the stack machine, and bounds that hold.
#include <gtest/gtest.h>

#include "core/internal_functions.h"
#include "core/rng.h"
#include "core/shape_field.h"
#include "parser/function_field.h"
#include "tests/parser/scene_text.h"

#include <cmath>

namespace pnr {
namespace {

const FieldProgram& field_of(const Scene& scene) {
    return std::get<Isosurface>(*scene.objects.at(0).shape).data->field;
}

// The function's value by #declare and a call, against the program's.
TEST(FunctionField, GivesTheValuesOfTheFunction) {
    const char* bodies[] = {
        "x*x + y*z - 3/(1 + x^2)",
        "sin(x)*cos(y) + atan2(z, x) + exp(-x*x)",
        "select(x, y, 3, z) + select(y - 0.5, 1, x) + min(x, y, z) - max(x, 2*y)",
        "int(3*x) + mod(5*y, 2) + div(7*z, 2) + floor(x) + ceil(y)",
        "(x < y) + 2*(y >= z) + 4*(x = x) + 8*(x > 0 & y > 0) + 16*(x | z)",
        "abs(x) + sqr(y) + radians(z) + degrees(x) + ln(abs(x) + 1) + log(abs(y) + 2) + sqrt(abs(z))",
        "G(y, x, z) + G(x, x, 1) + sinh(x)*cosh(y) + tanh(z) + asinh(x)",
        "pow(abs(x) + 1, y) + tan(z/4) + asin(x/3) + acos(y/3) - acosh(abs(z) + 1)",
        "sum(I, 1, 4, x*I) + prod(I, 1, 3, I + y*y) + z",
    };
    Rng rng = make_rng(1, Pass::test, 0);
    FieldScratch scratch;
    for (const char* body : bodies) {
        const Vec3 p(2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1);
        const std::string at = std::to_string(p.x) + "," + std::to_string(p.y) + "," + std::to_string(p.z);
        const Vec3 said(std::stod(std::to_string(p.x)), std::stod(std::to_string(p.y)),
                        std::stod(std::to_string(p.z)));
        const Scene scene = scene_of(
            std::string("#declare G = function (a, b, c) { a*b - c + a }\n#declare F = function { ") + body +
            " }\nisosurface { function { F(x, y, z) } pigment { rgb 1 } }\nsphere { <F(" + at +
            "), 0, 0>, 1 pigment { rgb 1 } }");
        ASSERT_EQ(scene.objects.size(), 2u) << body;
        const double expected = std::get<Sphere>(*scene.objects[1].shape).center.x;
        EXPECT_NEAR(field_value(field_of(scene), said, scratch), expected, 1e-12 * (1 + std::abs(expected)))
            << body;
    }
}

TEST(FunctionField, EqualStepsAreDoneOnceAndConstantOnesAtOnce) {
    const Scene scene = scene_of(
        "#declare A = 2;\nisosurface { function { (x*y + 1)*(y*x + 1) - A*3 + 0*z } pigment { rgb 1 } }");
    int products = 0;
    for (const FieldStep& step : field_of(scene).steps) products += step.op == FieldOp::multiply;
    EXPECT_EQ(products, 3); // x y, its square, 0 z
    EXPECT_TRUE(has_enclosures(field_of(scene)));
}

TEST(FunctionField, NoiseIsAsSteepAsItsBoundAtMost) {
    for (const char* generator : {"1", "2", "3"}) {
        const Scene scene = scene_of(std::string("#include \"functions.inc\"\nisosurface { function {"
                                                 " f_noise_generator(x, y, z, ") +
                                     generator + ") } pigment { rgb 1 } }");
        const FieldProgram& field = field_of(scene);
        ASSERT_EQ(field.opaque.size(), 1u);
        const double bound = field.opaque[0].lipschitz;
        ASSERT_TRUE(has_enclosures(field));
        Rng rng = make_rng(2, Pass::test, 0);
        FieldScratch scratch;
        double steepest = 0, low = 1, high = 0;
        for (int i = 0; i < 200000; ++i) {
            const Vec3 p = 40.0 * Vec3(rng.uniform(), rng.uniform(), rng.uniform());
            const double h = 1e-4, f = field_value(field, p, scratch);
            const Vec3 gradient((field_value(field, p + Vec3(h, 0, 0), scratch) - f) / h,
                                (field_value(field, p + Vec3(0, h, 0), scratch) - f) / h,
                                (field_value(field, p + Vec3(0, 0, h), scratch) - f) / h);
            steepest = std::max(steepest, glm::length(gradient));
            low = std::min(low, f), high = std::max(high, f);
        }
        EXPECT_LE(steepest, bound) << generator;
        EXPECT_GT(steepest, 0.3 * bound) << generator; // no looser than it must be
        EXPECT_GE(low, field.opaque[0].low);
        EXPECT_LE(high, field.opaque[0].high);
    }
}

} // namespace
} // namespace pnr
