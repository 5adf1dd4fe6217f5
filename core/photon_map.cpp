// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/photon_map.h"

#include "core/atomic_file.h"
#include "core/rng.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <numeric>
#include <span>
#include <system_error>

namespace pnr {

namespace {

std::vector<Vec3f> positions_of(std::span<const Photon> photons) {
    std::vector<Vec3f> positions;
    positions.reserve(photons.size());
    for (const Photon& photon : photons) positions.push_back(photon.position);
    return positions;
}

template <class T>
void permute(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
    std::vector<T> sorted;
    sorted.reserve(values.size());
    for (const std::uint32_t i : order) sorted.push_back(values[i]);
    values = std::move(sorted);
}

// The radius that holds `k` of a tree's photons, as nine tenths of a sample of these photons see it.
float suiting_radius(const PhotonMap& map, const KdTree& tree, int k) {
    constexpr std::size_t samples = 256;
    const std::size_t step = std::max<std::size_t>(1, tree.count / samples);
    std::vector<Neighbour> found;
    std::vector<float> distances;
    for (std::size_t i = step / 2; i < tree.count; i += step) {
        const std::size_t photon = tree.order.empty() ? i : tree.order[i];
        find_nearest(tree, map.photons[photon].position, k, std::numeric_limits<float>::infinity(), found);
        if (!found.empty()) distances.push_back(std::sqrt(found.back().distance2));
    }
    if (distances.empty()) return 0;
    const auto ninth = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() * 9 / 10);
    std::nth_element(distances.begin(), ninth, distances.end());
    return *ninth;
}

double mean_flux(std::span<const Photon> photons) {
    double sum = 0;
    for (const Photon& photon : photons) sum += static_cast<double>(luminance(photon.flux));
    return photons.empty() ? 0 : sum / static_cast<double>(photons.size());
}

// The mean over flux, not over photons: what a watt comes with. Photons that were not aimed bring much more each than
// those that were, and would stand alone as specks in discs of the others' width.
double flux_of_most(std::span<const Photon> photons) {
    double sum = 0, squares = 0;
    for (const Photon& photon : photons) {
        const auto flux = static_cast<double>(luminance(photon.flux));
        sum += flux;
        squares += flux * flux;
    }
    return sum > 0 ? squares / sum : 0;
}

// The irradiance in the middle of a caustic photon's disc, alone there, over that of the light about it.
constexpr double spot = 0.004;

// Gather radii of a map with its trees.
void name_radii(PhotonMap& map) {
    const std::span<const Photon> all(map.photons);
    if (map.tree.count == 0) {
        map.caustic_radius = map.radius > 0 ? map.radius : suiting_radius(map, map.caustic, 50);
        if (!(map.radius > 0)) map.radius = suiting_radius(map, map.caustic, 100);
        return;
    }
    if (!(map.radius > 0)) map.radius = suiting_radius(map, map.tree, 100);
    if (map.caustic.count == 0) return;
    // The map's radius holds 100 photons of other light: its irradiance.
    const double share =
        2 * flux_of_most(all.subspan(map.tree.count)) / (spot * 100 * mean_flux(all.first(map.tree.count)));
    map.caustic_radius = map.radius * static_cast<float>(std::sqrt(std::clamp(share, 1e-4, 4.0)));
}

// Of photons in their final order.
void build_caustic_tree(PhotonMap& map) {
    map.caustic =
        kdtree_of_leaf_order(positions_of(std::span<const Photon>(map.photons).subspan(map.tree.count)));
    map.caustic.order.resize(map.caustic.count);
    std::iota(map.caustic.order.begin(), map.caustic.order.end(), static_cast<std::uint32_t>(map.tree.count));
}

} // namespace

void build_photon_tree(PhotonMap& map) {
    std::vector<std::uint32_t> parts[2]; // all but caustic photons, and these
    for (std::size_t i = 0; i < map.photons.size(); ++i)
        parts[map.photons[i].path() == PhotonPath::caustic].push_back(static_cast<std::uint32_t>(i));
    std::vector<std::uint32_t> order;
    order.reserve(map.photons.size());
    for (const std::vector<std::uint32_t>& part : parts) {
        std::vector<Vec3f> positions;
        positions.reserve(part.size());
        for (const std::uint32_t i : part) positions.push_back(map.photons[i].position);
        KdTree tree = build_kdtree(positions);
        for (const std::uint32_t i : tree.order) order.push_back(part[i]);
        if (&part == parts) map.tree = std::move(tree);
    }
    map.tree.order = {};
    permute(map.photons, order);
    if (!map.normals.empty()) permute(map.normals, order);
    build_caustic_tree(map);
    name_radii(map);
}

// ---- files
// --------------------------------------------------------------------------------------------------------

namespace {

constexpr std::array<char, 8> magic{'p', 'n', 'r', 'p', 'h', 'o', 't', '\n'};
constexpr std::uint32_t file_version = 2;
constexpr std::uint32_t byte_order = 0x01020304;

// All members are written as they stand; the checksum covers everything behind it.
struct Header {
    std::array<char, 8> magic;
    std::uint32_t version, byte_order;
    std::uint64_t checksum;
    std::uint64_t scene_hash;
    std::uint64_t photons, normals;
    std::int64_t emitted;
    std::array<double, 9> balance; // emitted, absorbed, escaped
    float radius, caustic_radius;
    std::uint64_t has_tree;
};
static_assert(std::is_trivially_copyable_v<Header> && std::is_trivially_copyable_v<Photon>);
constexpr std::size_t checksum_end = offsetof(Header, scene_hash);

std::uint64_t checksum(std::span<const unsigned char> bytes) {
    std::uint64_t sum = bytes.size();
    std::size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 8) {
        std::uint64_t word;
        std::memcpy(&word, bytes.data() + i, 8);
        sum = hash_words(sum, word);
    }
    for (; i < bytes.size(); ++i) sum = hash_words(sum, bytes[i]);
    return sum;
}

