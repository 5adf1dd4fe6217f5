// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/reuse.h"

#include "cli/pipeline.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace pnr {

namespace {

namespace fs = std::filesystem;

// ---- keys

void add(Hasher& hash, Vec3 v) {
    for (int i = 0; i < 3; ++i) hash.add(v[i]);
}

// What all values hang on.
Hasher base_hash(const SceneIdentity& scene, const World& world) {
    Hasher hash;
    hash.add(build_identity());
    hash.add(scene.world);
    hash.add(scene.assets.hash);
    if (scene.assets.pictures_or_fonts) hash.add(reader_identity());
    hash.add(std::uint64_t{world.objects.size()});
    hash.add(std::uint64_t{world.surfaces.size()});
    hash.add(std::uint64_t{world.materials.size()});
    hash.add(std::uint64_t{world.lights.size()});
    hash.add(world.radius);
    add(hash, world.offset);
    hash.add(static_cast<std::uint64_t>(world.illumination));
    hash.add(std::uint64_t{world.caustics_apart});
    for (const WorldObject& object : world.objects) {
        hash.add(std::uint64_t{object.npr});
        add(hash, object.bounds.low);
        add(hash, object.bounds.high);
    }
    return hash;
}

// Whoever adds a setting asks here whether results hang on it: then it belongs into the keys.
static_assert(sizeof(PhotonSettings) == 40 && sizeof(RenderSettings) == 128 && sizeof(RadiositySettings) == 48,
              "a new setting?");

void add_photon_settings(Hasher& hash, const PhotonSettings& s) {
    hash.add(std::uint64_t{s.wanted});
    hash.add(std::uint64_t{s.global ? 1u + *s.global : 0u});
    hash.add(static_cast<std::uint64_t>(s.count));
    hash.add(s.spacing);
    hash.add(static_cast<std::uint64_t>(s.gather_min));
    hash.add(static_cast<std::uint64_t>(s.gather_max));
    hash.add(s.radius);
}

// All but what concerns the written picture alone.
void add_render_settings(Hasher& hash, const RenderSettings& s) {
    hash.add(static_cast<std::uint64_t>(s.width));
    hash.add(static_cast<std::uint64_t>(s.height));
    hash.add(s.seed);
    hash.add(static_cast<std::uint64_t>(s.samples_min));
    hash.add(static_cast<std::uint64_t>(s.samples_max));
    hash.add(s.contrast);
    for (const double value : {s.grid.threshold, static_cast<double>(s.grid.depth), s.grid.jitter,
                               s.grid.gamma, s.grid.value_gamma})
        hash.add(value);
    hash.add(static_cast<std::uint64_t>(s.gather_effort));
    hash.add(std::uint64_t{s.sharp});
    hash.add(static_cast<std::uint64_t>(s.max_trace_level));
    hash.add(s.adc_bailout);
    hash.add(static_cast<std::uint64_t>(s.shadow_samples));
    hash.add(static_cast<std::uint64_t>(s.integrator));
}

void add_radiosity_settings(Hasher& hash, const RadiositySettings& s) {
    for (const double value : {s.brightness, static_cast<double>(s.recursion_limit), s.gray_threshold,
                               static_cast<double>(s.count), s.error_bound, s.normal ? 1.0 : 0.0})
        hash.add(value);
}

void add_photon_keys(Hasher hash, const Rendering& r, ReuseKeys& keys) {
    hash.add(r.settings.render.seed);
    add_photon_settings(hash, r.settings.photons);
    hash.add(std::uint64_t{r.plan.normals});
    hash.add(std::uint64_t{r.plan.kdtree});
    keys.photons_about = hash.value;
    keys.focus = plan_emission(r.world, r.settings.photons).focus;
    add(hash, keys.focus.center);
    hash.add(keys.focus.radius);
    keys.photons = hash.value;
}

bool stands_in(const Focus& focus, Vec3 place) { return glm::distance(place, focus.center) <= focus.radius; }

std::uint64_t seen_key(Hasher hash, const SceneIdentity& scene, const Rendering& r) {
    hash.add(scene.camera);
    add(hash, r.world.camera.location);
    add(hash, r.world.camera.direction);
    add(hash, r.world.camera.right);
    add(hash, r.world.camera.up);
    add_render_settings(hash, r.settings.render);
    for (const WorldObject& object : r.world.objects)
        hash.add(std::uint64_t{object.npr && object.paint.mix > 0});
    for (const int side : {r.window.x0, r.window.y0, r.window.x1, r.window.y1})
        hash.add(static_cast<std::uint64_t>(side));
    return hash.value;
}

std::uint64_t joined_key(const ReuseKeys& keys, const Rendering& r, std::string_view what) {
    Hasher hash;
    hash.add(what);
    hash.add(keys.photons);
    hash.add(keys.seen);
    add_radiosity_settings(hash, r.settings.radiosity);
    for (const WorldObject& object : r.world.objects) hash.add(object.npr ? object.paint.mix : 0.0);
    return hash.value;
}

// ---- values as bytes

struct Writer {
    std::vector<unsigned char> bytes;

