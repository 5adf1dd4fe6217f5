// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <2.2, 1.8, -3.2> look_at <0,-0.1,0> angle 42 right x*4/3 }
light_source { <4, 6, -5>, rgb 1 }
light_source { <-5, 2, -3>, rgb <0.2,0.25,0.35> }
background { rgb <0.3,0.4,0.55> }
isosurface { function { sin(4*x)*cos(4*y) + sin(4*y)*cos(4*z) + sin(4*z)*cos(4*x) }
  contained_by { sphere { 0, 1 } } max_gradient 10 accuracy 0.001
  pigment { rgb <0.85,0.6,0.3> } finish { phong 0.5 } translate -1.1*x }
isosurface { function { pow(abs(x),3) + pow(abs(y),3) + pow(abs(z),3) - 0.4 + 0.05*sin(20*x) } contained_by { box { -0.9, 0.9 } } max_gradient 5
  pigment { rgb <0.4,0.7,0.5> } translate <1.1,0,0> }
plane { y, -1 pigment { checker rgb 0.9, rgb 0.6 } }
