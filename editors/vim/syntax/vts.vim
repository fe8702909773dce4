" Vim syntax: vts, a scene description language for volumetric textures, and POV-Ray's SDL.
" Written by editors/make.sh from editors/templates/syntax.vim: change that one.
if exists("b:current_syntax")
  finish
endif
let s:cpo = &cpo
set cpo&vim
syn case match
syn iskeyword @,48-57,_

syn keyword vtsFunction abs acos acosh asc asin asinh atan atan2 atanh bitwise_and bitwise_or bitwise_xor ceil chr concat
syn keyword vtsFunction cos cosh cube datetime defined degrees dimension_size dimensions div exp fbm file_exists floor geo
syn keyword vtsFunction geo_inverse geodesic inside int internal ln log lsystem_count lsystem_string max max_extent min
syn keyword vtsFunction min_extent mod perlin pow prod radians rand seed select sin sinh sparse_convolution sqr sqrt str
syn keyword vtsFunction strcmp strlen strlwr strupr substr sum sun_direction tan tanh terrain_height trace utm val
syn keyword vtsFunction vaxis_rotate vcross vdot vlength vnormalize vrotate vstr vturbulence wind_at worley
syn keyword vtsConstant clock clock_delta clock_on false final_clock final_frame frame_number image_height image_width
syn keyword vtsConstant initial_clock initial_frame no now off on pi t true u v version x y yes z
syn keyword vtsColor color colour rgb rgbf rgbft rgbt srgb srgbf srgbft srgbt
syn keyword vtsWord aa_level aa_threshold absorption accuracy adaptive adc_bailout agate agate_turb albedo all
syn keyword vtsWord all_intersections alpha altitude always_sample ambient ambient_light angle anisotropy aoi aperture
syn keyword vtsWord append arc_angle area_illumination area_light array ascii assumed_gamma autostop average b_spline
syn keyword vtsWord background bezier_spline bicubic_patch black_hole blob blue blur_samples bokeh bounded_by box boxed
syn keyword vtsWord bozo brick brick_size brightness brilliance bump_map bump_size bumps camera caustics cells charset
syn keyword vtsWord checker circular clipped_by collect color_map colour_map component composite cone confidence
syn keyword vtsWord conic_sweep conserve_energy contained_by control0 control1 coords crackle crand cubic cubic_spline
syn keyword vtsWord cubic_wave cutaway_textures cylinder cylindrical density_file density_map dents deprecated df3
syn keyword vtsWord difference diffuse direction disc dispersion dispersion_samples dist_exp distance double_illuminate
syn keyword vtsWord eccentricity emission error_bound evaluate expand_thresholds exponent exterior extinction
syn keyword vtsWord face_indices facets fade_color fade_colour fade_distance fade_power falloff falloff_angle filter
syn keyword vtsWord finish fisheye flatness flip focal_point fog fog_alt fog_offset fog_type form frequency fresnel
syn keyword vtsWord function gamma gather gif global_lights gradient granite gray gray_threshold green height_field
syn keyword vtsWord hexagon hf_gray_16 hierarchy hollow hypercomplex iff image_map image_pattern importance
syn keyword vtsWord inside_vector interior interior_texture interpolate intersection intervals inverse ior irid
syn keyword vtsWord irid_wavelength jpeg julia julia_fractal lambda lathe leopard light_group linear_spline
syn keyword vtsWord linear_sweep load_file location look_at looks_like low_error_factor magnet major_radius mandel
syn keyword vtsWord map_type marble material material_map matrix max_gradient max_intersections max_iteration
syn keyword vtsWord max_sample max_trace max_trace_level maximum_reuse media media_attenuation media_interaction merge
syn keyword vtsWord mesh mesh2 mesh_camera metallic method metric minimum_reuse mm_per_unit mortar natural_spline
syn keyword vtsWord nearest_count no_bump_scale no_image no_radiosity no_reflection no_shadow noise_generator normal
syn keyword vtsWord normal_indices normal_map normal_vectors number_of_sides number_of_tiles number_of_waves object
syn keyword vtsWord octaves offset omega omnimax once onion open orient orientation orthographic ovus panoramic
syn keyword vtsWord parallel parametric pass_through pattern pavement perspective pgm phong phong_size photons pigment
syn keyword vtsWord pigment_map pigment_pattern planar plane png point_at poly poly_wave polygon pot ppm precision
syn keyword vtsWord precompute premultiplied pretrace_end pretrace_start prism projected_through pwr quadratic_spline
syn keyword vtsWord quadric quartic quaternion quick_color quick_colour quilted radial radiosity radius rainbow
syn keyword vtsWord ramp_wave ratio reciprocal recursion_limit red reflection reflection_exponent refraction repeat
syn keyword vtsWord right ripples rotate roughness samples save_file scale scallop_wave scattering shadowless sine_wave
syn keyword vtsWord sint16be sint16le sint32be sint32le sint8 size sky sky_sphere slice slope slope_map smooth
syn keyword vtsWord smooth_triangle solid sor spacing specular sphere sphere_sweep spherical spiral1 spiral2 spline
syn keyword vtsWord split_union spotlight spotted square strength sturm subsurface superellipsoid sys target text
syn keyword vtsWord texture texture_list texture_map tga thickness threshold tiff tightness tile2 tiles tiling
syn keyword vtsWord tolerance toroidal torus transform translate translucency transmit triangle triangle_wave
syn keyword vtsWord triangular ttf turb_depth type u_steps uint16be uint16le uint8 ultra_wide_angle union up use_alpha
syn keyword vtsWord use_color use_colour use_index utf8 uv_indices uv_mapping uv_vectors v_steps variance
syn keyword vtsWord vertex_vectors warp water_level waves width wood wrinkles
syn match vtsWord "\<\%(count\|density\|global_settings\|isosurface\|jitter\|light_source\|phase\|polynomial\|turbulence\)\>" display

