/* Nodes that builders make, against closed forms and POV-Ray's rules. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>

#include "base/random.h"
#include "block_text.h"
#include "scene/scene_bounds.h"
#include "scene/scene_hash.h"

static const double TOLERANCE = 1e-12;

static void assert_near(double a, double b) {
    if (!(fabs(a - b) <= TOLERANCE * (1 + fabs(b)))) fail_msg("%.17g is not %.17g", a, b);
}

static void assert_vec(Vec3 a, Vec3 b) {
    if (!(vec3_length(vec3_sub(a, b)) <= TOLERANCE * (1 + vec3_length(b))))
        fail_msg("<%.15g, %.15g, %.15g> is not <%.15g, %.15g, %.15g>", a.x, a.y, a.z, b.x, b.y, b.z);
}

static int setup(void **state) {
    BlockText *t = malloc(sizeof *t);
    block_text_begin(t);
    *state = t;
    return 0;
}

static int teardown(void **state) {
    block_text_end(*state);
    free(*state);
    return 0;
}

static const Object *object_of(BlockText *t, const char *text) {
    Value value = block_text_value(t, text);
    if (value.kind != VALUE_OBJECT)
        fail_msg("no object: %s (%s)", text, t->diags.first ? t->diags.first->message : "?");
    return value.as.object;
}

static const Camera *camera_of(BlockText *t, const char *text) {
    Value value = block_text_value(t, text);
    if (value.kind != VALUE_CAMERA)
        fail_msg("no camera: %s (%s)", text, t->diags.first ? t->diags.first->message : "?");
    return value.as.camera;
}

/* ---- transforms ---- */

static Vec3 point_of(const Object *object, Vec3 p) {
    Transform place = object_transform(object);
    return transform_point(&place, p);
}

static Vec3 point_back_of(const Object *object, Vec3 p) {
    Transform place = object_transform(object);
    return transform_point_back(&place, p);
}

static void test_transforms_apply_in_order(void **state) {
    const Object *a = object_of(*state, "sphere { 0, 1 translate x rotate <0, 90, 0> }");
    assert_vec(point_of(a, vec3(0, 0, 0)), vec3(0, 0, -1)); /* left-handed: x goes to -z */
    a = object_of(*state, "sphere { 0, 1 rotate <0, 90, 0> translate x }");
    assert_vec(point_of(a, vec3(0, 0, 0)), vec3(1, 0, 0));
    a = object_of(*state, "sphere { 0, 1 scale <2, 3, 4> translate <1, 1, 1> scale 2 }");
    assert_vec(point_of(a, vec3(1, 1, 1)), vec3(6, 8, 10));
    assert_vec(point_back_of(a, vec3(6, 8, 10)), vec3(1, 1, 1));
}

static void test_rotation_is_about_x_then_y_then_z(void **state) {
    const Object *a = object_of(*state, "sphere { 0, 1 rotate <30, 40, 50> }");
    const Object *b =
        object_of(*state, "sphere { 0, 1 rotate <30, 0, 0> rotate <0, 40, 0> rotate <0, 0, 50> }");
    Vec3 p = vec3(0.3, -0.7, 1.9);
    assert_vec(point_of(a, p), point_of(b, p));
}

static void test_transform_block_and_inverse(void **state) {
    const Object *a = object_of(
        *state,
        "sphere { 0, 1 transform { scale 2 translate x } transform { scale 2 translate x inverse } }");
    Vec3 p = vec3(0.3, -0.7, 1.9);
    assert_vec(point_of(a, p), p);
    a = object_of(*state, "sphere { 0, 1 matrix <0,1,0, 0,0,1, 1,0,0, 5,6,7> }");
    assert_vec(point_of(a, vec3(1, 2, 3)), vec3(5 + 3, 6 + 1, 7 + 2));
}

/* The texture follows transforms after it, not those before it. */
static void test_texture_follows_later_transforms_only(void **state) {
    const Object *a =
        object_of(*state, "sphere { 0, 1 translate x pigment { checker rgb 0, rgb 1 } rotate <0, 90, 0> }");
    Vec3 p = vec3(0.2, 0.4, 0.6); /* a point of the pattern stands where only the rotation puts it */
    const Pigment *pigment = a->texture->pigment;
    Vec3 in_object = transform_point(&a->texture->transform, transform_point(&pigment->transform, p));
    Transform turn = transform_rotate(vec3(0, 90, 0));
    assert_vec(point_of(a, in_object), transform_point(&turn, p));
}

