// SPDX-License-Identifier: GPL-3.0-or-later
// A cache never changes a bit: what is used again is what would have been made anew.
#include "cli/reuse.h"

#include "run_pnr.h"

#include "core/image_io.h"
#include "core/trace_photons.h"
#include "parser/load_scene.h"

#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

namespace pnr {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

// Two painted things, one of them half, a mirror, a picture, a mesh, a declared style and a little of all
// that names can do.
const char* const scene_text = R"(#declare Long = 9;
#declare Side = 0.4;
#declare Style = npr { ilic { length Long cell 3 } }
#declare Matt = finish { ambient 0 diffuse 0.7 }
global_settings { photons { count 1500 } npr { interpolation { radius 20 } } }
camera { location <0, 1, -2.6> look_at <0, 0.9, 0> right x angle 50 }
light_source { <0, 1.999, 0>, rgb 1 emitter { hemisphere 0.3, -y } power 60 }
union {
    box { <-1, -0.1, -3>, <1, 0, 1> pigment { checker rgb 0.9 rgb 0.6 scale Side } }
    box { <-1, 2, -3>, <1, 2.1, 1> pigment { rgb 0.9 } }
    box { <-1.1, 0, -3>, <-1, 2, 1> pigment { rgb <0.9, 0.2, 0.2> } }
    box { <1, 0, -3>, <1.1, 2, 1> pigment { rgb <0.2, 0.9, 0.2> } }
    box { <-1, 0, 1>, <1, 2, 1.1> pigment { rgb 0.9 } }
    finish { Matt }
}
sphere { <-0.35, 0.5, 0.1>, 0.5 pigment { rgb <0.9, 0.7, 0.4> } finish { Matt }
    npr { Style seeds { seed { <-0.35, 1, 0.1>, x } seed { <-0.35, 0.5, -0.4>, y weight 2 } } tone { contrast 1.1 } } }
box { <0.15, 0, -0.2>, <0.65, 0.6, 0.3> pigment { rgb 0.8 } finish { Matt } npr { style oil mix 0.5 } }
sphere { <0.45, 0.85, 0.1>, 0.24 pigment { rgb 0.3 } finish { ambient 0 diffuse 0.2 reflection 0.6 } }
mesh { file "tri.off" pigment { rgb <0.2, 0.3, 0.9> } finish { Matt } translate <-0.8, 1.2, 0.5> }
)";

