// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1.0 }
background { rgb <0.3, 0.4, 0.5> }
camera { location <0, 0, -9> look_at 0 angle 45 }
light_source { <-5, 8, -12>, rgb 1 }
light_source { <9, -3, -6>, rgb <0.2, 0.3, 0.4> }
#declare Clay = texture { pigment { rgb <0.9, 0.6, 0.3> } finish { ambient 0.1 diffuse 0.7 } }
#declare Jade = texture { pigment { rgb <0.2, 0.7, 0.4> } finish { ambient 0.3 diffuse 0.4 specular 0.6 } }
#declare Glazed = texture { Clay } texture { pigment { checker rgbf <0.9, 1, 0.4, 0.8>, rgbt <0.2, 0.3, 0.9, 0.4> scale 0.6 } finish { specular 0.5 roughness 0.02 } }
sphere { <-2.6, 1.3, 0>, 1.1 texture { Glazed } }
sphere { <0, 1.3, 0>, 1.1 texture { gradient y texture_map { [0.2 Clay] [0.8 Jade] } scale 1.4 rotate z * 20 } }
sphere { <2.6, 1.3, 0>, 1.1 texture { checker texture { Clay }, texture { Jade } scale 0.7 rotate 20 } }
sphere { <-2.6, -1.3, 0>, 1.1 texture { average texture_map { [1 Clay] [2 Jade finish { reflection 0.4 }] } } }
difference { sphere { <0, -1.3, 0>, 1.1 } box { <-2, -3, -3>, <2, 0, -0.3> } texture { Clay } interior_texture { Jade } }
cylinder { -0.8 * y, 0.8 * y, 0.8 open rotate <35, 0, 25> translate <2.6, -1.3, 0> texture { Clay } finish { diffuse 0.6, 0.4 irid { 0.3 thickness 0.4 } } interior_texture { pigment { gradient y color_map { [0.5 rgb 0.9] [0.5 rgb <0.8, 0.2, 0.1>] } scale 0.3 } } }