static void test_pigment_in_placed_texture(void **state) {
    const Texture *texture =
        block_text_value(*state, "texture { pigment { rgb 1 } scale 2 pigment { bozo scale 3 } translate x }")
            .as.texture;
    Vec3 p = vec3(0.2, 0.4, 0.6);
    Vec3 q = transform_point(&texture->transform, transform_point(&texture->pigment->transform, p));
    assert_vec(q, vec3(1 + 1.2, 2.4, 3.6)); /* the second pigment changes the first one, which is twice as large by then */
}

/* ---- the camera, against POV-Ray's formulas written out ---- */

static void test_camera_defaults(void **state) {
    const Camera *c = camera_of(*state, "camera { }");
    assert_vec(c->location, vec3(0, 0, 0));
    assert_vec(c->direction, vec3(0, 0, 1));
    assert_vec(c->right, vec3(1.33, 0, 0));
    assert_vec(c->up, vec3(0, 1, 0));
}

static void test_camera_angle(void **state) {
    const Camera *c =
        camera_of(*state, "camera { angle 60 right <2, 0, 0> location x }"); /* order does not matter */
    assert_near(vec3_length(c->direction), 1 / tan(30 * VTS_RADIANS));
    assert_vec(c->right, vec3(2, 0, 0));
}

static void test_camera_looks_at(void **state) {
    const Camera *c =
        camera_of(*state, "camera { look_at <1, 5, 2> location <1, 2, -2> right <1.5, 0, 0> angle 90 }");
    assert_vec(c->direction,
               vec3(0, 0.75 * 0.6, 0.75 * 0.8)); /* 3-4-5 triangle; |direction| = 1.5 / tan 45 / 2 */
    assert_vec(c->right, vec3(1.5, 0, 0));
    assert_vec(c->up, vec3(0, 0.8, -0.6));
}

static void test_camera_sky_and_handedness(void **state) {
    const Camera *c = camera_of(*state, "camera { location <0, 0, -5> sky x look_at 0 }");
    assert_vec(c->up, vec3(1, 0, 0));
    assert_vec(c->right, vec3(0, -1.33, 0)); /* sky × direction = x × z */
    c = camera_of(
        *state,
        "camera { location <0, 0, -5> right <-1.33, 0, 0> look_at 0 }"); /* right-handed: stays mirrored */
    assert_vec(c->right, vec3(-1.33, 0, 0));
}

static void test_camera_transforms_come_last(void **state) {
    const Camera *c = camera_of(*state, "camera { translate y location <0, 0, -5> look_at 0 }");
    assert_vec(c->location, vec3(0, 1, -5));
    assert_vec(c->direction, vec3(0, 0, 1));
}

static void test_orthographic_sees_what_perspective_sees_at_look_at(void **state) {
    const Camera *c = camera_of(*state, "camera { orthographic location <0, 0, -8> look_at 0 }");
    assert_vec(c->right, vec3(1.33 * 8, 0, 0));
    assert_vec(c->up, vec3(0, 8, 0));
    c = camera_of(*state,
                  "camera { orthographic location <0, 0, -8> look_at 0 right <4, 0, 0> up <0, 3, 0> }");
    assert_vec(c->right, vec3(4, 0, 0)); /* explicit sizes stand */
    c = camera_of(*state, "camera { orthographic location <0, 0, -8> look_at 0 right <4, 0, 0> angle 90 }");
    assert_vec(c->right, vec3(16, 0, 0)); /* with an angle they do not: 2 · 8 · tan 45 wide */
}

/* ---- looks ---- */

static void test_finish_changes_single_words(void **state) {
    BlockText *t = *state;
    Value shiny = block_text_value(t, "texture { pigment { rgb 1 } finish { ambient 0.3 diffuse 0.5, 0.25 "
                                      "specular 0.7 reflection { 0.1, 0.6 fresnel } } }");
    block_text_bind(t, "Shiny", shiny);
    const Texture *texture = block_text_value(t, "texture { $Shiny finish { ambient 0 } }").as.texture;
    assert_near(texture->finish->ambient.red, 0);
    assert_near(texture->finish->diffuse, 0.5);
    assert_near(texture->finish->transmission, 0.25);
    assert_near(texture->finish->specular, 0.7);
    assert_near(texture->finish->reflection_min.red, 0.1);
    assert_near(texture->finish->reflection_max.green, 0.6);
    assert_true(texture->finish->fresnel);
}

