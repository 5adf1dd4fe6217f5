// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 10 }
background { rgb <0.3, 0.4, 0.6> }
camera { location <0, 2.5, -7> look_at <0, 0.8, 0> angle 48 }
light_source { <-4, 9, -6>, rgb 1 }
plane { y, 0 pigment { checker rgb 0.8, rgb <0.5, 0.3, 0.2> } }
#declare Clear = finish { ambient 0 diffuse 0.1 specular 0.5 reflection { 0.05, 0.8 } conserve_energy }
difference { sphere { <-2.2, 1, 0>, 1 } sphere { <-2.2, 1, 0>, 0.8 } pigment { rgbf <0.9, 1, 0.9, 0.9> } finish { Clear } interior { ior 1.5 } }
sphere { <0, 1, 0>, 1 pigment { rgbt <1, 1, 1, 0.9> } finish { Clear } interior { ior 1.3 caustics 0.6 fade_distance 1.5 fade_power 1 fade_color <0.9, 0.6, 0.3> } }
sphere { <0.1, 0.9, 0.1>, 0.5 pigment { rgbt <1, 1, 1, 0.9> } finish { Clear } interior { ior 1.6 } }
box { <1.3, 0, -0.8>, <2.7, 1.4, 0.6> pigment { rgbt <0.6, 0.9, 1, 0.8> } finish { Clear } interior { ior 1.4 fade_distance 1 fade_power 1001 fade_color <0.3, 0.7, 0.9> } rotate y * 10 }
