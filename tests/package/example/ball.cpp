// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/picture_files.h"
#include "parser/load_scene.h"

int main() {
    const pnr::LoadResult loaded = pnr::load_scene_text(R"(
        camera { location <0, 1, -5> look_at <0, 1, 0> }
        light_source { <-2, 5, -4>, rgb 1 emitter { sphere 0.5 } power 900 }
        plane { y, 0 pigment { rgb 0.8 } }
        sphere { <0, 1, 0>, 1 pigment { rgb <0.9, 0.5, 0.2> } npr { style oil } })",
                                                        "ball", {});
    if (!loaded.scene) return 1;
    pnr::Settings settings = loaded.settings;
    settings.render.height = 96;
    pnr::Passes passes(pnr::ProgressMode::off, true);
    pnr::Reuse reuse;
    const pnr::Rendering picture = pnr::render_scene(*loaded.scene, settings, {}, reuse, passes);
    pnr::write_picture(*loaded.scene, picture, {}, passes.times(), "ball.png");
    pnr::write_picture(*loaded.scene, picture, {}, passes.times(), "ball.exr");
}
