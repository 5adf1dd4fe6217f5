// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0.5, 1.1, -1.2> look_at <0.5,0.1,0.5> angle 45 right x*4/3 }
light_source { <4, 4, -2>, rgb 1 }
background { rgb <0.5,0.6,0.8> }
height_field { function 60, 50 { 0.5 + 0.25*sin(9*x)*cos(7*y) + 0.1*sin(31*x*y) } smooth water_level 0.35
  pigment { rgb <0.6,0.75,0.4> } scale <1,0.6,1> }
height_field { function 9, 9 { 0.8*x*y } pigment { rgb <0.8,0.4,0.3> } scale <0.4,0.4,0.4> translate <0.9,0.2,-0.1> }
plane { y, 0.2 pigment { rgb <0.3,0.4,0.8> } }
