// SPDX-License-Identifier: GPL-3.0-or-later
// A rendering's intermediates as named channels of an EXR (design: the file contract).
#pragma once

#include "cli/pipeline.h"
#include "core/image_io.h"

#include <string>
#include <vector>

namespace pnr {

// Channels of the whole picture, float32, positions in scene space; the part has no name.
ImagePart gbuffer_part(const Rendering& r);     // gbuffer.exr
ImagePart sparse_part(const Rendering& r);      // sparse.exr
ImagePart informative_part(const Rendering& r); // informative.exr
ImagePart layer_part(const Layer& layer);       // R G B A

// The names that --aov knows, and one of them as a part of that name.
const std::vector<std::string>& aov_names();
ImagePart aov_part(const Rendering& r, const std::string& name);

// Some channels of a part, by name, in the order asked for.
ImagePart select_channels(const ImagePart& part, const std::vector<std::string>& channels);
// The part cut to a window of a picture `width` pixels wide.
ImagePart cut(const ImagePart& part, int width, const PixelRect& window);

// pnr:radius (the largest) and pnr:radius.ID of each painted object, in pixels of this picture.
Metadata radius_metadata(const Rendering& r);

// Whether one of these parts asks for direct, indirect, caustic and specular light apart.
bool wants_light_parts(const std::vector<std::string>& aovs);
// Throws UsageError for a part that there is not.
void check_aovs(const std::vector<std::string>& asked);

} // namespace pnr
