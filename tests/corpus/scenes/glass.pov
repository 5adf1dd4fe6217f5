// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 8 }
background { rgb <0.3, 0.4, 0.6> }
camera { location <0, 2, -6> look_at <0, 0.8, 0> angle 45 }
light_source { <-4, 7, -5>, rgb 1 }
plane { y, 0 pigment { checker rgb 0.9, rgb 0.2 } }
sphere { <-1.2, 1, 0>, 1 pigment { rgbf <0.9, 1, 0.95, 0.9> } finish { diffuse 0.1 specular 0.6 reflection { 0.05, 0.9 } } interior { ior 1.5 } }
box { <0.6, 0, -0.6>, <1.8, 1.6, 0.6> pigment { rgbt <1, 0.4, 0.3, 0.7> } interior { ior 1.3 fade_distance 1 fade_power 2 } }
