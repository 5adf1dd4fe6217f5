// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 2, -6> look_at <0, 0.8, 0> angle 45 aperture 0.7 blur_samples 120 confidence 0.999 variance 0 focal_point <0, 1, 0> }
light_source { <-5, 10, -5>, rgb 1 }
plane { y, 0 pigment { checker rgb 0.9, rgb <0.2, 0.3, 0.6> } }
sphere { <0, 1, 0>, 0.8 pigment { checker rgb <0.9, 0.2, 0.1>, rgb 0.9 scale 0.3 } }
sphere { <-1.6, 0.6, -3>, 0.5 pigment { checker rgb <0.3, 0.8, 0.3>, rgb 0.2 scale 0.3 } }
sphere { <3, 1.6, 5>, 1.4 pigment { checker rgb <0.9, 0.8, 0.1>, rgb 0.2 scale 0.6 } }
