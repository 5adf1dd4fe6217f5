// SPDX-License-Identifier: GPL-3.0-or-later
// bench_meshes --mesh FILE [--rounds N]
//
// How long a mesh takes to read: as it is, and as OBJ text by us and by tinyobjloader in turn. Times are CPU
// time of the process, medians over the rounds.
#include "core/mesh_io.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <string>

#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

namespace {

double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double seconds_of(const std::function<void()>& work) {
    const double start = cpu_seconds();
    work();
    return cpu_seconds() - start;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

std::filesystem::path write_obj(const pnr::MeshData& mesh) {
    const auto file = std::filesystem::temp_directory_path() / "bench_meshes.obj";
    std::FILE* out = std::fopen(file.c_str(), "w");
    if (!out) throw std::runtime_error("cannot write " + file.string());
    for (const auto& p : mesh.positions)
        std::fprintf(out, "v %.9g %.9g %.9g\n", static_cast<double>(p.x), static_cast<double>(p.y),
                     static_cast<double>(p.z));
    for (const auto& t : mesh.triangles) std::fprintf(out, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
    std::fclose(out);
    return file;
}

std::size_t read_with_tinyobj(const std::filesystem::path& file) {
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning, error;
    if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, file.c_str()))
        throw std::runtime_error("tinyobjloader: " + error);
    std::size_t triangles = 0;
    for (const auto& shape : shapes) triangles += shape.mesh.num_face_vertices.size();
    return triangles;
}

int run(const std::filesystem::path& file, int rounds) {
    const pnr::MeshData mesh = pnr::read_mesh(file, {});
    const auto obj = write_obj(mesh);
    std::vector<double> own, ours, tiny, ratio;
    for (int round = 0; round < rounds; ++round) {
        std::size_t counts[3] = {};
        own.push_back(seconds_of([&] { counts[0] = pnr::read_mesh(file, {}).triangles.size(); }));
        ours.push_back(seconds_of([&] { counts[1] = pnr::read_mesh(obj, {}).triangles.size(); }));
        tiny.push_back(seconds_of([&] { counts[2] = read_with_tinyobj(obj); }));
        ratio.push_back(tiny.back() / ours.back());
        if (counts[0] != mesh.triangles.size() || counts[1] != counts[0] || counts[2] != counts[0])
            throw std::runtime_error("the readers do not agree");
    }
    std::filesystem::remove(obj);
    std::printf("mesh,triangles,read_s,obj_s,obj_tinyobjloader_s,obj_ratio\n%s,%zu,%.4f,%.4f,%.4f,%.2f\n",
                file.stem().c_str(), mesh.triangles.size(), median(own), median(ours), median(tiny),
                median(ratio));
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    std::string mesh;
    int rounds = 15;
    for (int i = 1; i + 1 < argc; i += 2) {
        if (!std::strcmp(argv[i], "--mesh")) mesh = argv[i + 1];
        if (!std::strcmp(argv[i], "--rounds")) rounds = std::max(1, std::atoi(argv[i + 1]));
    }
    if (mesh.empty()) {
        std::fprintf(stderr, "usage: bench_meshes --mesh FILE [--rounds N]\n");
        return 2;
    }
    try {
        return run(mesh, rounds);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 4;
    }
}
