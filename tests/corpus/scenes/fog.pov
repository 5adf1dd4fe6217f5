// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1.0 }
background { rgb <0.3, 0.4, 0.7> }
camera { location <0, 3, -8> look_at <0, 1.5, 0> angle 55 }
light_source { <-20, 40, -20>, rgb 1 }
fog { distance 40 rgb <0.7, 0.7, 0.75> }
fog { fog_type 2 distance 8 rgbt <0.9, 0.85, 0.8, 0.1> fog_offset 0.4 fog_alt 0.6 }
plane { y, 0 pigment { checker rgb <0.2, 0.5, 0.2>, rgb <0.6, 0.4, 0.2> scale 2 } }
#for (I, 0, 6)
  cylinder { <-3 + I, 0, I * 4 - 3>, <-3 + I, 3, I * 4 - 3>, 0.4 pigment { rgb <0.8, 0.3, 0.2> } }
#end
sphere { <2.4, 1, -2>, 1 pigment { rgb 0.2 } finish { reflection 0.6 } }