static void test_layers_of_textures(void **state) {
    const Object *a = object_of(
        *state,
        "sphere { 0, 1 texture { pigment { rgb 0.1 } } texture { pigment { rgbt <1, 1, 1, 0.5> } } }");
    assert_near(a->texture->pigment->color.transmit, 0.5);
    assert_non_null(a->texture->under);
    assert_near(a->texture->under->pigment->color.red, 0.1);
    assert_null(a->texture->under->under);
}

static void test_maps_are_sorted_and_promoted(void **state) {
    const Pigment *p =
        block_text_value(
            *state,
            "pigment { gradient y color_map { [0.7 rgb 1] [0 rgb <1, 0, 0>] [0.2, 0.5 rgb 0 rgb 0.5] } }")
            .as.pigment;
    assert_int_equal(p->kind, PATTERN_GRADIENT);
    assert_int_equal(p->entry_count, 4);
    const double positions[] = {0, 0.2, 0.5, 0.7};
    for (size_t i = 0; i < 4; i++) assert_near(p->entries[i].position, positions[i]);
    assert_near(p->entries[2].color.red, 0.5);
}

static void test_block_patterns_take_colours_and_pigments(void **state) {
    const Pigment *p = block_text_value(*state, "pigment { checker rgb 0.25, rgb 0.75 scale 2 }").as.pigment;
    assert_int_equal(p->entry_count, 2);
    assert_near(p->entries[1].color.red, 0.75);
    p = block_text_value(*state, "pigment { checker pigment { rgb 1 } pigment { bozo } }").as.pigment;
    assert_int_equal(p->entries[1].pigment->kind, PATTERN_BOZO);
    p = block_text_value(*state, "pigment { brick rgb 0, rgb 1 brick_size <2, 1, 1> mortar 0.1 }").as.pigment;
    assert_vec(p->brick_size, vec3(2, 1, 1));
}

/* ---- hashes ---- */

static void test_hashes_follow_content_not_place(void **state) {
    BlockText *t = *state;
    const Object *a = object_of(t, "sphere { 0, 1 pigment { rgb 1 } scale 2 }");
    const Object *b = object_of(t, "  sphere { <0, 0, 0>,   1 pigment { rgb <1, 1, 1> } scale <2, 2, 2> }");
    const Object *c = object_of(t, "sphere { 0, 1 pigment { rgb 0.5 } scale 2 }");
    const Object *d = object_of(t, "sphere { 0, 1 pigment { rgb 1 } scale 3 }");
    assert_true(hash_equal(object_hash(a), object_hash(b)));
    assert_false(hash_equal(object_hash(a), object_hash(c)));
    assert_false(hash_equal(object_hash(a), object_hash(d)));
    assert_true(hash_equal(object_geometry_hash(a), object_geometry_hash(c)));
    assert_false(hash_equal(object_geometry_hash(a), object_geometry_hash(d)));
}

static void test_layer_hash_ignores_looks(void **state) {
    const TexelDef *a =
        block_text_value(
            *state, "texel { layer { sphere { 0.5, 0.2 pigment { rgb 1 } } texture { pigment { rgb 1 } } } }")
            .as.texel;
    const TexelDef *b = block_text_value(*state, "texel { layer { sphere { 0.5, 0.2 } } }").as.texel;
    assert_true(hash_equal(a->layers[0].hash, b->layers[0].hash));
    assert_false(hash_equal(a->hash, b->hash));
}

static const TexelDef *texel_of(BlockText *t, const char *text) { return block_text_value(t, text).as.texel; }

static void test_layers_take_their_objects_texture(void **state) {
    BlockText *t = *state;
    const Texture *own = texel_of(t, "texel { layer { sphere { 0.5, 0.2 } texture { pigment { rgb <1, 0, 0> } } } }")->layers[0].texture;
    const Texture *taken = texel_of(t, "texel { layer { sphere { 0.5, 0.2 pigment { rgb <1, 0, 0> } } sphere { 0.2, 0.1 } } }")->layers[0].texture;
    const Texture *kept = texel_of(t, "texel { layer { sphere { 0.5, 0.2 pigment { rgb <0, 0, 1> } } texture { pigment { rgb <1, 0, 0> } } } }")->layers[0].texture;
    assert_true(hash_equal(own->hash, taken->hash));
    assert_true(hash_equal(own->hash, kept->hash));
    /* A pattern lies where the object was moved to. */
    const Texture *moved = texel_of(t, "texel { layer { sphere { 0.5, 0.2 pigment { gradient <1, 0, 0> } translate <0.1, 0, 0> } } }")->layers[0].texture;
    const Texture *laid = texel_of(t, "texel { layer { sphere { 0.6, 0.2 } texture { pigment { gradient <1, 0, 0> } translate <0.1, 0, 0> } } }")->layers[0].texture;
    assert_true(hash_equal(moved->hash, laid->hash));
}