    template <class T>
    void add(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto* from = reinterpret_cast<const unsigned char*>(&value);
        bytes.insert(bytes.end(), from, from + sizeof(T));
    }
    template <class T>
    void add(const Image<T>& image) {
        static_assert(std::is_trivially_copyable_v<T>);
        add(image.width);
        add(image.height);
        const auto* from = reinterpret_cast<const unsigned char*>(image.pixels.data());
        bytes.insert(bytes.end(), from, from + image.pixels.size() * sizeof(T));
    }
    template <class T>
    void add(const std::vector<T>& values) {
        add(values.size());
        for (const T& value : values) add(value);
    }
};

struct Reader {
    const std::vector<unsigned char>& bytes;
    std::size_t at = 0;
    bool whole = true; // nothing was missing so far

    template <class T>
    void take(T& value) {
        if (bytes.size() - at < sizeof(T)) {
            whole = false;
            return;
        }
        std::memcpy(&value, bytes.data() + at, sizeof(T));
        at += sizeof(T);
    }
    template <class T>
    void take(Image<T>& image, int width, int height) {
        int w = 0, h = 0;
        take(w);
        take(h);
        const std::size_t size =
            static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * sizeof(T);
        whole = whole && w == width && h == height && bytes.size() - at >= size;
        if (!whole) return;
        image = Image<T>(width, height);
        std::memcpy(static_cast<void*>(image.pixels.data()), bytes.data() + at, size);
        at += size;
    }
    template <class T>
    void take(std::vector<T>& values) {
        std::size_t count = 0;
        take(count);
        whole = whole && count <= (bytes.size() - at) / sizeof(T);
        if (!whole) return;
        values.resize(count);
        for (T& value : values) take(value);
    }
    bool done() const { return whole && at == bytes.size(); }
};

std::vector<unsigned char> bytes_of(const GBuffer& seen) {
    Writer out;
    out.bytes.reserve(seen.seen.pixels.size() * (sizeof(Seen) + sizeof(float)) + 64);
    out.add(seen.window);
    out.add(seen.seen);
    out.add(seen.coverage);
    return std::move(out.bytes);
}

std::vector<unsigned char> bytes_of(const RenderResult& light) {
    Writer out;
    out.bytes.reserve(light.layer.color.pixels.size() * (sizeof(Color) + sizeof(float)) + 128);
    out.add(light.faults);
    out.add(light.fault_places);
    out.add(light.camera_rays);
    out.add(light.gathers);
    out.add(light.layer.color);
    out.add(light.layer.alpha);
    return std::move(out.bytes);
}

// Those pixels alone that hold something.
std::vector<unsigned char> bytes_of(const SparseMap& sources) {
    Writer out;
    for (std::size_t i = 0; i < sources.pixels.size(); ++i) {
        if (sources.pixels[i].object == 0) continue;
        out.add(static_cast<std::uint64_t>(i));
        out.add(sources.pixels[i]);
    }
    return std::move(out.bytes);
}

// ---- what is said about it

constexpr const char* in_memory =
    "nothing but camera or paint has changed since the rendering before: its map is used again";
constexpr const char* on_disk =
    "nothing but camera or paint has changed since an earlier run: its map is used again";
constexpr const char* paint_in_memory =
    "nothing but paint has changed since the rendering before: its result is used again";
constexpr const char* paint_on_disk =
    "nothing but paint has changed since an earlier run: its result is used again";

void say(Rendering& r, const char* what, const char* why) { r.plan.left_out.push_back({what, why}); }

template <class T>
bool take_kept(std::uint64_t key, std::uint64_t& kept_key, T& kept, T& to) {
    if (key == 0 || kept_key != key) return false;
    to = std::move(kept);
    kept_key = 0;
    return true;
}

// The entry is whole and yet of no use.
bool refuse(const Reuse& reuse, const char* kind, std::uint64_t key) {
    drop_entry(entry_path(*reuse.disk, kind, key));
    return false;
}

bool fits_world(const GBuffer& seen, const World& world) {
    return std::all_of(seen.seen.pixels.begin(), seen.seen.pixels.end(), [&](const Seen& s) {
        return s.object < world.objects.size() && s.via < world.objects.size() &&
               (s.object == 0 || s.surface < world.surfaces.size());
    });
}

} // namespace

