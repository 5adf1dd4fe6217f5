// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry.h"

#include <gtest/gtest.h>

namespace pnr {
namespace {

// The corners' texture coordinates go round the patch, and are mixed between (compared with POV-Ray 3.7's
// picture of one).
TEST(Tessellate, MixesTheCornersTextureCoordinates) {
    BicubicPatch patch;
    for (std::size_t i = 0; i < 16; ++i) patch.points[i] = Vec3(i % 4, i / 4, 0);
    patch.u_steps = patch.v_steps = 3;
    patch.corner_uv = {Vec2(0.1, 0.2), Vec2(0.7, 0.3), Vec2(0.9, 0.8), Vec2(0.2, 0.6)};
    const MeshData mesh = tessellate(patch);
    ASSERT_EQ(mesh.uvs.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const double u = static_cast<double>(mesh.positions[i].x) / 3,
                     v = static_cast<double>(mesh.positions[i].y) / 3;
        const Vec2 expected = glm::mix(glm::mix(patch.corner_uv[0], patch.corner_uv[1], u),
                                       glm::mix(patch.corner_uv[3], patch.corner_uv[2], u), v);
        EXPECT_LT(glm::distance(Vec2(mesh.uvs[i]), expected), 1e-6);
    }
}

} // namespace
} // namespace pnr