syn match vtsNumber "\%(\h\w*\)\@<!\%(\d\+\.\=\d*\|\.\d\+\)\%([eE][-+]\=\d\+\)\=" display
syn match vtsMember "\.\%([xyztuv]\|red\|green\|blue\|filter\|transmit\|gray\)\>" display
syn match vtsCall "\<\h\w*\ze\s*(" display
syn match vtsDirective "#\s*\%(break\|case\|debug\|declare\|default\|else\|elseif\|end\|error\|fclose\|fopen\|for\|if\|ifdef\|ifndef\|include\|local\|macro\|range\|read\|render\|statistics\|switch\|undef\|version\|warning\|while\|write\)\>" display
syn match vtsName "\%(#\s*\%(declare\|local\|undef\|macro\)\s\+\%(deprecated\s\+\)\=\)\@40<=\h\w*" display

syn region vtsBraces start="{" end="}" transparent fold contains=TOP
syn region vtsIn_texel matchgroup=vtsBlock start="\<texel\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_texel "\<\%(bounds\|resolution\|cyclic\|layer\|phases\|choose\|period\|auto\)\>\%(\s*{\)\@!" contained containedin=vtsIn_texel
hi def link vtsItem_texel vtsItem
syn region vtsIn_layer matchgroup=vtsBlock start="\<layer\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn region vtsIn_phases matchgroup=vtsBlock start="\<phases\>[^{}#;]\{-}{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_phases "\<\%(layer\)\>\%(\s*{\)\@!" contained containedin=vtsIn_phases
hi def link vtsItem_phases vtsItem
syn region vtsIn_lsystem matchgroup=vtsBlock start="\<lsystem\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_lsystem "\<\%(axiom\|define\|rule\|ignore\|iterations\|angle\|step\|width\|taper\|tropism\|seed\|symbol\|max_segments\|parts\|branches\|symbols\)\>\%(\s*{\)\@!" contained containedin=vtsIn_lsystem
hi def link vtsItem_lsystem vtsItem
syn region vtsIn_particles matchgroup=vtsBlock start="\<particles\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_particles "\<\%(count\)\>\%(\s*{\)\@!" contained containedin=vtsIn_particles
hi def link vtsItem_particles vtsItem
syn region vtsIn_count matchgroup=vtsBlock start="\<count\>[^{}#;]\{-}{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_count "\<\%(position\|velocity\|acceleration\|life\|width\|profile\|twist\)\>\%(\s*{\)\@!" contained containedin=vtsIn_count
hi def link vtsItem_count vtsItem
syn region vtsIn_surface matchgroup=vtsBlock start="\<surface\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_surface "\<\%(deform\|uv\|mesh\|subdivide\|auto\|height_vectors\|w_vectors\|patch_grid\|points\)\>\%(\s*{\)\@!" contained containedin=vtsIn_surface
hi def link vtsItem_surface vtsItem
syn region vtsIn_skin matchgroup=vtsBlock start="\<skin\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_skin "\<\%(mapping\|jitter\|tiling\|plain\|wang\|wind_field\|springs\)\>\%(\s*{\)\@!" contained containedin=vtsIn_skin
hi def link vtsItem_skin vtsItem
syn region vtsIn_mapping matchgroup=vtsBlock start="\<mapping\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_mapping "\<\%(repeat\|tile\|height\|comb\|w\)\>\%(\s*{\)\@!" contained containedin=vtsIn_mapping
hi def link vtsItem_mapping vtsItem
syn region vtsIn_jitter matchgroup=vtsBlock start="\<jitter\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_jitter "\<\%(coordinates\|scale\|height\|direction\|instance\|seed\)\>\%(\s*{\)\@!" contained containedin=vtsIn_jitter
hi def link vtsItem_jitter vtsItem
syn region vtsIn_instance matchgroup=vtsBlock start="\<instance\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_instance "\<\%(displace\|rotate\|scale\|mirror\|density\|tint\)\>\%(\s*{\)\@!" contained containedin=vtsIn_instance
hi def link vtsItem_instance vtsItem
syn region vtsIn_springs matchgroup=vtsBlock start="\<springs\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_springs "\<\%(stiffness\|damping\)\>\%(\s*{\)\@!" contained containedin=vtsIn_springs
hi def link vtsItem_springs vtsItem
syn region vtsIn_wind_field matchgroup=vtsBlock start="\<wind_field\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_wind_field "\<\%(direction\|speed\|strength\|gust\|turbulence\|stiffness\)\>\%(\s*{\)\@!" contained containedin=vtsIn_wind_field
hi def link vtsItem_wind_field vtsItem
syn region vtsIn_gust matchgroup=vtsBlock start="\<gust\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_gust "\<\%(wavelength\|amplitude\|sharpness\)\>\%(\s*{\)\@!" contained containedin=vtsIn_gust
hi def link vtsItem_gust vtsItem
syn region vtsIn_turbulence matchgroup=vtsBlock start="\<turbulence\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_turbulence "\<\%(amplitude\|scale\|octaves\|seed\)\>\%(\s*{\)\@!" contained containedin=vtsIn_turbulence
hi def link vtsItem_turbulence vtsItem
syn region vtsIn_density matchgroup=vtsBlock start="\<density\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_density "\<\%(df3\|nanovdb\|grid\|raw\|uint8\|uint16\|float\|little\|big\|fractal\|threshold\|extinction\)\>\%(\s*{\)\@!" contained containedin=vtsIn_density
hi def link vtsItem_density vtsItem
syn region vtsIn_fractal matchgroup=vtsBlock start="\<fractal\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_fractal "\<\%(size\|dimension\|threshold\|seed\)\>\%(\s*{\)\@!" contained containedin=vtsIn_fractal
hi def link vtsItem_fractal vtsItem
syn region vtsIn_volume matchgroup=vtsBlock start="\<volume\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_volume "\<\%(scattering\|absorption\|phase\|orders\|rays\|method\|step\|storage\|two_pass\|published\|path\|auto\|all\|isotropic\|directional\)\>\%(\s*{\)\@!" contained containedin=vtsIn_volume
hi def link vtsItem_volume vtsItem
syn region vtsIn_phase matchgroup=vtsBlock start="\<phase\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_phase "\<\%(isotropic\|rayleigh\|hazy\|murky\|henyey_greenstein\|schlick\|sum\)\>\%(\s*{\)\@!" contained containedin=vtsIn_phase
hi def link vtsItem_phase vtsItem
syn region vtsIn_animation matchgroup=vtsBlock start="\<animation\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_animation "\<\%(frames\|fps\|clock\|cyclic\|shutter\)\>\%(\s*{\)\@!" contained containedin=vtsIn_animation
hi def link vtsItem_animation vtsItem
syn region vtsIn_cloth matchgroup=vtsBlock start="\<cloth\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_cloth "\<\%(size\|grid\|pin\|mass\|stiffness\|damping\|elongation\|gravity\|left\|right\|top\|bottom\|corners\)\>\%(\s*{\)\@!" contained containedin=vtsIn_cloth
hi def link vtsItem_cloth vtsItem
syn region vtsIn_terrain matchgroup=vtsBlock start="\<terrain\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_terrain "\<\%(heightmap\|georeference\|origin\|exaggeration\|curvature\|geoid\|nodata\|fill\|hole\|detail\|auto\|full\)\>\%(\s*{\)\@!" contained containedin=vtsIn_terrain
hi def link vtsItem_terrain vtsItem
syn region vtsIn_georeference matchgroup=vtsBlock start="\<georeference\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_georeference "\<\%(lonlat\|utm\|registration\|area\|point\|north\|south\)\>\%(\s*{\)\@!" contained containedin=vtsIn_georeference
hi def link vtsItem_georeference vtsItem
syn region vtsIn_isosurface matchgroup=vtsBlock start="\<isosurface\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_isosurface "\<\%(detail\|interval\|affine\|reduced_affine\|reduced_affine_optimised\|auto\|full\)\>\%(\s*{\)\@!" contained containedin=vtsIn_isosurface
hi def link vtsItem_isosurface vtsItem
syn region vtsIn_global_settings matchgroup=vtsBlock start="\<global_settings\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_global_settings "\<\%(max_error\|geo_origin\|opacity_model\|ray_path\|quadrature\|filtering\|detail\|shadow_aperture\|sky_light\)\>\%(\s*{\)\@!" contained containedin=vtsIn_global_settings
hi def link vtsItem_global_settings vtsItem
syn region vtsIn_light_source matchgroup=vtsBlock start="\<light_source\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_light_source "\<\%(goniometric\|ies\)\>\%(\s*{\)\@!" contained containedin=vtsIn_light_source
hi def link vtsItem_light_source vtsItem
syn region vtsIn_polynomial matchgroup=vtsBlock start="\<polynomial\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn match vtsItem_polynomial "\<\%(xyz\)\>\%(\s*{\)\@!" contained containedin=vtsIn_polynomial
hi def link vtsItem_polynomial vtsItem
syn region vtsIn_height_vectors matchgroup=vtsBlock start="\<height_vectors\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP
syn region vtsIn_w_vectors matchgroup=vtsBlock start="\<w_vectors\>\s*{" matchgroup=vtsBlock end="}" fold contains=TOP

" Without `contains`, what the block around them may hold.
syn region vtsFold matchgroup=vtsDirective start="#\s*\%(if\|ifdef\|ifndef\|while\|for\|switch\|macro\)\>" end="#\s*end\>" transparent fold

syn match vtsEscape "\\\%(u\x\{4}\|.\)" contained
syn region vtsString start=+"+ skip=+\\.+ end=+"+ contains=vtsEscape,@Spell
syn keyword vtsTodo TODO FIXME XXX contained
syn match vtsComment "//.*$" contains=vtsTodo,@Spell
syn region vtsComment start="/\*" end="\*/" contains=vtsComment,vtsTodo,@Spell fold
syn sync minlines=300

hi def link vtsFunction Function
hi def link vtsConstant Constant
hi def link vtsColor Type
hi def link vtsWord Statement
hi def link vtsBlock Type
hi def link vtsItem Identifier
hi def link vtsNumber Number
hi def link vtsMember Identifier
hi def link vtsCall Function
hi def link vtsDirective PreProc
hi def link vtsName Identifier
hi def link vtsString String
hi def link vtsEscape SpecialChar
hi def link vtsComment Comment
hi def link vtsTodo Todo

let b:current_syntax = "vts"
let &cpo = s:cpo
unlet s:cpo