/* ---- bounds: every point of the solid inside, and the box is tight ---- */

static void test_bounds_of_turned_solids(void **state) {
    BlockText *t = *state;
    const char *const solids[] = {"sphere { <1, 0, 2>, 0.5", "cylinder { 0, <1, 2, 0.5>, 0.3",
                                  "torus { 2, 0.4", "disc { y, <1, 1, 0>, 2", "cone { 0, 1, <0, 3, 1>, 0.2"};
    RandomStream random = {7};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(solids); i++) {
        char text[200];
        snprintf(text, sizeof text, "%s rotate <20, 30, 40> scale <1, 2, 0.5> translate <3, 0, 1> }",
                 solids[i]);
        const Object *o = object_of(t, text);
        Box3 bounds = object_bounds(o), hull = box3_empty();
        for (int k = 0; k < 60000; k++) {
            double a = 2 * VTS_PI * random_next_unit(&random), b = 2 * VTS_PI * random_next_unit(&random),
                   s = random_next_unit(&random);
            Vec3 p, u, v, axis;
            switch (o->kind) {
            case OBJECT_SPHERE: {
                double z = 2 * s - 1, r = sqrt(1 - z * z);
                p = vec3_madd(o->as.sphere.center, vec3(r * cos(a), r * sin(a), z), o->as.sphere.radius);
                break;
            }
            case OBJECT_TORUS: {
                double r = o->as.torus.major_radius + o->as.torus.minor_radius * cos(b);
                p = vec3(r * cos(a), o->as.torus.minor_radius * sin(b), r * sin(a));
                break;
            }
            case OBJECT_DISC:
                vec3_frame(o->as.disc.normal, &u, &v);
                p = vec3_madd(vec3_madd(o->as.disc.center, u, 2 * cos(a)), v, 2 * sin(a));
                break;
            default:
                axis = vec3_sub(o->as.cone.cap, o->as.cone.base);
                vec3_frame(vec3_normalize(axis), &u, &v);
                s = s < 0.5 ? 0 : 1;
                double r = s > 0 ? o->as.cone.cap_radius : o->as.cone.base_radius;
                p = vec3_madd(vec3_madd(vec3_madd(o->as.cone.base, axis, s), u, r * cos(a)), v, r * sin(a));
            }
            hull = box3_add_point(hull, point_of(o, p));
        }
        for (int axis = 0; axis < 3; axis++) {
            double size = vec3_get(bounds.max, axis) - vec3_get(bounds.min, axis);
            assert_true(vec3_get(hull.min, axis) >= vec3_get(bounds.min, axis) - 1e-9);
            assert_true(vec3_get(hull.max, axis) <= vec3_get(bounds.max, axis) + 1e-9);
            assert_true(vec3_get(hull.min, axis) <= vec3_get(bounds.min, axis) + 0.01 * size);
            assert_true(vec3_get(hull.max, axis) >= vec3_get(bounds.max, axis) - 0.01 * size);
        }
    }
}

/* ---- volumetric blocks ---- */

/* (u, v) → <16(u − ½), uv, 16(v − ½)> */
static const Tape *patch_tape(Arena *arena) {
    TapeBuilder *b = tape_builder_create(arena, 2);
    Span nowhere = {0};
    TapeRef u = tape_input(b, 0), v = tape_input(b, 1), half = tape_constant(b, 0.5),
            sixteen = tape_constant(b, 16);
    TapeRef out[3] = {tape_binary(b, TAPE_MUL, sixteen, tape_binary(b, TAPE_SUB, u, half, nowhere), nowhere),
                      tape_binary(b, TAPE_MUL, u, v, nowhere),
                      tape_binary(b, TAPE_MUL, sixteen, tape_binary(b, TAPE_SUB, v, half, nowhere), nowhere)};
    return tape_finish(b, out, 3);
}