SceneIdentity identity_of(const LoadResult& loaded) {
    return {loaded.world_hash, loaded.camera_hash, loaded.paint_hash, read_assets(loaded.assets)};
}

void find_keys(Reuse& reuse, const Rendering& r, const Wishes& wishes) {
    reuse.keys = {};
    const bool whole_run = !wishes.refinement && wishes.load_photons.empty() && r.settings.render.prune;
    if (!reuse.scene || !whole_run || reuse.scene->assets.hash == 0 || !unchanged(reuse.scene->assets))
        return;
    const Hasher base = base_hash(*reuse.scene, r.world);
    if (r.plan.photons) {
        add_photon_keys(base, r, reuse.keys);
        const ReuseKeys& before = reuse.kept;
        if (reuse.film && before.photons_about == reuse.keys.photons_about &&
            stands_in(before.focus, r.world.camera.location)) {
            reuse.keys.photons = before.photons;
            reuse.keys.focus = before.focus;
        }
    }
    if (!r.plan.paint) return; // without paint it is the same picture or another one
    reuse.keys.seen = seen_key(base, *reuse.scene, r);
    reuse.keys.sources = joined_key(reuse.keys, r, "sources");
    if (!wishes.light_parts) reuse.keys.light = joined_key(reuse.keys, r, "light");
}

bool take_photons(Reuse& reuse, Rendering& r) {
    const std::uint64_t key = reuse.keys.photons;
    if (take_kept(key, reuse.kept.photons, reuse.photons, r.photons)) {
        say(r, "photons", in_memory);
        return true;
    }
    if (key == 0 || !reuse.disk) return false;
    const fs::path entry = entry_path(*reuse.disk, "photons", key);
    try {
        std::error_code error;
        if (!fs::exists(entry, error)) return false;
        r.photons = load_photons(key, entry);
    } catch (const std::runtime_error&) { // damaged, or of another form
        drop_entry(entry);
        r.photons = {};
        return false;
    }
    mark_used(entry);
    say(r, "photons", on_disk);
    return true;
}

bool take_seen(Reuse& reuse, Rendering& r) {
    const std::uint64_t key = reuse.keys.seen;
    if (take_kept(key, reuse.kept.seen, reuse.seen, r.gbuffer)) {
        say(r, "gbuffer", paint_in_memory);
        return true;
    }
    if (key == 0 || !reuse.disk) return false;
    const auto bytes = load_entry(*reuse.disk, "seen", key);
    if (!bytes) return false;
    GBuffer seen;
    seen.view = {r.world.camera, r.settings.render.width, r.settings.render.height};
    Reader in{*bytes};
    in.take(seen.window);
    in.take(seen.seen, seen.view.width, seen.view.height);
    in.take(seen.coverage, seen.view.width, seen.view.height);
    if (!in.done() || !fits_world(seen, r.world)) return refuse(reuse, "seen", key);
    r.gbuffer = std::move(seen);
    say(r, "gbuffer", paint_on_disk);
    return true;
}

