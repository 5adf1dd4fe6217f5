// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1 }
camera { orthographic location <2,1,-5> look_at <2,1,0> right x*4.4 up y*3.3 }
light_source { <2, 3, -50>, rgb 1 }
background { rgb <0.3,0.4,0.55> }
#declare T1 = texture { pigment { rgb <1,0.1,0.1> } }
#declare T2 = texture { pigment { checker rgb 1, rgb <0,0.5,0> scale 0.2 } }
#declare T3 = texture { pigment { gradient x color_map { [0 rgb <0,0,1>] [1 rgb <1,1,0>] } scale 0.5 } }
mesh2 { vertex_vectors { 4, <0,0,0>, <1,0,0>, <0,1,0>, <1,1,0> }
  normal_vectors { 4, <-0.5,-0.5,-1>, <0.5,-0.5,-1>, <-0.5,0.5,-1>, <0.5,0.5,-1> }
  texture_list { 3, texture { T1 } texture { T2 } texture { T3 } }
  face_indices { 2, <0,1,2>, 0, 1, 2, <1,3,2>, 1 } translate <0.1,0.1,0> }
mesh { triangle { <0,0,0>, <1,0,0>, <0,1,0> texture { T2 } } triangle { <1,0,0>, <1,1,0>, <0,1,0> texture_list { T1 T3 T2 } }
  smooth_triangle { <0,1,0>, <-1,0,-1>, <1,1,0>, <1,0,-1>, <0.5,1.8,0>, <0,1,-1> } pigment { rgb <1,0,1> } translate <1.5,0,0> }
mesh2 { vertex_vectors { 4, <0,0,0>, <1,0,0>, <0,1,0>, <1,1,0> } uv_vectors { 4, <0,0>, <2,0>, <0,2>, <2,2> }
  face_indices { 2, <0,1,2>, <1,3,2> } texture { uv_mapping pigment { checker rgb 1, rgb <0.8,0.3,0> scale 0.25 } } translate <2.8,0.2,0> }
sphere { 0, 0.6 texture { uv_mapping pigment { checker rgb 1, rgb <0,0.3,0.8> scale 0.1 } } translate <0.8,1.9,0> }
box { -0.4, 0.4 texture { uv_mapping pigment { checker rgb 1, rgb <0.5,0.3,0.8> scale 0.05 } } rotate <20,30,0> translate <3.2,2,0> }
torus { 0.4, 0.2 texture { uv_mapping pigment { checker rgb 1, rgb <0.1,0.6,0.5> scale 0.1 } } rotate -60*x translate <2.1,2.1,0> }
