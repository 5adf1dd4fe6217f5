// SPDX-License-Identifier: GPL-3.0-or-later
#version 3.7;
global_settings { assumed_gamma 1.0 }
camera { location <0, 2, -7> look_at <0, 0.6, 0> angle 45 }
light_source { <-5, 8, -6>, rgb 1 }
light_source { <6, 3, -4>, rgb <0.3, 0.3, 0.5> }
plane { y, 0 pigment { checker rgb <0.8, 0.7, 0.5>, rgb <0.3, 0.35, 0.4> } finish { reflection { 0, 0.6 fresnel } } interior { ior 1.5 } }
sphere { <-2.2, 0.9, 0>, 0.9 pigment { rgb <0.8, 0.2, 0.1> } finish { ambient 0.1 diffuse 0.7 phong 0.8 phong_size 60 } }
sphere { <0, 0.9, 0>, 0.9 pigment { rgb <0.9, 0.7, 0.3> } finish { ambient 0.05 diffuse 0.4 specular 0.9 roughness 0.02 metallic reflection { 0.4 metallic } } }
sphere { <2.2, 0.9, 0>, 0.9 pigment { rgb <0.2, 0.5, 0.2> } finish { diffuse 0.8 brilliance 3 } }
