// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/structures.h"

#include "core/geometry.h"
#include "core/irradiance_field.h"

namespace pnr {

namespace {

template <class T>
double weight(const std::vector<T>& values) {
    return static_cast<double>(values.size() * sizeof(T));
}
template <class T>
double weight(const Image<T>& image) {
    return weight(image.pixels);
}
double weight(const Layer& layer) { return weight(layer.color) + weight(layer.alpha); }
double weight(const KdTree& tree) {
    return weight(tree.x) + weight(tree.y) + weight(tree.z) + weight(tree.order) + weight(tree.nodes);
}
double weight(const LightParts& parts) {
    return weight(parts.direct) + weight(parts.indirect) + weight(parts.caustic) + weight(parts.specular) +
           weight(parts.photon_density);
}

} // namespace

std::vector<StructureSize> structure_sizes(const Rendering& r) {
    const PhotonMap& map = r.photons;
    const double bvh = r.world.geometry ? static_cast<double>(geometry_stats(*r.world.geometry).bytes) : 0;
    return {{"bvh", bvh},
            {"photons", weight(map.photons) + weight(map.normals)},
            {"kdtree", weight(map.tree) + weight(map.caustic)},
            {"field", map.field ? static_cast<double>(field_bytes(*map.field)) : 0},
            {"gbuffer", weight(r.gbuffer.seen) + weight(r.gbuffer.coverage)},
            {"paint", weight(r.paint.sparse) + weight(r.paint.informative) + weight(r.paint.oriented) +
                          weight(r.paint.layer)},
            {"picture", weight(r.rendered.layer) + weight(r.rendered.parts) + weight(r.picture)}};
}

} // namespace pnr
