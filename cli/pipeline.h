// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's pipeline as five calls: build_world, trace_photons, make_gbuffer, paint, render [LW10 Fig. 1];
// then `over` puts the painted layer over the photoreal one. Every intermediate is a value that can be looked
// at.
#pragma once

#include "cli/passes.h"
#include "cli/reuse.h"
#include "core/gbuffer.h"
#include "core/photon_map.h"
#include "core/plan.h"
#include "core/progressive.h"
#include "core/render.h"
#include "core/scene.h"
#include "core/world.h"
#include "npr/paint.h"
#include "parser/limits.h"

#include <filesystem>
#include <functional>
#include <optional>

namespace pnr {

// `--time`, `--error`, `--passes`: render in passes until the first of these says enough.
struct Refinement {
    std::optional<double> time_s; // of the whole run, from the process's start to the written file
    std::optional<double> error;  // progressive.h: relative_error_90
    std::optional<int> passes;
};

// What a rendering has got, piece by piece: the G-buffer; the painting's maps and layer; some of the photoreal light.
enum class RenderedPart { seen, paint, light };

// What is wanted beside the picture.
struct Wishes {
    std::optional<CropWord> crop;
    bool maps = false;        // every intermediate must exist, also where the scene does not need it
    bool light_parts = false; // direct, indirect, caustic and specular light apart
    std::filesystem::path save_photons, load_photons; // empty: no
    std::optional<Refinement> refinement;
    // Called between two progressive passes when a signal asks for the picture so far.
    std::function<void(const struct Rendering&)> show;
    Budgets budgets; // pixels and photons
    // Called after each progressive pass, whose means are in r.rendered; false ends the run.
    std::function<bool(struct Rendering&)> after_pass;
    // Of progressive passes: camera samples and shadow rays drawn as of this seed, whatever the photons' is.
    std::optional<std::uint64_t> sample_seed;
    // Called with World::notes, once that is built.
    std::function<void(const std::vector<std::string>&)> before_passes;
    // Called with each part that is there; light comes in bands of rows, or in passes of the whole.
    std::function<void(const struct Rendering&, RenderedPart, const PixelRect&)> on_part;
};

// All that a rendering leaves behind. Images have the picture's full size; pixels outside `window` are 0.
struct Rendering {
    Settings settings; // with the picture's size filled in
    PixelRect window;  // the crop, or the whole picture
    World world;
    Plan plan;
    PhotonMap photons;
    GBuffer gbuffer;
    PaintResult paint; // empty images if nothing is painted and no maps are wanted
    RenderResult rendered;
    Layer picture; // linear; empty if the passes were stopped before there was anything to show
    SampleFaults faults;
    std::vector<FaultPlace> fault_places;
    ProgressiveSum progressive; // 0 passes if the picture was rendered in one go
    int passes_done = 0;        // what --passes must be to have this picture again
    double asked_error = 0;     // --error; 0: not asked for
    ErrorEstimate error;        // empty without enough passes
    double reached_error = infinity; // relative_error_90 of it
    bool stopped = false; // by a signal: `picture` shows what there was
};

// The size of the picture: what the settings say, the missing side from the camera's shape.
PictureSize picture_size(const Camera& camera, const RenderSettings& settings);

// The passes that a rendering runs, in their order: what its plan needs but for what is kept of earlier ones.
std::vector<std::string> passes_to_run(const Rendering& r, const Wishes& wishes);

// Throws SceneError if more photons are asked for than may be.
void check_photons(const Scene& scene, const World& world, const Settings& settings, const Budgets& budgets);

// Puts the two layers together as r.picture and counts what no file can hold.
void complete_picture(Rendering& r);
// Pass 2 [LW10 3.2]: sparse map, orientation, informative map, ILIC.
// `sources`: the sparse map, if it is known. `strokes`: the last step is done too.
PaintResult paint(const Rendering& r, Passes& passes, std::optional<SparseMap> sources, bool strokes = true);
// Pass 1 [LW10 3.1] and its kd-tree. `shrink`: see progressive.h.
PhotonMap make_photons(const Rendering& r, const Settings& settings, int batch, double shrink, bool field, Passes& passes);
// Smooth indirect light over a map that has its tree, where the scene needs it.
void add_field(const Rendering& r, const Settings& settings, double shrink, PhotonMap& map, Passes& passes);

// What is kept of earlier renderings is taken where it is just what this one would make. Throws SceneError, FileError,
// UsageError (a crop that leaves the picture, a picture or a photon map larger than the budgets allow).
Rendering render_scene(const Scene& scene, const Settings& settings, const Wishes& wishes, Reuse& reuse,
                       Passes& passes);

// The world, the plan and the sizes of a rendering to come, and what it would find kept.
Rendering plan_rendering(const Scene& scene, const Settings& settings, const Wishes& wishes, Reuse& reuse,
                         Passes& passes);

} // namespace pnr
