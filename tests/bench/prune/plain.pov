// SPDX-License-Identifier: GPL-3.0-or-later
// What POV-Ray renders too: no photons, no paint.
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.6, -4.4> look_at <0, 0.7, 0> right x angle 44 }
light_source { <3, 5, -4>, rgb 1 }
background { rgb <0.5, 0.7, 0.9> }
plane { y, 0 pigment { checker rgb 0.9 rgb 0.4 } }
sphere { <-0.6, 0.55, 0.2>, 0.55 pigment { bozo color_map { [0 rgb <0.9, 0.7, 0.4>] [1 rgb <0.4, 0.2, 0.1>] } scale 0.3 } finish { phong 0.6 } }
torus { 0.48, 0.15 rotate 70 * x translate <0.7, 0.62, 0.6> pigment { rgb <0.4, 0.6, 0.8> } finish { specular 0.4 reflection 0.1 } }
box { -0.3, 0.3 rotate 30 * y translate <0.8, 0.3, -0.8> pigment { rgb <0.8, 0.8, 0.6> } normal { bumps 0.4 scale 0.05 } }
