// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 1.5, -4.5> look_at 0 angle 45 right x*4/3 }
light_source { <4, 6, -5>, rgb 1 }
background { rgb <0.3,0.4,0.55> }
julia_fractal { <-0.083,0,-0.83,-0.025> quaternion sqr max_iteration 8 precision 60 pigment { rgb <0.9,0.7,0.4> } finish { phong 0.4 } translate -1.2*x }
julia_fractal { <0.2,0.3,0.1,0.2> hypercomplex sqr max_iteration 7 precision 60 slice <0.2,0.1,0,1>, 0.1 pigment { rgb <0.4,0.6,0.9> } rotate 30*y translate 1.2*x }
