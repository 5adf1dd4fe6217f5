// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry.h"
#include "ray_kernels.h"

namespace pnr::bench {

namespace {

KernelRay kernel_ray(const FloatRay& r) {
    KernelRay ray;
    for (int k = 0; k < 3; ++k) {
        ray.origin[k] = static_cast<double>(r.origin[k]);
        ray.direction[k] = static_cast<double>(r.direction[k]);
    }
    ray.t_min = 0;
    ray.t_max = static_cast<double>(r.t_max);
    return ray;
}

struct Pnr : RayKernel {
    const BvhKernel& kernel;
    Bvh bvh;

    explicit Pnr(const BvhKernel& k) : kernel(k) {}
    void build(std::span<const float> corners) override { bvh = build_bvh(corners, {}, kernel); }
    std::size_t bytes() const override { return bvh.bytes; }
    void closest(std::span<const FloatRay> rays, std::uint32_t* met) const override {
        for (const FloatRay& r : rays) {
            const KernelRay ray = kernel_ray(r);
            KernelHit hit;
            hit.t = ray.t_max;
            pnr::closest(bvh, ray, {}, hit);
            *met++ = hit.primitive;
        }
    }
    void occluded(std::span<const FloatRay> rays, std::uint8_t* blocked) const override {
        for (const FloatRay& r : rays) *blocked++ = pnr::occluded(bvh, kernel_ray(r), {});
    }
};

// As the program's passes ask: rays in double, hits with position, normals and error bound.
struct Scene : RayKernel {
    std::shared_ptr<const Geometry> geometry;

    void build(std::span<const float> corners) override {
        auto mesh = std::make_shared<MeshData>();
        for (std::size_t i = 0; i < corners.size(); i += 3)
            mesh->positions.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
        for (std::uint32_t i = 0; i < corners.size() / 3; i += 3) mesh->triangles.push_back({i, i + 1, i + 2});
        Mesh shape;
        shape.data = std::move(mesh);
        std::vector<GeometryItem> items(1);
        items[0].form = Shape(std::move(shape));
        geometry = make_geometry(std::move(items));
    }
    std::size_t bytes() const override { return static_cast<std::size_t>(geometry_stats(*geometry).bytes); }
    static Ray ray(const FloatRay& r) {
        return {{r.origin[0], r.origin[1], r.origin[2]},
                {r.direction[0], r.direction[1], r.direction[2]},
                0,
                static_cast<double>(r.t_max)};
    }
    void closest(std::span<const FloatRay> rays, std::uint32_t* met) const override {
        for (const FloatRay& r : rays) {
            const auto hit = closest_hit(*geometry, ray(r), RayKind::camera);
            *met++ = hit ? hit->primitive : nothing;
        }
    }
    void occluded(std::span<const FloatRay> rays, std::uint8_t* blocked) const override {
        for (const FloatRay& r : rays) *blocked++ = is_occluded(*geometry, ray(r), RayKind::shadow);
    }
};

} // namespace

std::unique_ptr<RayKernel> make_pnr_scene() {
    auto made = std::make_unique<Scene>();
    made->name = "pnr-scene";
    return made;
}

std::unique_ptr<RayKernel> make_pnr(const BvhKernel& kernel, const std::string& name) {
    auto made = std::make_unique<Pnr>(kernel);
    made->name = name;
    return made;
}

} // namespace pnr::bench
