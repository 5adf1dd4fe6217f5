// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 2.0, -3> look_at 0 angle 42 right x*4/3 }
light_source { <4, 6, -5>, rgb 1 }
background { rgb <0.3,0.4,0.55> }
parametric { function { u } function { 0.3*sin(4*u)*cos(3*v) } function { v - 0.2*u*u }
  <-1,-1>, <1,1> contained_by { box { <-1,-0.5,-1>, <0.9,0.2,1> } } max_gradient 2 accuracy 0.003 precompute 15 x,y,z
  pigment { rgb <0.8,0.5,0.3> } finish { phong 0.5 } }
