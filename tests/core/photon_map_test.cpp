// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/photon_map.h"
#include "core/rng.h"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>

using namespace pnr;

namespace {

PhotonMap some_map(bool normals) {
    PhotonMap map;
    Rng rng = make_rng(5, Pass::test, 0);
    for (std::uint32_t i = 0; i < 1000; ++i) {
        Photon photon;
        const Vec2 xy = rng.uniform2();
        photon.position = Vec3f(Vec3(xy, 0));
        photon.direction = {0, 0, -1};
        photon.flux = Color(static_cast<float>(i));
        photon.tag = photon_tag(static_cast<int>(i), i % 2 == 0, i % 3 == 0 ? PhotonPath::caustic : PhotonPath::indirect);
        map.photons.push_back(photon);
        if (normals) map.normals.push_back({0, static_cast<float>(i), 1});
    }
    map.emitted = 12345;
    map.balance = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
    return map;
}

struct PhotonFile : testing::Test {
    std::filesystem::path file = std::filesystem::temp_directory_path() /
                                 ("pnr_photons_" + std::to_string(reinterpret_cast<std::uintptr_t>(this)));
    void TearDown() override { std::filesystem::remove(file); }
};

std::string message_of(std::uint64_t hash, const std::filesystem::path& file) {
    try {
        load_photons(hash, file);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

} // namespace

TEST(PhotonMap, TagHoldsItsParts) {
    Photon photon;
    photon.tag = photon_tag(70000, true, PhotonPath::caustic);
    EXPECT_EQ(photon.object(), 70000);
    EXPECT_TRUE(photon.npr());
    EXPECT_EQ(photon.path(), PhotonPath::caustic);
}

TEST(PhotonMap, TreesSortPhotonsAndNormalsTogether) {
    PhotonMap map = some_map(true);
    build_photon_tree(map);
    ASSERT_EQ(map.tree.count, 666u);
    ASSERT_EQ(map.caustic.count, 334u);
    std::vector<Neighbour> found;
    for (std::uint32_t i = 0; i < 1000; i += 17) {
        EXPECT_EQ(map.normals[i].y, map.photons[i].flux.x);
        EXPECT_EQ(map.photons[i].path() == PhotonPath::caustic, i >= 666);
        find_nearest(i < 666 ? map.tree : map.caustic, map.photons[i].position, 1,
                     std::numeric_limits<float>::infinity(), found);
        EXPECT_EQ(found[0].index, i);
    }
    // 100 of 666 photons spread over the unit square lie within sqrt(0.15 / pi) = 0.219 of a point well
    // inside.
    EXPECT_GT(map.radius, 0.20f);
    EXPECT_LT(map.radius, 0.44f); // twice that in a corner
}

TEST(PhotonMap, CausticsAloneHaveTheirOwnRadius) {
    PhotonMap map = some_map(false);
    std::erase_if(map.photons, [](const Photon& photon) { return photon.path() != PhotonPath::caustic; });
    build_photon_tree(map);
    EXPECT_EQ(map.tree.count, 0u);
    EXPECT_EQ(map.caustic.count, 334u);
    EXPECT_GT(map.caustic_radius, 0.20f); // 50 of 334
    EXPECT_LT(map.caustic_radius, 0.44f);
}

TEST(PhotonMap, AFewStrongCausticPhotonsAreNoSpecks) {
    PhotonMap map = some_map(false);
    int caustics = 0;
    for (Photon& photon : map.photons) { // one caustic photon of 30 brings a thousand times as much as others
        const bool caustic = photon.path() == PhotonPath::caustic;
        photon.flux = Color(!caustic ? 1.0f : caustics++ % 30 == 0 ? 0.1f : 1e-4f);
    }
    build_photon_tree(map);
    // The middle of a strong one's disc, alone there, beside the light of 100 photons in the map's radius.
    const double alone = 2 * 0.1 / (map.caustic_radius * map.caustic_radius), about = 100 / (map.radius * map.radius);
    EXPECT_LT(alone / about, 0.01);
    EXPECT_LT(map.caustic_radius, map.radius);
}

TEST(PhotonMap, EmptyMapHasAnEmptyTree) {
    PhotonMap map;
    build_photon_tree(map);
    EXPECT_EQ(map.tree.count, 0u);
    EXPECT_EQ(map.radius, 0.f);
}

TEST_F(PhotonFile, LoadsWhatWasSaved) {
    for (const bool normals : {false, true}) {
        PhotonMap map = some_map(normals);
        build_photon_tree(map);
        save_photons(map, 42, file);
        const PhotonMap loaded = load_photons(42, file);
        ASSERT_EQ(loaded.photons.size(), map.photons.size());
        EXPECT_EQ(std::memcmp(loaded.photons.data(), map.photons.data(), map.photons.size() * sizeof(Photon)),
                  0);
        EXPECT_EQ(loaded.normals, map.normals);
        EXPECT_EQ(loaded.emitted, map.emitted);
        EXPECT_EQ(loaded.balance.emitted, map.balance.emitted);
        EXPECT_EQ(loaded.balance.absorbed, map.balance.absorbed);
        EXPECT_EQ(loaded.balance.escaped, map.balance.escaped);
        EXPECT_EQ(loaded.radius, map.radius);
        EXPECT_EQ(loaded.tree.x, map.tree.x);
        EXPECT_EQ(loaded.caustic.x, map.caustic.x);
        EXPECT_EQ(loaded.caustic.order, map.caustic.order);
        EXPECT_EQ(loaded.caustic_radius, map.caustic_radius);
        ASSERT_EQ(loaded.tree.nodes.size(), map.tree.nodes.size());
        EXPECT_EQ(std::memcmp(loaded.tree.nodes.data(), map.tree.nodes.data(),
                              map.tree.nodes.size() * sizeof(KdNode)),
                  0);
    }
}

TEST_F(PhotonFile, RefusesAnotherSceneAndDamage) {
    PhotonMap map = some_map(true);
    save_photons(map, 42, file);
    EXPECT_THROW(load_photons(43, file), SceneError);
    EXPECT_NE(message_of(43, file).find("another scene"), std::string::npos);
    std::fstream edit(file, std::ios::in | std::ios::out | std::ios::binary);
    edit.seekp(5000);
    edit.put('\x7f');
    edit.close();
    EXPECT_THROW(load_photons(42, file), FileError);
    EXPECT_NE(message_of(42, file).find("checksum"), std::string::npos);
    std::filesystem::resize_file(file, 3000);
    EXPECT_NE(message_of(42, file).find("cut short"), std::string::npos);
    std::ofstream(file)
        << "something else entirely, long enough to hold a header if it were one, but it is none of "
           "ours, so the first bytes tell";
    EXPECT_NE(message_of(42, file).find("not a photon file"), std::string::npos);
    EXPECT_THROW(load_photons(42, file.string() + ".none"), FileError);
}
