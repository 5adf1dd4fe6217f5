// SPDX-License-Identifier: GPL-3.0-or-later
// fuzz_mesh [SECONDS [SEED [FILE...]]]: mesh files, cut, spliced and with bytes changed, go through the
// readers; whatever they accept goes on into a BVH and is met by rays. A crash, or a mesh that breaks the
// readers' promise, is a finding: the bytes are then in fuzz_mesh.last. With clang and -fsanitize=fuzzer,
// PNR_LIBFUZZER makes it a libFuzzer target.
#include "core/geometry.h"
#include "core/mesh_io.h"
#include "core/rng.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

namespace {

using namespace pnr;

// Whether the bytes were a mesh.
bool feed(std::string_view bytes, const std::string& name) {
    MeshData mesh;
    try {
        mesh = parse_mesh(bytes, name, {});
    } catch (const SceneError&) {
        return false;
    }
    for (const auto& p : mesh.positions)
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) std::abort();
    for (const auto& t : mesh.triangles)
        for (const auto v : t)
            if (v >= mesh.positions.size()) std::abort();
    GeometryItem item;
    item.form = Shape(Mesh{std::make_shared<const MeshData>(std::move(mesh)), "", false, {}});
    const auto geometry = make_geometry({item});
    const Bounds b = item_bounds(item);
    Rng rng = make_rng(1, Pass::test, 0);
    for (int i = 0; i < 16; ++i) {
        const auto point = [&] {
            return b.low + (b.high - b.low) * Vec3(rng.uniform(), rng.uniform(), rng.uniform());
        };
        const Vec3 from = point();
        const auto hit = closest_hit(*geometry, {from, point() - from, 0, infinity}, RayKind::camera);
        if (hit && !(std::isfinite(hit->position.x) && std::isfinite(hit->normal.x) && hit->error >= 0))
            std::abort();
    }
    return true;
}

} // namespace

#ifdef PNR_LIBFUZZER
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    feed({reinterpret_cast<const char*>(data), size}, "fuzz.obj");
    feed({reinterpret_cast<const char*>(data), size}, "fuzz.stl");
    return 0;
}
#else
namespace {

std::string mutated(const std::vector<std::string>& files, Rng& rng) {
    std::string bytes = files[rng.bits() % files.size()];
    for (std::uint64_t change = 1 + rng.bits() % 4; change > 0 && !bytes.empty(); --change) {
        const std::size_t at = rng.bits() % bytes.size();
        static constexpr const char* words[] = {"nan", "inf", "-1",   "1e999",   "99999999999", "0",
                                                "/",   "\n",  "list", "element", "4294967295"};
        switch (rng.bits() % 6) {
        case 0:
            bytes.resize(at);
            break;
        case 1:
            bytes[at] = static_cast<char>(rng.bits());
            break;
        case 2:
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << (rng.bits() % 8)));
            break;
        case 3:
            bytes.insert(at, words[rng.bits() % std::size(words)]);
            break;
        case 4:
            bytes.erase(at, rng.bits() % 32);
            break;
        default: {
            const std::string& other = files[rng.bits() % files.size()];
            const std::size_t from = rng.bits() % (other.size() + 1);
            bytes.replace(at, rng.bits() % 64, other, from, rng.bits() % 64);
        }
        }
    }
    return bytes;
}

} // namespace

int main(int argc, char** argv) {
    const double seconds = argc > 1 ? std::atof(argv[1]) : 10;
    const auto seed = static_cast<std::uint64_t>(argc > 2 ? std::atoll(argv[2]) : 1);
    std::vector<std::string> files{
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
        "z\nelement face 1\nproperty list "
        "uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf -1 -2 -3\n",
        "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
        "0\nendloop\nendfacet\nendsolid\n"};
    for (int i = 3; i < argc; ++i) {
        std::ifstream in(argv[i], std::ios::binary);
        files.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    const auto start = std::chrono::steady_clock::now();
    std::int64_t runs = 0, accepted = 0;
    for (; std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < seconds;
         ++runs) {
        Rng rng = make_rng(seed, Pass::test, static_cast<std::uint64_t>(runs));
        const std::string bytes = mutated(files, rng);
        std::ofstream("fuzz_mesh.last", std::ios::binary) << bytes;
        for (const char* name : {"fuzz.obj", "fuzz.stl", "fuzz.ply"}) accepted += feed(bytes, name);
    }
    std::remove("fuzz_mesh.last");
    std::printf("%lld files, %lld taken as meshes\n", static_cast<long long>(runs),
                static_cast<long long>(accepted));
    return 0;
}
#endif
