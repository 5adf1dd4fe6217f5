// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1.0 }
background { rgb <0.2, 0.3, 0.5> }
camera { location <0, 1.2, -10> look_at 0 angle 45 }
light_source { <-30, 40, -50>, rgb 1 }
plane { y, -2.5 pigment { rgb 0.6 } }
#default { pigment { rgb <1, 0.8, 0.4> } finish { specular 0.4 } }
difference {
  lathe { cubic_spline 7, <0, -1.2>, <0, -1>, <0.8, -0.5>, <0.4, 0>, <0.6, 0.5>, <0, 1>, <-1, 1> }
  box { 0, <2, 2, -2> }
  rotate <-30, 0, 20> translate <-3, 1.6, 0>
}
lathe { quadratic_spline 5, <0.2, -1>, <0.6, -0.8>, <0.8, 0>, <0.3, 0.5>, <0.7, 0.9> rotate -30*x translate <-1, 1.6, 0> }
sor { 6, <0, -1.5>, <0.5, -1>, <0.8, -0.4>, <0.3, 0.3>, <0.5, 0.9>, <0.7, 1.3> open rotate -30*x scale 0.9 translate <1, 1.6, 0> }
lathe { bezier_spline 8, <0, -1>, <1.4, -1>, <0.2, 0>, <0.6, 0.2>, <0.6, 0.2>, <1, 0.4>, <0.7, 0.9>, <0, 0.8> rotate -30*x translate <3, 1.6, 0> }
prism { cubic_spline -0.4, 0.4, 9, <1, -1>, <-0.8, -0.7>, <0, -0.3>, <0.8, -0.7>, <0.7, 0.6>, <0, 0.8>, <-0.7, 0.5>, <-0.8, -0.7>, <0, -1>
  rotate <-60, 20, 0> translate <-3, -0.4, 0> }
prism { conic_sweep linear_spline 0.3, 1, 8, <-1, -1>, <1, -1>, <1, 1>, <-1, -1>, <0.3, -0.6>, <0.7, -0.6>, <0.7, -0.2>, <0.3, -0.6>
  rotate <160, 20, 0> translate <-1, 0.3, 0> }
intersection {
  prism { bezier_spline linear_sweep -1, 1, 8, <-0.8, -0.8>, <0, -0.2>, <0.5, -1>, <0.9, -0.6>, <0.9, -0.6>, <1, 0.5>, <-1, 1>, <-0.8, -0.8> }
  sphere { 0, 0.9 }
  rotate <-40, 30, 0> translate <1, -0.4, 0>
}
polygon { 10, <-0.7, -0.7>, <0.7, -0.7>, <0.7, 0.7>, <-0.7, 0.7>, <-0.7, -0.7>, <-0.3, -0.3>, <0.3, -0.3>, <0.4, 0.5>, <-0.3, 0.3>, <-0.3, -0.3>
  rotate <20, 30, 10> translate <3, -0.4, 0> }
sphere_sweep { cubic_spline 6, <-1, -0.5, 0>, 0.1, <-0.8, 0, 0>, 0.3, <0, 0.5, -0.5>, 0.1, <0.5, -0.5, 0>, 0.3, <0.9, 0.2, 0.5>, 0.15, <1, 1, 0>, 0.1
  tolerance 1e-6 translate <-2.6, -1.9, 0> }
sphere_sweep { b_spline 5, <-1, -0.5, 0>, 0.1, <-0.8, 0, 0>, 0.3, <0, 0.9, -0.5>, 0.2, <0.7, -0.9, 0>, 0.3, <0.9, 0.9, 0.5>, 0.3
  tolerance 1e-6 translate <0, -1.9, 0> }
sphere_sweep { linear_spline 4, <-0.7, -0.5, 0>, 0.1, <-0.5, 0.5, 0>, 0.3, <0.3, 0.3, -0.5>, 0.2, <0.7, -0.6, 0>, 0.3 translate <2.4, -1.9, 0> }