static void bind_patch_function(BlockText *t) {
    UserFunction *function = arena_new(&t->arena, UserFunction);
    *function = (UserFunction){.tape = patch_tape(&t->arena), .parameter_count = 2};
    block_text_bind(t, "Patch", (Value){.kind = VALUE_FUNCTION, .as.function = function});
}

static void test_patch_grid_from_function(void **state) {
    BlockText *t = *state;
    bind_patch_function(t);
    Value value = block_text_value(t, "surface { patch_grid 38, 19 $Patch texture { pigment { rgb 0.1 } } }");
    assert_int_equal(value.kind, VALUE_SURFACE);
    const Surface *s = value.as.surface;
    assert_int_equal(s->kind, SURFACE_PATCHES);
    for (int i = 0; i <= 38; i++)
        for (int j = 0; j <= 19; j++) {
            double u = i / 38.0, v = j / 19.0;
            assert_vec(s->points[i * 20 + j], vec3(16 * (u - 0.5), u * v, 16 * (v - 0.5)));
        }
}

static void test_texel_bounds_of_object(void **state) {
    const TexelDef *texel =
        block_text_value(
            *state,
            "texel { bounds sphere { <1, 2, 3>, 2 } resolution auto layer { sphere { <1, 2, 3>, 2 } } }")
            .as.texel;
    assert_vec(texel->bounds.min, vec3(-1, 0, 1));
    assert_vec(texel->bounds.max, vec3(3, 4, 5));
    assert_int_equal(texel->resolution, 0);
}

static void test_particles_one_word_each(void **state) {
    const Object *o = object_of(*state, "particles { count 5 { position <index, 0, 0> velocity y life 2 "
                                        "width 0.1, 0.01 profile \"round\" twist 30 } }");
    assert_int_equal(o->as.particles.count, 5);
    for (size_t i = 0; i < 5; i++) assert_near(o->as.particles.items[i].position.x, (double)i);
    assert_int_equal(o->as.particles.items[4].profile, BLADE_ROUND);
    assert_near(o->as.particles.items[0].width_tip, 0.01);
    Box3 box = object_bounds(o);
    assert_near(box.max.y, 2 + 0.05);
}

static const char lawn[] =
    "global_settings { assumed_gamma 1.0  max_error 0.004 }\n"
    "camera { location <0, 3.2, -13>  look_at <0, 1.4, 0>  right <1.5, 0, 0>  angle 42 }\n"
    "light_source { <2000, 2600, -1800>, rgb <1.15, 1.1, 1.0> parallel point_at <0, 0, 0> }\n"
    "sky_sphere { pigment { gradient y color_map { [0.0 rgb <0.80, 0.87, 0.95>] [0.6 rgb <0.25, 0.45, 0.80>] "
    "} } }\n"
    "object { surface { patch_grid 38, 38 $Patch texture { pigment { rgb <0.13, 0.10, 0.06> } } } }\n"
    "skin {\n"
    "  surface { patch_grid 38, 38 $Patch texture { pigment { rgb <0.13, 0.10, 0.06> } } }\n"
    "  texel { cyclic <1, 0, 1> layer { particles { count 3 { position <index, 0, 0.5> velocity <0.1, 0.8, "
    "0>\n"
    "            acceleration <0.1, -0.25, 0> life 1 width 0.06, 0.004 profile \"v\" } }\n"
    "          texture { pigment { rgb <0.16, 0.40, 0.07> } finish { ambient 0.1 diffuse 0.55, 0.35 specular "
    "0.12 roughness 0.06 } } } }\n"
    "  texel { $Flower density 0.5 }\n"
    "  mapping { repeat <37, 37>  height 0.9 }\n"
    "  jitter { direction 0.25 scale 0.8  height 0.3 scale 2  coordinates 0.15 scale 1.5  instance { rotate "
    "360 displace 0.3 } seed 5 }\n"
    "}\n";

