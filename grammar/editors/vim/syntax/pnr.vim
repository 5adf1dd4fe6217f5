" SPDX-License-Identifier: GPL-3.0-or-later
" Scenes of pnr. Made from its keyword table by `pnr help --editor vim`.
if exists('b:current_syntax')
    finish
endif
syntax case match
syntax keyword pnrBlock bicubic_patch blob bounded_by box bump_map camera clipped_by color_map cone contained_by cubic
syntax keyword pnrBlock cylinder difference disc emitter face_indices finish fog global_settings height_field ilic image_map
syntax keyword pnrBlock image_pattern interior interior_texture interpolation intersection irid isosurface julia_fractal
syntax keyword pnrBlock lathe layer light_group light_source looks_like material merge mesh mesh2 mesh_camera normal
syntax keyword pnrBlock normal_map npr object ovus parametric pattern photons pigment pigment_map pigment_pattern plane poly
syntax keyword pnrBlock polygon polynomial prism projected_through quadric quartic radiosity rainbow rbf reflection seed
syntax keyword pnrBlock seeds sky_sphere slope_map smooth_triangle sor sphere sphere_sweep spline superellipsoid text
syntax keyword pnrBlock texture texture_list texture_map tiles tone torus transform triangle union warp
syntax keyword pnrValue abs acos acosh asc asin asinh atan atan2 atanh bitwise_and bitwise_or bitwise_xor blue ceil chr
syntax keyword pnrValue clock clock_on concat cos cosh cubic_spline datetime defined degrees dimension_size dimensions div
syntax keyword pnrValue exp false file_exists filter floor gray green inside int linear_spline ln log max max_extent min
syntax keyword pnrValue min_extent mod natural_spline no now off on pi pow prod quadratic_spline radians rand red rgb rgbf
syntax keyword pnrValue rgbft rgbt select sin sinh sqrt srgb srgbf srgbft srgbt str strcmp strlen strlwr strupr substr sum t
syntax keyword pnrValue tan tanh tau trace transmit true u v val vaxis_rotate vcross vdot version vlength vnormalize vrotate
syntax keyword pnrValue vstr vturbulence x y yes z
syntax keyword pnrItem aa_level aa_threshold absorption absorption_probability accuracy adaptive adc_bailout agate
syntax keyword pnrItem agate_turb albedo all all_intersections along alpha altitude always_sample ambient ambient_light
syntax keyword pnrItem angle aoi aperture append arc_angle area_illumination area_light around array ascii assumed_gamma
syntax keyword pnrItem atan2d autostop average axis b_spline background bare bezier_spline biharmonic black_hole blur
syntax keyword pnrItem blur_samples bokeh boxed bozo brick brick_size brightness brilliance bump_size bumps caustics cell
syntax keyword pnrItem cells charset checker circular clip clock_delta collect color component composite confidence
syntax keyword pnrItem conic_sweep conserve_energy contrast control0 control1 coords count crackle crand cube cubic_wave
syntax keyword pnrItem curvature_max curvature_min cutaway_textures cylindrical density density_file density_map dents
syntax keyword pnrItem deprecated df3 diffuse direction dispersion dispersion_samples dist_exp distance double_illuminate
syntax keyword pnrItem eccentricity edge emission error_bound evaluate expand_thresholds exponent exr exterior extinction
syntax keyword pnrItem facets fade_color fade_distance fade_power falloff falloff_angle field file fill final_clock
syntax keyword pnrItem final_frame fisheye flatness flip focal_point fog_alt fog_offset fog_type folds form frame_number
syntax keyword pnrItem frequency fresnel function gamma gather gaussian geodesic gif global global_lights gradient granite
syntax keyword pnrItem gray_threshold h_angle hdr height hemisphere hexagon hf_gray_16 hierarchy hollow hypercomplex iff
syntax keyword pnrItem image_height image_width importance initial_clock initial_frame input_file_name inside_vector
syntax keyword pnrItem internal interpolate intervals inverse ior irid_wavelength jitter jpeg julia kernel lambda length
syntax keyword pnrItem leopard light linear linear_sweep load_file location look_at low_error_factor magnet major_radius
syntax keyword pnrItem mandel map_type marble material_map matrix max_gradient max_intersections max_iteration max_sample
syntax keyword pnrItem max_trace max_trace_level maximum_reuse media media_attenuation media_interaction metallic method
syntax keyword pnrItem metric minimum_reuse mix mm_per_unit mortar nearest nearest_count neighbours no_bump_scale no_image
syntax keyword pnrItem no_radiosity no_reflection no_shadow noise noise_generator normal_indices normal_vectors
syntax keyword pnrItem number_of_sides number_of_tiles number_of_waves octaves offset omega omnimax once onion opacity open
syntax keyword pnrItem orient orientation orthographic panoramic paper_mode parallel pass_through perspective pgm phase
syntax keyword pnrItem phong phong_size planar png point_at poly_wave pot power ppm precision precompute premultiplied
syntax keyword pnrItem pretrace_end pretrace_start pwr quaternion quick_color quilted radial radiance radius ramp ramp_wave
syntax keyword pnrItem random ratio reciprocal rectangle recursion_limit reflection_exponent refraction relief repair
syntax keyword pnrItem repeat right ripples rotate roughness samples saturation save_file scale scallop_wave scattering
syntax keyword pnrItem shadowless shoulder simplify sine_wave sint16be sint16le sint32be sint32le sint8 size sky slice
syntax keyword pnrItem slope smooth solid spacing specular specular_probability spherical spiral1 spiral2 split_union
syntax keyword pnrItem spotlight spotted sqr square step straight strength sturm style subdivide subsurface sys target tga
syntax keyword pnrItem thickness threshold tiff tightness tile2 tiling tolerance toroidal translate translucency
syntax keyword pnrItem triangle_wave triangular triharmonic ttf turb_depth turbulence type u_steps uint16be uint16le uint8
syntax keyword pnrItem ultra_wide_angle up use_alpha use_color use_index utf8 uv_indices uv_mapping uv_vectors v_angle
syntax keyword pnrItem v_steps variance vertex_vectors view warm water_level waves weight width wood wrinkles xyz
syntax match pnrDirective "#\s*\%(break\|case\|debug\|declare\|default\|else\|elseif\|end\|error\|fclose\|fopen\|for\|if\|ifdef\|ifndef\|include\|local\|macro\|range\|read\|render\|statistics\|switch\|undef\|version\|warning\|while\|write\)\>"
syntax match pnrNumber "\<\d\+\%(\.\d*\)\?\%([eE][-+]\?\d\+\)\?\|\.\d\+\%([eE][-+]\?\d\+\)\?"
syntax region pnrString start=+"+ skip=+\\\\\|\\"+ end=+"+
syntax match pnrComment "//.*$"
syntax region pnrComment start="/\*" end="\*/" contains=pnrComment
highlight default link pnrBlock Type
highlight default link pnrValue Function
highlight default link pnrItem Statement
highlight default link pnrDirective PreProc
highlight default link pnrNumber Number
highlight default link pnrString String
highlight default link pnrComment Comment
let b:current_syntax = 'pnr'
