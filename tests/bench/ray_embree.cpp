// SPDX-License-Identifier: GPL-3.0-or-later
#include "ray_kernels.h"

#include <embree3/rtcore.h>

#include <cmath>
#include <cstring>

namespace pnr::bench {

namespace {

bool count_bytes(void* total, ssize_t bytes, bool) {
    *static_cast<ssize_t*>(total) += bytes;
    return true;
}

RTCRay rtc_ray(const FloatRay& r) {
    RTCRay ray;
    ray.org_x = r.origin[0], ray.org_y = r.origin[1], ray.org_z = r.origin[2];
    ray.dir_x = r.direction[0], ray.dir_y = r.direction[1], ray.dir_z = r.direction[2];
    ray.tnear = 0, ray.tfar = r.t_max;
    ray.time = 0, ray.mask = ~0u, ray.id = 0, ray.flags = 0;
    return ray;
}

struct Embree : RayKernel {
    bool robust;
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    ssize_t allocated = 0;

    explicit Embree(bool r) : robust(r), device(rtcNewDevice("threads=1")) {
        rtcSetDeviceMemoryMonitorFunction(device, count_bytes, &allocated);
    }
    ~Embree() override {
        if (scene) rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }
    void build(std::span<const float> corners) override {
        if (scene) rtcReleaseScene(scene);
        scene = rtcNewScene(device);
        if (robust) rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        const std::size_t count = corners.size() / 3;
        void* vertices =
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, count);
        std::memcpy(vertices, corners.data(), corners.size() * 4);
        auto* indices = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, count / 3));
        for (std::size_t i = 0; i < count; ++i) indices[i] = static_cast<std::uint32_t>(i);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
    }
    std::size_t bytes() const override { return static_cast<std::size_t>(allocated); }
    void closest(std::span<const FloatRay> rays, std::uint32_t* met) const override {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        for (const FloatRay& r : rays) {
            RTCRayHit query;
            query.ray = rtc_ray(r);
            query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            rtcIntersect1(scene, &context, &query);
            *met++ = query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? nothing : query.hit.primID;
        }
    }
    void occluded(std::span<const FloatRay> rays, std::uint8_t* blocked) const override {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        for (const FloatRay& r : rays) {
            RTCRay ray = rtc_ray(r);
            rtcOccluded1(scene, &context, &ray);
            *blocked++ = ray.tfar < 0;
        }
    }
};

} // namespace

std::unique_ptr<RayKernel> make_embree(bool robust) {
    auto made = std::make_unique<Embree>(robust);
    made->name = robust ? "embree-robust" : "embree-default";
    return made;
}

} // namespace pnr::bench