void write_scene(const TemporaryFolder& folder, const std::string& text) {
    folder.write("a.pnr", text);
    folder.write("tri.off",
                 "OFF\n4 4 0\n0 0 0\n0.4 0 0\n0 0.4 0\n0 0 0.4\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) throw std::logic_error("the scene has no `" + from + "`");
    return text.replace(at, from.size(), to);
}

std::set<std::string> used_again(const TemporaryFolder& folder) {
    const nlohmann::json stats = nlohmann::json::parse(folder.read("stats.json"));
    std::set<std::string> names;
    for (const auto& left : stats["plan"]["left_out"])
        if (left["why"].get<std::string>().find("used again") != std::string::npos)
            names.insert(left["what"]);
    return names;
}

Words with(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

const Words small{"render", "a.pnr", "-W", "32", "-H", "24", "--progress", "off"};

// What is seen of a run, all of it: what lies behind the picture. EXR files say when they were written, so
// their pixels.
std::string all_maps(const TemporaryFolder& folder, const std::string& name) {
    std::string all = folder.read(name + "/photons.ply");
    for (const char* file :
         {"gbuffer.exr", "sparse.exr", "informative.exr", "partial.exr", "photoreal.exr"}) {
        const ImageFile image = read_exr(folder / (name + "/" + file));
        const std::vector<float>& data = image.parts.at(0).data;
        all.append(reinterpret_cast<const char*>(data.data()), data.size() * sizeof(float));
    }
    return all;
}

// Renders with and without the cache, and expects the same bits.
std::set<std::string> render_both(const TemporaryFolder& folder, const Words& more, const std::string& what) {
    const Words words = with(small, more);
    const Ran cached = run_pnr(folder, with(words, {"-o", "cached.png", "--stats", "stats.json"}));
    EXPECT_EQ(cached.code, 0) << what << cached.err;
    const std::set<std::string> names = used_again(folder);
    const Ran fresh =
        run_pnr(folder, with(words, {"-o", "fresh.png", "--no-cache", "--stats", "stats.json"}));
    EXPECT_EQ(fresh.code, 0) << what << fresh.err;
    EXPECT_EQ(used_again(folder), std::set<std::string>{}) << what;
    EXPECT_TRUE(folder.read("cached.png") == folder.read("fresh.png")) << what;
    return names;
}

// The same, and all that lies behind the pictures.
std::set<std::string> render_maps(const TemporaryFolder& folder, const std::string& what) {
    EXPECT_EQ(run_pnr(folder, with(small, {"--maps", "fresh", "--no-cache"})).code, 0) << what;
    EXPECT_EQ(run_pnr(folder, with(small, {"--maps", "cached", "--stats", "stats.json"})).code, 0) << what;
    EXPECT_TRUE(all_maps(folder, "cached") == all_maps(folder, "fresh")) << what;
    return used_again(folder);
}

struct Edit {
    const char* from;
    const char* to;
};

const std::set<std::string> all_passes{"photons", "gbuffer", "sparse", "render"};

TEST(Reuse, PaintAloneRunsThePaintPassAlone) {
    const Edit edits[] = {
        {"#declare Long = 9", "#declare Long = 14"},
        {"cell 3", "cell 5"},
        {"contrast 1.1", "contrast 1.4 saturation 0.5 warm 0.3"},
        {"<-0.35, 1, 0.1>, x", "<-0.35, 1, 0.1>, z"},
        {"seed { <-0.35, 1, 0.1>, x }", ""},
        {"weight 2", "weight 1"},
        {"style oil", "style fur"},
        {"radius 20", "radius 9"},
        {"npr { interpolation", "npr { paper_mode on interpolation"},
        {"npr { style oil", "npr { field along y style oil"},
        {"npr { ilic { length Long cell 3 } }",
         "npr { field light relief 0.5, 1 ilic { length Long size 2 gaussian 5, 3 } }"},
        {"// ", "// "},
    };
    TemporaryFolder folder;
    const std::string text = std::string(scene_text) + "// \n";
    write_scene(folder, text);
    EXPECT_EQ(render_both(folder, {}, "first"), std::set<std::string>{});
    EXPECT_EQ(render_both(folder, {}, "again"), all_passes);
    for (const Edit& edit : edits) {
        write_scene(folder, changed(text, edit.from, edit.to));
        EXPECT_EQ(render_both(folder, {}, edit.to), all_passes) << edit.to;
    }
    write_scene(folder, text);
    EXPECT_EQ(render_both(folder, {"-D", "Unused=3", "--exposure", "1", "--threads", "1"}, "options"),
              all_passes);
}

TEST(Reuse, MapsHaveTheSameBits) {
    TemporaryFolder folder;
    write_scene(folder, scene_text);
    EXPECT_EQ(render_maps(folder, "first"), std::set<std::string>{});
    write_scene(folder, changed(scene_text, "style oil", "style wash"));
    EXPECT_EQ(render_maps(folder, "style"), all_passes);
    write_scene(folder, changed(scene_text, "angle 50", "angle 46"));
    EXPECT_EQ(render_maps(folder, "camera"), std::set<std::string>{"photons"});
}

TEST(Reuse, TheCameraAloneLeavesThePhotons) {
    const Edit edits[] = {{"location <0, 1, -2.6>", "location <0.2, 1.1, -2.5>"},
                          {"angle 50", "angle 44"},
                          {"look_at <0, 0.9, 0>", "look_at <0, 0.9, 0> orthographic"}};
    TemporaryFolder folder;
    write_scene(folder, scene_text);
    render_both(folder, {}, "first");
    for (const Edit& edit : edits) {
        write_scene(folder, changed(scene_text, edit.from, edit.to));
        EXPECT_EQ(render_both(folder, {}, edit.to), std::set<std::string>{"photons"}) << edit.to;
    }
    write_scene(folder, scene_text);
    EXPECT_EQ(render_both(folder, {"-H", "26"}, "size"), std::set<std::string>{"photons"});
    EXPECT_EQ(render_both(folder, {"--crop", "4,4,20,16"}, "crop"), std::set<std::string>{"photons"});
    EXPECT_EQ(render_both(folder, {"--integrator", "path"}, "path"), std::set<std::string>{"photons"});
    // Where planes are endless photons fall about the camera too.
    write_scene(folder, std::string("plane { y, -1 pigment { rgb 1 } }\n") + scene_text);
    render_both(folder, {}, "plane");
    write_scene(folder, std::string("plane { y, -1 pigment { rgb 1 } }\n") +
                            changed(scene_text, "location <0, 1, -2.6>", "location <0.2, 1.1, -9>"));
    EXPECT_EQ(render_both(folder, {}, "plane and camera"), std::set<std::string>{});
    // How far an object is painted changes the light beside the paint, and what mirrors show.
    write_scene(folder, changed(scene_text, "mix 0.5", "mix 0.7"));
    EXPECT_EQ(render_both(folder, {}, "mix"), (std::set<std::string>{"photons", "gbuffer"}));
}

TEST(Reuse, NothingIsUsedThatCouldHaveChanged) {
    const Edit edits[] = {
        {"power 60", "power 61"},
        {"rgb 1 emitter", "rgb <1, 0.9, 0.8> emitter"},
        {"hemisphere 0.3", "hemisphere 0.31"},
        {"rgb <0.9, 0.7, 0.4>", "rgb <0.9, 0.7, 0.41>"},
        {"#declare Side = 0.4", "#declare Side = 0.41"},
        {"diffuse 0.7 }\nglobal", "diffuse 0.71 }\nglobal"},
        {"<-0.35, 0.5, 0.1>, 0.5", "<-0.35, 0.5, 0.1>, 0.51"},
        {"reflection 0.6", "reflection 0.61"},
        {"count 1500", "count 1501"},
        {"count 1500", "count 1500 radius 0.2"},
        {"npr { style oil mix 0.5 }", ""},
        {"npr { style oil mix 0.5 }", "npr off"},
        {"\"tri.off\"", "\"tri.off\" smooth on"},
        {"mesh { file", "sphere { 0.5, 0.1 } mesh { file"},
        {"global_settings {", "global_settings { max_trace_level 1"},
        {"translate <-0.8", "rotate 3*y translate <-0.8"},
        {"pigment { rgb 0.3 }", "pigment { rgbt 0.3 } interior { ior 1.2 }"},
    };
    TemporaryFolder folder;
    write_scene(folder, scene_text);
    render_both(folder, {}, "first");
    for (const Edit& edit : edits) {
        write_scene(folder, changed(scene_text, edit.from, edit.to));
        std::set<std::string> names = render_both(folder, {}, edit.to);
        if (std::string(edit.to).find("max_trace_level") != std::string::npos) names.erase("photons");
        EXPECT_EQ(names, std::set<std::string>{}) << edit.to;
    }
    write_scene(folder, scene_text);
    EXPECT_EQ(render_both(folder, {"--seed", "2"}, "seed"), std::set<std::string>{});
    EXPECT_EQ(render_both(folder, {"-D", "Matt=1", "--no-prune"}, "no-prune"), std::set<std::string>{});
    EXPECT_EQ(render_both(folder, {"--quality", "draft"}, "quality"),
              std::set<std::string>{"photons"}); // their count is said
    // Files that the scene names.
    write_scene(folder, changed(scene_text, "pigment { rgb 0.9 } }\n    finish",
                                "pigment { image_map { \"wall.ppm\" } } }\n    finish"));
    for (const char* blue : {"200", "100"}) {
        folder.write("wall.ppm",
                     std::string("P3\n2 2\n255\n250 20 20 20 250 20\n20 20 250 200 200 ") + blue + "\n");
        EXPECT_EQ(render_both(folder, {}, "picture"), std::set<std::string>{});
        EXPECT_EQ(render_both(folder, {}, "picture"), all_passes);
    }
    write_scene(folder, scene_text);
    folder.write("tri.off",
                 "OFF\n4 4 0\n0 0 0\n0.4 0 0\n0 0.4 0\n0 0 0.5\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    EXPECT_EQ(render_both(folder, {}, "mesh"), std::set<std::string>{});
}

TEST(Reuse, NamesThatTradePlacesAreOtherThings) {
    const std::string tail = "camera { location <0, 1, -4> look_at 0 }\nlight_source { <3, 5, -4>, rgb 1 }\n"
                             "global_settings { photons { global on count 2000 } }\n"
                             "object { A pigment { rgb 1 } npr { ilic { length 8 } } }\nbox { <-3, -1.2, "
                             "-3>, <3, -1, 3> pigment { rgb 0.8 } }\n";
    const std::string texts[] = {
        "#declare A = sphere { 0, 1 }\n#declare B = box { -0.7, 0.7 }\n" + tail,
        "#declare B = sphere { 0, 1 }\n#declare A = box { -0.7, 0.7 }\n" + tail,
        "camera { #declare A = sphere { 0, 0.9 } location 0 }\n#declare B = box { -0.7, 0.7 }\n" + tail,
        "#declare F = function { x * x + y * y + z * z - 1 }\n#declare G = function { max(abs(x), abs(y), "
        "abs(z)) - 0.7 }\n"
        "#declare A = isosurface { function { F(x, y, z) } contained_by { sphere { 0, 1.5 } } max_gradient 4 "
        "}\n" +
            tail,
        "#declare G = function { x * x + y * y + z * z - 1 }\n#declare F = function { max(abs(x), abs(y), "
        "abs(z)) - 0.7 }\n"
        "#declare A = isosurface { function { F(x, y, z) } contained_by { sphere { 0, 1.5 } } max_gradient 4 "
        "}\n" +
            tail,
        "#declare G = function { x * x + y * y + z * z - 1 }\n#declare F = function { max(abs(x), abs(y), "
        "abs(z)) - 0.6 }\n"
        "#declare A = isosurface { function { F(x, y, z) } contained_by { sphere { 0, 1.5 } } max_gradient 4 "
        "}\n" +
            tail,
    };
    TemporaryFolder folder;
    for (const std::string& text : texts) {
        write_scene(folder, text);
        EXPECT_EQ(render_both(folder, {}, text), std::set<std::string>{}) << text;
    }
}

TEST(Reuse, DamagedEntriesAreMadeAnew) {
    TemporaryFolder folder;
    write_scene(folder, scene_text);
    render_both(folder, {}, "first");
    const fs::path kept = folder.cache() / "pnr";
    std::vector<fs::path> entries;
    for (const auto& file : fs::directory_iterator(kept)) entries.push_back(file.path());
    ASSERT_EQ(entries.size(), 4u);
    for (const fs::path& entry : entries) { // a bit turned in the middle of each
        std::fstream file(entry, std::ios::binary | std::ios::in | std::ios::out);
        const auto middle = static_cast<std::streamoff>(fs::file_size(entry) / 2);
        file.seekg(middle);
        const int was = file.get();
        file.seekp(middle);
        file.put(static_cast<char>(was ^ 16));
    }
    EXPECT_EQ(render_both(folder, {}, "a bit turned"), std::set<std::string>{});
    EXPECT_EQ(render_both(folder, {}, "written anew"), all_passes);
    for (const fs::path& entry : entries) fs::resize_file(entry, fs::file_size(entry) - 5);
    EXPECT_EQ(render_both(folder, {}, "cut short"), std::set<std::string>{});
    for (const fs::path& entry : entries) fs::resize_file(entry, 0);
    EXPECT_EQ(render_both(folder, {}, "empty"), std::set<std::string>{});
    fs::remove_all(kept);
    std::ofstream(kept) << "a file where the folder should be";
    EXPECT_EQ(render_both(folder, {}, "no folder"), std::set<std::string>{});
}

TEST(Reuse, RunsAtOnceDoNotHarmOneAnother) {
    TemporaryFolder folder;
    write_scene(folder, scene_text);
    ASSERT_EQ(run_pnr(folder, with(small, {"-o", "fresh.png", "--no-cache"})).code, 0);
    const auto one = [&](int i) {
        return run_pnr(folder, with(small, {"-o", "at_once" + std::to_string(i) + ".png"})).code;
    };
    std::vector<std::thread> runs;
    std::array<int, 4> codes{};
    for (int i = 0; i < 4; ++i) runs.emplace_back([&, i] { codes[static_cast<std::size_t>(i)] = one(i); });
    for (std::thread& run : runs) run.join();
    for (int i = 0; i < 4; ++i) {
        EXPECT_EQ(codes[static_cast<std::size_t>(i)], 0);
        EXPECT_EQ(folder.read("at_once" + std::to_string(i) + ".png"), folder.read("fresh.png"));
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.cache() / "pnr"), {}), 4);
}

TEST(Reuse, PlanTellsWhatIsKept) {
    TemporaryFolder folder;
    write_scene(folder, scene_text);
    EXPECT_EQ(run_pnr(folder, {"plan", "a.pnr"}).out.find("used again"), std::string::npos);
    write_scene(folder, changed(scene_text, "right x", "right 0.1*x up 0.1*y"));
    ASSERT_EQ(run_pnr(folder, {"render", "a.pnr", "-o", "a.png", "-W", "32"}).code, 0);
    EXPECT_NE(run_pnr(folder, {"plan", "a.pnr"}).out.find("leaves out photons: "), std::string::npos);
    EXPECT_EQ(run_pnr(folder, {"plan", "a.pnr", "--no-cache"}).out.find("used again"), std::string::npos);
}

// ---- hashes against worlds

// All that a world sends out and shows, of few photons and pixels.
std::uint64_t trace_world(const LoadResult& loaded, bool look) {
    Settings settings = loaded.settings;
    settings.photons.count = 200;
    settings.photons.count_given = true;
    settings.photons.spacing = 0;
    settings.render.width = 12;
    settings.render.height = 9;
    settings.render.samples_min = settings.render.samples_max = 1;
    const World world = build_world(*loaded.scene, settings);
    Hasher hash;
    const auto add_bytes = [&](const auto& values) {
        hash.add(hash_bytes(
            {reinterpret_cast<const unsigned char*>(values.data()), values.size() * sizeof(values[0])}));
    };
    PhotonMap map = trace_photons(world, settings.photons, settings.render.seed, 0, true);
    add_bytes(map.photons);
    add_bytes(map.normals);
    if (!look) return hash.value;
    build_photon_tree(map);
    const GBuffer seen = make_gbuffer(world, {world.camera, 12, 9}, {0, 0, 12, 9}, settings.render);
    for (const Seen& s : seen.seen.pixels) {
        for (int i = 0; i < 3; ++i) hash.add(static_cast<double>(s.position[i] + s.normal[i]));
        hash.add(std::uint64_t{s.object} << 32 | s.via);
    }
    const RenderResult light = render(world, seen, map, settings, {0, 0, 12, 9}, false);
    add_bytes(light.layer.color.pixels);
    return hash.value;
}

std::string mix_of(const LoadResult& loaded) {
    std::string all;
    for (const WorldObject& object : build_world(*loaded.scene, loaded.settings).objects)
        all += std::to_string(object.npr) + " " + std::to_string(object.npr ? object.paint.mix : 0) + ";";
    return all;
}

// Where the text's numbers stand.
std::vector<std::pair<std::size_t, std::size_t>> numbers_in(const std::string& text) {
    std::vector<std::pair<std::size_t, std::size_t>> found;
    for (std::size_t i = 0; i < text.size();) {
        const bool word = std::isalpha(static_cast<unsigned char>(text[i])) || text[i] == '_';
        const bool number = std::isdigit(static_cast<unsigned char>(text[i]));
        std::size_t end = i + 1;
        while ((word || number) && end < text.size() &&
               (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_' ||
                (number && text[end] == '.')))
            ++end;
        if (number) found.emplace_back(i, end - i);
        i = end;
    }
    return found;
}

// Every number of a text in turn is made another one: either the hashes tell it, or the same light comes of
// it.
void expect_hashes_tell(const std::string& text, const std::string& name) {
    const LoadOptions options;
    const LoadResult before = load_scene_text(text, name, options);
    ASSERT_TRUE(before.scene) << name;
    const std::string mix = mix_of(before);
    const std::uint64_t world = trace_world(before, false), all = trace_world(before, true);
    int untold = 0;
    for (const auto& [at, length] : numbers_in(text)) {
        const std::string number = text.substr(at, length);
        const LoadResult after = load_scene_text(
            std::string(text).replace(at, length,
                                      number.find('.') == std::string::npos ? number + "1" : number + "7"),
            name, options);
        if (!after.scene || after.world_hash != before.world_hash || mix_of(after) != mix) continue;
        ++untold;
        const bool same_camera = after.camera_hash == before.camera_hash;
        EXPECT_EQ(trace_world(after, same_camera), same_camera ? all : world)
            << name << ": " << text.substr(at > 40 ? at - 40 : 0, 80);
    }
    EXPECT_GT(untold, 4) << name; // those of cameras and of paint
}

TEST(SceneHashes, TellEveryNumberThatChangesTheLight) {
    TemporaryFolder folder;
    write_scene(folder, scene_text);
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    expect_hashes_tell(scene_text, "a.pnr");
    fs::current_path(before);
    expect_hashes_tell(default_scene_text(), "default.pnr");
}

TEST(DiskCache, DropsTheOldestEntries) {
    TemporaryFolder folder;
    DiskCache cache{folder.path() / "kept", 10'000};
    const std::vector<unsigned char> bytes(2000, 7);
    for (std::uint64_t key = 1; key <= 4; ++key) store_entry(cache, "x", key, bytes);
    const auto age = [&](std::uint64_t key, int minutes) {
        fs::last_write_time(entry_path(cache, "x", key),
                            fs::file_time_type::clock::now() - std::chrono::minutes(minutes));
    };
    for (const auto& [key, minutes] : {std::pair{1, 30}, {2, 40}, {3, 50}, {4, 20}})
        age(static_cast<std::uint64_t>(key), minutes);
    EXPECT_EQ(load_entry(cache, "x", 3), bytes); // used now: no longer the oldest
    store_entry(cache, "x", 5, bytes);
    EXPECT_FALSE(load_entry(cache, "x", 2));
    for (const std::uint64_t key : {1u, 3u, 4u, 5u}) EXPECT_TRUE(load_entry(cache, "x", key)) << key;
    store_entry(cache, "x", 6, std::vector<unsigned char>(2600, 1)); // more than a quarter
    EXPECT_FALSE(load_entry(cache, "x", 6));
    EXPECT_FALSE(load_entry(cache, "y", 1));
}

} // namespace
} // namespace pnr
