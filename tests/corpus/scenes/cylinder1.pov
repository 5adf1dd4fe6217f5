// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1.0 }
background { rgb <0.3, 0.4, 0.7> }
camera { cylinder 1 location <0, 2, -3> look_at <0, 1, 0> angle 150 right x * 4 / 3 up y }
light_source { <-5, 10, -5>, rgb 1 }
plane { y, 0 pigment { checker rgb 0.9, rgb <0.7, 0.2, 0.2> } }
sphere { <0, 1, 0>, 1 pigment { rgb <0.3, 0.8, 0.4> } finish { phong 0.6 } }
box { <2, 0, 1>, <3, 3, 2> pigment { rgb <0.9, 0.8, 0.2> } }
box { <-4, 0, -1>, <-3, 2, 0> pigment { rgb <0.2, 0.4, 0.9> } }
