// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2, -5> look_at 0 angle 40 right x*4/3 }
light_source { <4, 6, -5>, rgb 1 }
background { rgb <0.3,0.4,0.55> }
blob { threshold 0.4
  sphere { <-1,0,0>, 1.1, 1 pigment { rgb <1,0.2,0.1> } }
  sphere { <0.2,0.3,0>, 1, 1 pigment { rgb <0.1,0.9,0.2> } scale <1,1.3,1> }
  cylinder { <0.5,-0.6,0>, <1.5,0.5,-0.4>, 0.6, 1.2 pigment { rgb <0.2,0.3,1> } }
  sphere { <-0.3,0.6,-0.9>, 0.7, -0.8 }
  finish { phong 0.6 } }
plane { y, -1.2 pigment { checker rgb 0.9, rgb 0.6 } }