bool take_sources(Reuse& reuse, Rendering& r) {
    const std::uint64_t key = reuse.keys.sources;
    if (take_kept(key, reuse.kept.sources, reuse.sources, r.paint.sparse)) {
        say(r, "sparse", paint_in_memory);
        return true;
    }
    if (key == 0 || !reuse.disk) return false;
    const auto bytes = load_entry(*reuse.disk, "sources", key);
    if (!bytes) return false;
    SparseMap sources(r.settings.render.width, r.settings.render.height);
    Reader in{*bytes};
    while (in.whole && !in.done()) {
        std::uint64_t pixel = 0;
        SourcePixel source;
        in.take(pixel);
        in.take(source);
        in.whole = in.whole && pixel < sources.pixels.size() && source.object < r.world.objects.size() &&
                   source.photon < static_cast<std::int64_t>(r.photons.photons.size());
        if (in.whole) sources.pixels[pixel] = source;
    }
    if (!in.done()) return refuse(reuse, "sources", key);
    r.paint.sparse = std::move(sources);
    say(r, "sparse", paint_on_disk);
    return true;
}

bool take_light(Reuse& reuse, Rendering& r) {
    const std::uint64_t key = reuse.keys.light;
    if (take_kept(key, reuse.kept.light, reuse.light, r.rendered)) {
        say(r, "render", paint_in_memory);
        return true;
    }
    if (key == 0 || !reuse.disk) return false;
    const auto bytes = load_entry(*reuse.disk, "light", key);
    if (!bytes) return false;
    RenderResult light;
    Reader in{*bytes};
    in.take(light.faults);
    in.take(light.fault_places);
    in.take(light.camera_rays);
    in.take(light.gathers);
    in.take(light.layer.color, r.settings.render.width, r.settings.render.height);
    in.take(light.layer.alpha, r.settings.render.width, r.settings.render.height);
    if (!in.done()) return refuse(reuse, "light", key);
    r.rendered = std::move(light);
    say(r, "render", paint_on_disk);
    return true;
}

void store_on_disk(const Reuse& reuse, const Rendering& r) {
    if (!reuse.disk || !reuse.scene || r.stopped || !unchanged(reuse.scene->assets)) return;
    const DiskCache& disk = *reuse.disk;
    const auto is_new = [&](const char* what, std::uint64_t key) {
        return key != 0 && std::none_of(r.plan.left_out.begin(), r.plan.left_out.end(),
                                        [&](const LeftOut& left) { return left.what == what; });
    };
    if (is_new("photons", reuse.keys.photons) &&
        may_store(disk, r.photons.photons.size() * (sizeof(Photon) + sizeof(Vec3f)))) {
        try {
            save_photons(r.photons, reuse.keys.photons, entry_path(disk, "photons", reuse.keys.photons));
        } catch (const FileError&) { // not kept
        }
    }
    if (is_new("gbuffer", reuse.keys.seen)) store_entry(disk, "seen", reuse.keys.seen, bytes_of(r.gbuffer));
    if (is_new("sparse", reuse.keys.sources))
        store_entry(disk, "sources", reuse.keys.sources, bytes_of(r.paint.sparse));
    if (is_new("render", reuse.keys.light))
        store_entry(disk, "light", reuse.keys.light, bytes_of(r.rendered));
    drop_oldest(disk);
}

void keep(Reuse& reuse, Rendering& r) {
    reuse.kept = reuse.keys;
    if (r.stopped) { // passes that were not finished have left nothing
        reuse.kept.light = 0;
        if (r.photons.photons.empty()) reuse.kept.photons = reuse.kept.photons_about = 0;
        if (r.gbuffer.seen.empty()) reuse.kept.seen = 0;
        if (r.paint.sparse.empty()) reuse.kept.sources = 0;
    }
    reuse.photons = std::move(r.photons);
    reuse.seen = std::move(r.gbuffer);
    reuse.sources = std::move(r.paint.sparse);
    reuse.light = std::move(r.rendered);
}

void note_stored(const Reuse& reuse, Rendering& r) {
    if (!reuse.disk) return;
    const auto note = [&](const char* what, const char* kind, std::uint64_t key, const char* why) {
        std::error_code error;
        if (key != 0 && fs::exists(entry_path(*reuse.disk, kind, key), error)) say(r, what, why);
    };
    note("photons", "photons", reuse.keys.photons, on_disk);
    note("gbuffer", "seen", reuse.keys.seen, paint_on_disk);
    note("sparse", "sources", reuse.keys.sources, paint_on_disk);
    note("render", "light", reuse.keys.light, paint_on_disk);
}

} // namespace pnr