static void test_lawn(void **state) {
    BlockText *t = *state;
    bind_patch_function(t);
    block_text_bind(
        t, "Flower",
        block_text_value(t, "texel { layer { cylinder { <0.5, 0, 0.5>, <0.52, 0.75, 0.5>, 0.012 } } }"));
    const Scene *scene = block_text_scene(t, lawn);
    assert_non_null(scene);
    assert_int_equal(scene->object_count, 1);
    assert_int_equal(scene->skin_count, 1);
    const Skin *skin = scene->skins[0];
    assert_int_equal(skin->texel_count, 2);
    assert_near(skin->texels[1].density, 0.5);
    assert_near(skin->mapping.repeat_u, 37);
    assert_near(skin->mapping.height, 0.9);
    assert_near(skin->jitter.direction.amplitude, 0.25);
    assert_near(skin->jitter.direction.scale, 0.8);
    assert_near(skin->jitter.height.scale, 2);
    assert_near(skin->jitter.coordinates.scale, 1.5);
    assert_near(skin->jitter.instance.rotate, 360);
    assert_int_equal(skin->jitter.seed, 5);
    assert_int_equal(skin->texels[0].texel->cyclic, 5);
    assert_true(hash_equal(skin->surface->hash, scene->objects[0]->as.surface->hash));
    assert_int_equal(scene->lights[0].kind, LIGHT_PARALLEL);
    assert_near(vec3_length(scene->lights[0].to_light), 1);
    assert_near(scene->settings.max_error, 0.004);
}

/* A colour behind a word and its number belongs to the block, not to the word. */
static void test_colours_behind_words(void **state) {
    BlockText *t = *state;
    const Fog *fog = block_text_value(t, "fog { fog_type 1 distance 25000 rgb <0.25, 0.5, 1> }").as.fog;
    assert_near(fog->distance, 25000);
    assert_near(fog->color.green, 0.5);
    const Light *light = block_text_value(t, "light_source { y, rgb 0.5 parallel point_at 0 }").as.light;
    assert_int_equal(light->kind, LIGHT_PARALLEL);
    assert_near(light->color.blue, 0.5);
    light = block_text_value(t, "light_source { y, rgb 0.25 shadowless }").as.light;
    assert_true(light->shadowless);
    assert_near(light->color.blue, 0.25);
}

static void test_spotlight(void **state) {
    const Light *l =
        block_text_value(*state, "light_source { 0, rgb 1 spotlight point_at <0, 0, 5> radius 12 falloff 20 "
                                 "fade_distance 3 fade_power 2 rotate <0, 90, 0> translate y }")
            .as.light;
    assert_int_equal(l->kind, LIGHT_SPOT);
    assert_vec(l->location, vec3(0, 1, 0));
    assert_vec(l->point_at, vec3(5, 1, 0)); /* z turns to x about y */
    assert_vec(l->to_light, vec3(-1, 0, 0));
    assert_near(l->falloff, 20);
    assert_near(l->fade_power, 2);
}

static void test_sky_layers_and_settings(void **state) {
    const Scene *scene = block_text_scene(
        *state,
        "sky_sphere { pigment { rgb 1 } pigment { bozo } rotate x }\n"
        "global_settings { max_error 0.01 opacity_model mean detail \"voxels\" samples 4 ambient_light 2 }\n"
        "global_settings { assumed_gamma 2 } sphere { 0, 1 }");
    assert_non_null(scene);
    assert_int_equal(scene->sky_layer_count, 2);
    assert_int_equal(scene->sky_layers[1]->kind, PATTERN_BOZO);
    assert_string_equal(scene->settings.opacity_model, "mean");
    assert_string_equal(scene->settings.detail, "voxels");
    assert_int_equal(scene->settings.samples, 4);
    assert_near(scene->settings.assumed_gamma, 2);
    assert_near(scene->settings.ambient_light.blue, 2);
}

/* ---- scene ---- */

static void test_lights_in_unions_move_with_them(void **state) {
    const Scene *scene = block_text_scene(
        *state,
        "union { sphere { 0, 1 } union { sphere { 0, 1 } light_source { x, rgb 1 } translate y } scale 2 }");
    assert_non_null(scene);
    assert_int_equal(scene->light_count, 1);
    assert_vec(scene->lights[0].location, vec3(2, 2, 0));
}

static void test_mesh_of_triangles(void **state) {
    const Object *o = object_of(*state, "mesh { triangle { 0, x, y texture { pigment { rgb 1 } } } triangle "
                                        "{ 0, y, z } smooth_triangle { 0, x, x, y, z, z } }");
    const MeshData *m = o->as.mesh;
    assert_int_equal(o->kind, OBJECT_TRIANGLES);
    assert_int_equal(m->triangle_count, 3);
    assert_vec(m->vertices[m->triangles[1][2]], vec3(0, 0, 1));
    assert_vec(m->normals[m->triangles[0][0]], vec3(0, 0, 1)); /* x × y */
    assert_vec(m->normals[m->triangles[2][1]], vec3(0, 1, 0));
    assert_int_equal(m->triangle_textures[0], 0);
    assert_null(m->textures[m->triangle_textures[1]]);
}

