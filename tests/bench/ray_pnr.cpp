// SPDX-License-Identifier: GPL-3.0-or-later
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

} // namespace

std::unique_ptr<RayKernel> make_pnr(const BvhKernel& kernel, const std::string& name) {
    auto made = std::make_unique<Pnr>(kernel);
    made->name = name;
    return made;
}

} // namespace pnr::bench
