// SPDX-License-Identifier: GPL-3.0-or-later
// The families of internal functions, each in its own file; internal_functions.cpp has the table.
// a[0], a[1], a[2] are x, y, z; a[3] ... the function's own arguments.
#pragma once

#include <cmath>

namespace pnr {

inline double sqr(double v) { return v * v; }
inline double cube(double v) { return v * v * v; }

// ---- internal_algebraic.cpp: polynomials in x, y, z; of most the first argument is a factor, the "field
// strength"

double algebraic_bicorn(const double* a);
double algebraic_bifolia(const double* a);
double algebraic_boy_surface(const double* a);
double algebraic_crossed_trough(const double* a);
double algebraic_cubic_saddle(const double* a);
double algebraic_cushion(const double* a);
double algebraic_devils_curve(const double* a);
double algebraic_dupin_cyclid(const double* a);
double algebraic_enneper(const double* a);
double algebraic_folium_surface(const double* a);
double algebraic_glob(const double* a);
double algebraic_heart(const double* a);
double algebraic_hunt_surface(const double* a);
double algebraic_hyperbolic_torus(const double* a);
double algebraic_kampyle_of_eudoxus(const double* a);
double algebraic_klein_bottle(const double* a);
double algebraic_kummer_surface_v1(const double* a);
double algebraic_kummer_surface_v2(const double* a);
double algebraic_lemniscate_of_gerono(const double* a);
double algebraic_mitre(const double* a);
double algebraic_nodal_cubic(const double* a);
double algebraic_ovals_of_cassini(const double* a);
double algebraic_paraboloid(const double* a);
double algebraic_parabolic_torus(const double* a);
double algebraic_pillow(const double* a);
double algebraic_piriform(const double* a);
double algebraic_quartic_paraboloid(const double* a);
double algebraic_quartic_saddle(const double* a);
double algebraic_quartic_cylinder(const double* a);
double algebraic_steiners_roman(const double* a);
double algebraic_strophoid(const double* a);
double algebraic_torus2(const double* a);
double algebraic_torus_gumdrop(const double* a);
double algebraic_umbrella(const double* a);
double algebraic_witch_of_agnesi(const double* a);

// ---- internal_curves.cpp: plane curves, drawn out along z or turned about y

double curve_algbr_cyl1(const double* a);
double curve_algbr_cyl2(const double* a);
double curve_algbr_cyl3(const double* a);
double curve_algbr_cyl4(const double* a);
double curve_devils_curve(const double* a);
double curve_folium(const double* a);
double curve_kampyle_of_eudoxus(const double* a);
double curve_lemniscate_of_gerono(const double* a);
double curve_piriform(const double* a);
double curve_strophoid(const double* a);
double curve_witch_of_agnesi(const double* a);
double curve_helix1(const double* a);
double curve_helix2(const double* a);
double curve_spiral(const double* a);

// ---- internal_shapes.cpp: distances and the rest

double shape_blob(const double* a);
double shape_blob2(const double* a);
double shape_comma(const double* a);
double shape_cross_ellipsoids(const double* a);
double shape_ellipsoid(const double* a);
double shape_flange_cover(const double* a);
double shape_helical_torus(const double* a);
double shape_hex_x(const double* a);
double shape_hex_y(const double* a);
double shape_isect_ellipsoids(const double* a);
double shape_mesh1(const double* a);
double shape_ph(const double* a);
double shape_poly4(const double* a);
double shape_polytubes(const double* a);
double shape_quantum(const double* a);
double shape_r(const double* a);
double shape_rounded_box(const double* a);
double shape_sphere(const double* a);
double shape_spikes(const double* a);
double shape_spikes_2d(const double* a);
double shape_superellipsoid(const double* a);
double shape_th(const double* a);
double shape_torus(const double* a);

// ---- internal_noise.cpp: sums of noise

double noise_hetero_mf(const double* a);
double noise_ridge(const double* a);
double noise_ridged_mf(const double* a);
double noise_noise_generator(const double* a);

} // namespace pnr