static void test_default_texture(void **state) {
    BlockText *t = *state;
    SceneDraft *draft = scene_draft_create(&t->context, "test");
    const EvalBlock *all = block_text_parse(t, "finish { ambient 0.7 }");
    assert_true(scene_draft_default(draft, &t->context, all));
    const Pigment *none = block_text_value(t, "pigment { rgb 1 }").as.pigment;
    assert_non_null(none);
    Value finish = block_text_value(t, "finish { diffuse 0.2 }");
    assert_near(finish.as.finish->ambient.red, 0.7);
    Value sphere = block_text_value(t, "sphere { 0, 1 }");
    scene_draft_add(draft, &t->context, &sphere, (Span){0});
    const Scene *scene = scene_draft_finish(draft, &t->context);
    assert_near(scene->objects[0]->texture->finish->ambient.red, 0.7);
}

static void test_printed_scene(void **state) {
    BlockText *t = *state;
    const Scene *scene =
        block_text_scene(t, "camera { location <0, 1, -4> } light_source { <0, 9, 0>, rgb 1 shadowless } "
                            "background { rgb 0.25 }\n"
                            "sphere { y, 1 pigment { checker rgb 0, rgb 1 } scale 2 }\n"
                            "union { box { 1, 0 } cylinder { 0, y, 0.5 open } translate x }\n");
    assert_non_null(scene);
    StrBuf text = {0};
    scene_print(scene, &text);
    assert_string_equal(text.data,
                        "scene test clock 0\n"
                        "  settings ambient_light rgb <1, 1, 1> assumed_gamma 1 max_trace_level 5\n"
                        "  camera location <0, 1, -4> direction <0, 0, 1> right <1.33, 0, 0> up <0, 1, 0>\n"
                        "  background color rgb <0.25, 0.25, 0.25>\n"
                        "  light location <0, 9, 0> color rgb <1, 1, 1> shadowless\n"
                        "  sphere center <0, 1, 0> radius 1 matrix <2, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0>\n"
                        "    texture\n"
                        "      pigment checker\n"
                        "        [0 color rgb <0, 0, 0>]\n"
                        "        [1 color rgb <1, 1, 1>]\n"
                        "      finish ambient rgb <0.1, 0.1, 0.1> diffuse 0.6\n"
                        "  union of 2 translate <1, 0, 0>\n"
                        "    box from <0, 0, 0> to <1, 1, 1>\n"
                        "    cylinder base <0, 0, 0> radius 0.5 cap <0, 1, 0> radius 0.5 open\n");
    strbuf_free(&text);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, setup, teardown)

int main(void) {
    const struct CMUnitTest tests[] = {
        TEST(test_transforms_apply_in_order),
        TEST(test_rotation_is_about_x_then_y_then_z),
        TEST(test_transform_block_and_inverse),
        TEST(test_texture_follows_later_transforms_only),
        TEST(test_pigment_in_placed_texture),
        TEST(test_camera_defaults),
        TEST(test_camera_angle),
        TEST(test_camera_looks_at),
        TEST(test_camera_sky_and_handedness),
        TEST(test_camera_transforms_come_last),
        TEST(test_orthographic_sees_what_perspective_sees_at_look_at),
        TEST(test_finish_changes_single_words),
        TEST(test_layers_of_textures),
        TEST(test_maps_are_sorted_and_promoted),
        TEST(test_block_patterns_take_colours_and_pigments),
        TEST(test_hashes_follow_content_not_place),
        TEST(test_layer_hash_ignores_looks), TEST(test_layers_take_their_objects_texture),
        TEST(test_bounds_of_turned_solids),
        TEST(test_patch_grid_from_function),
        TEST(test_texel_bounds_of_object),
        TEST(test_particles_one_word_each),
        TEST(test_lawn),
        TEST(test_colours_behind_words),
        TEST(test_spotlight),
        TEST(test_sky_layers_and_settings),
        TEST(test_lights_in_unions_move_with_them),
        TEST(test_mesh_of_triangles),
        TEST(test_default_texture),
        TEST(test_printed_scene),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
