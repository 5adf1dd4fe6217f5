// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 4, -8> look_at <0, 0.7, 0> angle 42 }
light_source { <-3, 6, -3>, rgb 1 area_light 2.5 * x, 2.5 * z, 9, 9 adaptive 2 jitter circular orient }
light_source { <5, 5, -2>, rgb <0.2, 0.25, 0.4> area_light <1, 0, 0>, <0, 1, 0>, 5, 5 adaptive 1 area_illumination on }
plane { y, 0 pigment { rgb 0.9 } }
sphere { <-1.2, 1, 0>, 0.8 pigment { rgb <0.9, 0.5, 0.3> } finish { phong 0.5 } }
box { <0.7, 0, -0.6>, <1.7, 1.8, 0.4> pigment { rgb <0.4, 0.6, 0.9> } }
cylinder { <3, 0, 1.4>, <3, 2.4, 1.4>, 0.1 pigment { rgb 1 } }
