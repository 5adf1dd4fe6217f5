// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 6, -8> look_at <0, 0, 0.5> angle 50 }
light_source { <-3, 5, 0>, rgb <1, 0.6, 0.4> spotlight point_at <-3, 0, 0> radius 12 falloff 25 tightness 10 }
light_source { <0, 5, 0>, rgb <0.5, 1, 0.5> cylinder point_at <0, 0, 0> radius 0.8 falloff 1.3 tightness 1 }
light_source { <3, 5, 0>, rgb <0.5, 0.6, 1> fade_distance 3 fade_power 2 }
light_source { <3, 4, -6>, rgb 0.2 parallel point_at <0, 0, 0> shadowless }
plane { y, 0 pigment { rgb 0.8 } }
box { <-0.3, 0, -0.3>, <0.3, 1, 0.3> translate <-2.8, 0, 0.6> pigment { rgb 1 } }
cylinder { <0.4, 0, 0.2>, <0.4, 1, 0.2>, 0.3 pigment { rgb 1 } }
cone { <3, 0, 0.6>, 0.5, <3, 1.2, 0.6>, 0 pigment { rgb 1 } }
torus { 0.8, 0.2 translate <1.4, 0.2, -2> pigment { rgb <1, 0.8, 0.6> } }