void put_balance(const PowerBalance& balance, std::array<double, 9>& out) {
    const glm::dvec3* parts[3] = {&balance.emitted, &balance.absorbed, &balance.escaped};
    for (std::size_t i = 0; i < 9; ++i) out[i] = (*parts[i / 3])[static_cast<int>(i % 3)];
}

void get_balance(const std::array<double, 9>& in, PowerBalance& balance) {
    glm::dvec3* parts[3] = {&balance.emitted, &balance.absorbed, &balance.escaped};
    for (std::size_t i = 0; i < 9; ++i) (*parts[i / 3])[static_cast<int>(i % 3)] = in[i];
}

std::vector<unsigned char> read_bytes(const std::filesystem::path& file) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    std::ifstream in(file, std::ios::binary);
    if (error || !in) throw FileError(fmt::format("cannot read the photon file '{}'", file.string()));
    std::vector<unsigned char> bytes(size);
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!in) throw FileError(fmt::format("cannot read the photon file '{}'", file.string()));
    return bytes;
}

Header read_header(const std::vector<unsigned char>& bytes, const std::string& name) {
    Header header;
    if (bytes.size() < sizeof(Header) || std::memcmp(bytes.data(), magic.data(), magic.size()) != 0)
        throw FileError(fmt::format("'{}' is not a photon file", name));
    std::memcpy(&header, bytes.data(), sizeof(Header));
    if (header.byte_order != byte_order)
        throw FileError(
            fmt::format("the photon file '{}' was written on a machine of another byte order", name));
    if (header.version != file_version)
        throw FileError(fmt::format("the photon file '{}' has version {}, this program reads version {}",
                                    name, header.version, file_version));
    const std::uint64_t limit = bytes.size();
    const bool sane =
        header.photons <= limit / sizeof(Photon) && header.normals <= limit / sizeof(Vec3f) &&
        (header.normals == 0 || header.normals == header.photons) &&
        limit == sizeof(Header) + header.photons * sizeof(Photon) + header.normals * sizeof(Vec3f);
    if (!sane) throw FileError(fmt::format("the photon file '{}' is cut short or too long", name));
    if (header.checksum != checksum(std::span(bytes).subspan(checksum_end)))
        throw FileError(fmt::format("the photon file '{}' is damaged: its checksum does not fit", name));
    return header;
}

} // namespace

void save_photons(const PhotonMap& map, std::uint64_t scene_hash, const std::filesystem::path& file) {
    Header header{};
    header.magic = magic;
    header.version = file_version;
    header.byte_order = byte_order;
    header.scene_hash = scene_hash;
    header.photons = map.photons.size();
    header.normals = map.normals.size();
    header.emitted = map.emitted;
    put_balance(map.balance, header.balance);
    header.radius = map.radius;
    header.caustic_radius = map.caustic_radius;
    header.has_tree = map.tree.count + map.caustic.count > 0 ? 1 : 0;
    const std::size_t photon_bytes = map.photons.size() * sizeof(Photon);
    const std::size_t normal_bytes = map.normals.size() * sizeof(Vec3f);
    std::vector<unsigned char> bytes(sizeof(Header) + photon_bytes + normal_bytes);
    std::memcpy(bytes.data(), &header, sizeof(Header));
    if (photon_bytes > 0) std::memcpy(bytes.data() + sizeof(Header), map.photons.data(), photon_bytes);
    if (normal_bytes > 0)
        std::memcpy(bytes.data() + sizeof(Header) + photon_bytes, map.normals.data(), normal_bytes);
    header.checksum = checksum(std::span(bytes).subspan(checksum_end));
    std::memcpy(bytes.data(), &header, sizeof(Header));
    write_file_atomically(file, std::span<const unsigned char>(bytes));
}

PhotonMap load_photons(std::uint64_t scene_hash, const std::filesystem::path& file) {
    const std::vector<unsigned char> bytes = read_bytes(file);
    const Header header = read_header(bytes, file.string());
    if (header.scene_hash != scene_hash)
        throw SceneError(
            {}, fmt::format("the photons in '{}' are of another scene: its hash is {:016x}, this scene's "
                            "is {:016x}; trace them again with --save-photons",
                            file.string(), header.scene_hash, scene_hash));
    PhotonMap map;
    map.emitted = header.emitted;
    get_balance(header.balance, map.balance);
    map.radius = header.radius;
    map.photons.resize(header.photons);
    map.normals.resize(header.normals);
    const unsigned char* at = bytes.data() + sizeof(Header);
    if (!map.photons.empty()) std::memcpy(map.photons.data(), at, header.photons * sizeof(Photon));
    at += header.photons * sizeof(Photon);
    if (!map.normals.empty()) std::memcpy(map.normals.data(), at, header.normals * sizeof(Vec3f));
    if (header.has_tree != 0) {
        const auto caustic = std::find_if(map.photons.begin(), map.photons.end(), [](const Photon& photon) {
            return photon.path() == PhotonPath::caustic;
        });
        const auto begin = static_cast<std::size_t>(caustic - map.photons.begin());
        map.tree = kdtree_of_leaf_order(positions_of(std::span<const Photon>(map.photons).first(begin)));
        build_caustic_tree(map);
        map.caustic_radius = header.caustic_radius;
    }
    return map;
}

} // namespace pnr
