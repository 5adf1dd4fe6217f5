// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/internal_functions.h"

#include "core/internal_functions_impl.h"

#include <array>

namespace pnr {

namespace {

constexpr std::array<InternalFunction, 79> table{{
    {"f_algbr_cyl1", 8, curve_algbr_cyl1},
    {"f_algbr_cyl2", 8, curve_algbr_cyl2},
    {"f_algbr_cyl3", 8, curve_algbr_cyl3},
    {"f_algbr_cyl4", 8, curve_algbr_cyl4},
    {"f_bicorn", 5, algebraic_bicorn},
    {"f_bifolia", 5, algebraic_bifolia},
    {"f_blob", 8, shape_blob},
    {"f_blob2", 7, shape_blob2},
    {"f_boy_surface", 5, algebraic_boy_surface},
    {"f_comma", 4, nullptr},
    {"f_cross_ellipsoids", 7, shape_cross_ellipsoids},
    {"f_crossed_trough", 4, algebraic_crossed_trough},
    {"f_cubic_saddle", 4, algebraic_cubic_saddle},
    {"f_cushion", 4, algebraic_cushion},
    {"f_devils_curve", 4, algebraic_devils_curve},
    {"f_devils_curve_2d", 9, curve_devils_curve},
    {"f_dupin_cyclid", 9, algebraic_dupin_cyclid},
    {"f_ellipsoid", 6, shape_ellipsoid},
    {"f_enneper", 4, algebraic_enneper},
    {"f_flange_cover", 7, shape_flange_cover},
    {"f_folium_surface", 6, algebraic_folium_surface},
    {"f_folium_surface_2d", 9, curve_folium},
    {"f_glob", 4, algebraic_glob},
    {"f_heart", 4, algebraic_heart},
    {"f_helical_torus", 13, shape_helical_torus},
    {"f_helix1", 10, curve_helix1},
    {"f_helix2", 10, curve_helix2},
    {"f_hex_x", 4, shape_hex_x},
    {"f_hex_y", 4, shape_hex_y},
    {"f_hetero_mf", 9, noise_hetero_mf},
    {"f_hunt_surface", 4, algebraic_hunt_surface},
    {"f_hyperbolic_torus", 6, algebraic_hyperbolic_torus},
    {"f_isect_ellipsoids", 7, shape_isect_ellipsoids},
    {"f_kampyle_of_eudoxus", 6, algebraic_kampyle_of_eudoxus},
    {"f_kampyle_of_eudoxus_2d", 9, curve_kampyle_of_eudoxus},
    {"f_klein_bottle", 4, algebraic_klein_bottle},
    {"f_kummer_surface_v1", 4, algebraic_kummer_surface_v1},
    {"f_kummer_surface_v2", 7, algebraic_kummer_surface_v2},
    {"f_lemniscate_of_gerono", 4, algebraic_lemniscate_of_gerono},
    {"f_lemniscate_of_gerono_2d", 9, curve_lemniscate_of_gerono},
    {"f_mesh1", 8, shape_mesh1},
    {"f_mitre", 4, algebraic_mitre},
    {"f_nodal_cubic", 4, algebraic_nodal_cubic},
    {"f_odd", 4, algebraic_cushion},
    {"f_ovals_of_cassini", 7, algebraic_ovals_of_cassini},
    {"f_paraboloid", 4, algebraic_paraboloid},
    {"f_parabolic_torus", 6, algebraic_parabolic_torus},
    {"f_ph", 3, shape_ph},
    {"f_pillow", 4, algebraic_pillow},
    {"f_piriform", 4, algebraic_piriform},
    {"f_piriform_2d", 10, curve_piriform},
    {"f_poly4", 8, shape_poly4},
    {"f_polytubes", 9, shape_polytubes},
    {"f_quantum", 4, shape_quantum},
    {"f_quartic_paraboloid", 4, algebraic_quartic_paraboloid},
    {"f_quartic_saddle", 4, algebraic_quartic_saddle},
    {"f_quartic_cylinder", 6, algebraic_quartic_cylinder},
    {"f_r", 3, shape_r},
    {"f_ridge", 9, noise_ridge},
    {"f_ridged_mf", 9, noise_ridged_mf},
    {"f_rounded_box", 7, shape_rounded_box},
    {"f_sphere", 4, shape_sphere},
    {"f_spikes", 8, shape_spikes},
    {"f_spikes_2d", 7, shape_spikes_2d},
    {"f_spiral", 9, curve_spiral},
    {"f_steiners_roman", 4, algebraic_steiners_roman},
    {"f_strophoid", 7, algebraic_strophoid},
    {"f_strophoid_2d", 10, curve_strophoid},
    {"f_superellipsoid", 5, shape_superellipsoid},
    {"f_th", 3, shape_th},
    {"f_torus", 5, shape_torus},
    {"f_torus2", 6, algebraic_torus2},
    {"f_torus_gumdrop", 4, algebraic_torus_gumdrop},
    {"f_umbrella", 4, algebraic_umbrella},
    {"f_witch_of_agnesi", 5, algebraic_witch_of_agnesi},
    {"f_witch_of_agnesi_2d", 9, curve_witch_of_agnesi},
    {"f_noise3d", 3, nullptr}, // f_noise_generator with the scene's own: the parser knows it
    {"", 0, nullptr},          // POV-Ray's own, for patterns
    {"f_noise_generator", 4, noise_noise_generator},
}};

} // namespace

std::span<const InternalFunction> internal_functions() { return table; }

} // namespace pnr
