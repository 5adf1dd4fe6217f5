// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 1.5, -6> look_at <0, 1.6, 0> angle 70 }
light_source { <-20, 40, -20>, rgb 1 }
sky_sphere {
  pigment { gradient y color_map { [0 rgb <0.9, 0.75, 0.6>] [0.3 rgb <0.4, 0.55, 0.9>] [1 rgb <0.05, 0.1, 0.4>] } scale 2 translate -1 }
  pigment { gradient x color_map { [0.45 rgbt 1] [0.5 rgbt <1, 1, 0.9, 0.2>] [0.55 rgbt 1] } scale 2 translate -1 rotate 30 * z }
}
plane { y, 0 pigment { rgb <0.3, 0.5, 0.3> } }
sphere { <0, 1.5, 0>, 1.3 pigment { rgb 0.1 } finish { ambient 0 diffuse 0.2 reflection 0.8 } }
