// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1.0 }
background { rgb <0.2, 0.3, 0.5> }
camera { location <0, 1.2, -9> look_at 0 angle 45 }
light_source { <-30, 40, -50>, rgb 1 }
plane { y, -2.2 pigment { rgb 0.6 } }
#default { pigment { rgb <1, 0.8, 0.4> } finish { specular 0.4 } }
quadric { <1, 2, 3>, <0.3, 0, 0>, <0, 0.2, 0>, -1 rotate 20 scale 0.8 translate <-3, 1.2, 0> }
quartic { <1, 0, 0, 0, 2, 0, 0, 2, 0, -2.32, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 1.68, 0, 0, 0, 0, 1, 0, -2.32, 0, 0.7056>
  sturm rotate 60*x scale 0.6 translate <-1, 1.2, 0> }
superellipsoid { <0.3, 0.4> rotate <20, 30, 0> scale 0.7 translate <1, 1.2, 0> }
superellipsoid { <3, 1.5> rotate <20, 30, 0> translate <3, 1.2, 0> }
ovus { 0.6, 0.3 rotate <20, 0, 20> translate <-3, -1, 0> }
difference {
  quadric { <1, 0, 1>, 0, 0, -0.5 }
  plane { y, -0.8 }
  plane { -y, -0.8 }
  poly { 2, <1, 0, 0, -1.4, 1, 0, 0, 1, 1.4, 0.6> }
  rotate <-30, 0, 20> translate <-1, -1, 0>
}
intersection {
  poly { 6, <1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, -0.1> }
  sphere { 0, 0.9 }
  rotate 30*y translate <1, -1, 0>
}
cubic { <1,0,0,0, 0,0,0,0,0,-1, 0,0,0,0,0,0,0,1,0,0> rotate 20*x clipped_by { sphere { 0, 0.9 } } translate <3, -1, 0> }
