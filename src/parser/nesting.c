/* What never stands in what: in text whose brackets do not match, it tells where a '}' is missing. */
#include "parser/parser.h"

enum {
    GROUP_SOLID = 1,
    GROUP_SET = 2,
    GROUP_SCENE = 4,
    GROUP_PIGMENT = 8,
    GROUP_NORMAL = 16,
    GROUP_FINISH = 32,
    GROUP_TEXTURE = 64,
    GROUP_INTERIOR = 128,
    GROUP_LIGHT = 256
};
enum {
    GROUP_OBJECTS = GROUP_SOLID | GROUP_SET | GROUP_LIGHT,
    GROUP_LOOKS = GROUP_PIGMENT | GROUP_NORMAL | GROUP_FINISH | GROUP_TEXTURE
};

static int group_of(int keyword) {
    switch (keyword) {
    case KW_sphere:
    case KW_box:
    case KW_cylinder:
    case KW_cone:
    case KW_plane:
    case KW_torus:
    case KW_disc:
    case KW_triangle:
    case KW_smooth_triangle:
    case KW_height_field:
    case KW_lathe:
    case KW_sor:
    case KW_prism:
    case KW_polygon:
    case KW_poly:
    case KW_cubic:
    case KW_quartic:
    case KW_quadric:
    case KW_superellipsoid:
    case KW_sphere_sweep:
    case KW_text:
    case KW_bicubic_patch:
    case KW_mesh2: return GROUP_SOLID;
    case KW_union:
    case KW_merge:
    case KW_intersection:
    case KW_difference:
    case KW_object: return GROUP_SET;
    case KW_camera:
    case KW_global_settings:
    case KW_background:
    case KW_fog:
    case KW_sky_sphere: return GROUP_SCENE;
    case KW_light_source: return GROUP_LIGHT;
    case KW_pigment: return GROUP_PIGMENT;
    case KW_normal: return GROUP_NORMAL;
    case KW_finish: return GROUP_FINISH;
    case KW_texture: return GROUP_TEXTURE;
    case KW_interior: return GROUP_INTERIOR;
    default: return 0;
    }
}

bool nesting_never(int outer, int inner) {
    int in = group_of(inner);
    switch (group_of(outer)) {
    case GROUP_SOLID: return in & (GROUP_OBJECTS | GROUP_SCENE);
    case GROUP_SET: return in & GROUP_SCENE;
    case GROUP_LIGHT: return in & (GROUP_OBJECTS | GROUP_SCENE | GROUP_LOOKS);
    case GROUP_SCENE:
        return in & (GROUP_OBJECTS | GROUP_SCENE | GROUP_FINISH | GROUP_TEXTURE | GROUP_INTERIOR);
    case GROUP_PIGMENT:
        return in &
               (GROUP_OBJECTS | GROUP_SCENE | GROUP_NORMAL | GROUP_FINISH | GROUP_TEXTURE | GROUP_INTERIOR);
    case GROUP_NORMAL:
        return in &
               (GROUP_OBJECTS | GROUP_SCENE | GROUP_PIGMENT | GROUP_FINISH | GROUP_TEXTURE | GROUP_INTERIOR);
    case GROUP_FINISH: return in & (GROUP_OBJECTS | GROUP_SCENE | GROUP_LOOKS | GROUP_INTERIOR);
    case GROUP_TEXTURE: return in & (GROUP_OBJECTS | GROUP_SCENE | GROUP_INTERIOR);
    case GROUP_INTERIOR: return in & (GROUP_OBJECTS | GROUP_SCENE | GROUP_LOOKS);
    default: return false;
    }
}
