// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1.0 }
background { rgb <0.3, 0.4, 0.5> }
camera { location <0, 0, -9> look_at 0 angle 50 }
light_source { <-5, 8, -12>, rgb 1 }
light_source { <9, -3, -6>, rgb <0.2, 0.3, 0.4> }
#default { pigment { rgb <0.8, 0.7, 0.6> } finish { ambient 0.05 diffuse 0.8 } }
sphere { <-3, 1.4, 0>, 1 normal { bumps 0.8 scale 0.3 } }
sphere { <-1, 1.4, 0>, 1 normal { gradient y, 1.5 sine_wave scale 0.4 } }
sphere { <1, 1.4, 0>, 1 normal { ripples 0.4 scale 0.5 } }
sphere { <3, 1.4, 0>, 1 normal { onion 1 slope_map { [0 <0, 1>] [0.5 <1, 0>] [1 <0, -1>] } scale 0.3 translate z } }
sphere { <-3, -1.4, 0>, 1 normal { average normal_map { [1 dents 2 scale 0.2] [1 gradient x, 0.6 triangle_wave scale 0.3] } } }
sphere { <-1, -1.4, 0>, 1 normal { quilted 1.5 control0 0.4 control1 0.9 scale 0.6 } }
sphere { <1, -1.4, 0>, 1 normal { wrinkles 0.8 scale 0.4 no_bump_scale } }
sphere { <3, -1.4, 0>, 1 normal { checker normal { bumps 0.7 scale 0.1 } normal { waves 0.3 scale 0.3 } scale 0.7 } }
