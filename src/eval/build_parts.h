/* What builders share: tables of words that stand in many blocks, and operations on the nodes that they make. */
#ifndef VTS_EVAL_BUILD_PARTS_H
#define VTS_EVAL_BUILD_PARTS_H

#include "eval/build_reader.h"
#include "eval/eval.h"
#include "grow/cloth.h"
#include "grow/lsystem.h"
#include "scene/scene_hash.h"

/* ---- build_transform.c: translate rotate scale matrix transform; target: a Transform, composed onto ---- */
extern const WordRule transform_rules[];
extern const size_t transform_rule_count;
/* Takes a VALUE_TRANSFORM: composes it onto `onto`. */
bool take_transform(const Argument *value, Transform *onto);
BlockBuilder build_transform;

/* ---- build_grammar.c: what is read and not modelled (grammar.def) ---- */
/* Holds the reader's items against the grammar called `block`; false after a report. A name without a grammar takes all. */
bool grammar_read(Reader *reader, const char *block);
/* Holds one word of the reader's block against that block's grammar, or against the one of all objects' modifiers. False when
 * neither knows the word; mistakes are reported. */
bool grammar_word(Reader *reader, const Word *word);
/* Whether the grammar called `block` has this word. */
bool grammar_has(const char *block, const char *word);
/* A block that stays VALUE_BLOCK once its grammar holds. */
BlockBuilder build_checked;

/* ---- build_pigment.c, build_map.c ---- */
BlockBuilder build_pigment, build_pattern, build_color_map;
/* Reads a pigment's items from the reader's position on, beginning with the default pigment. */
const Pigment *pigment_read(Reader *reader);

/* What the text of `block` makes of `base`, as POV-Ray reads pigment { … } over the pigment of a declared texture: what it does not
 * say stays. A block that begins with a declared pigment replaces `base`. */
const Pigment *pigment_over(BuildContext *context, const Pigment *base, const Pigment *block);

/* image_map { … } and its like; NULL after a report. */
const ImageMap *image_read(Reader *parent, const Word *word);
/* The picture's file that the text at `span` names, with POV-Ray's endings of `format` (may be NULL) tried after the bare name
 * (eval_path.c); NULL after a report. */
const char *picture_find(const BuildContext *context, const char *name, const char *format, Span span);

/* The path of a file that the text at `span` names, where includes are looked for (eval_path.c); `what` it is, for the report: "mesh
 * file". NULL after one. */
const char *data_file_find(const BuildContext *context, const char *what, const char *name, Span span);
/* Makes image->picture of red, green, blue and alpha, not multiplied, in rows from the top (eval_path.c); false where memory is short. */
bool picture_from_pixels(const BuildContext *context, int columns, int rows, const float (*pixels)[4], ImageMap *image);
/* Loads the picture at image->path (eval_path.c). True, with image->picture NULL, where pictures are not read; false after a report. */
bool picture_file_load(const BuildContext *context, ImageMap *image, Span span);
/* Reads the file of meshes that the text at `span` names (eval_path.c); false after a report. */
bool mesh_file_load(const BuildContext *context, const char *name, Span span, const EvalMeshRequest *request, EvalMeshFile *out);
/* build_density.c: density { … } as a block; NULL after a report. */
const DensityField *density_read(Reader *parent, const EvalBlock *block);
/* Reads the texel's file that the text at `span` names (eval_path.c); false after a report. */
bool texel_file_read(const BuildContext *context, const char *name, Span span, TexelDef *out);

/* ---- build_finish.c ---- */
BlockBuilder build_finish;
/* `base` with what the finish block sets changed; a finish made from a declared one replaces it whole. */
const Finish *finish_over(const BuildContext *context, const Finish *base, const Finish *block);

BlockBuilder build_interior; /* build_interior.c */
/* build_media.c: media { … }; false after a report. */
bool medium_read(Reader *parent, const EvalBlock *block, Medium *out);
/* A new list with one more at its end. */
MediaList media_joined(Arena *arena, MediaList list, const Medium *medium);
/* A copy with its media placed by `t`, or the same where there are none. */
const Interior *interior_placed(const BuildContext *context, const Interior *interior, const Transform *t);
/* build_pigment.c: density { … } of media, whose colours count; NULL after a report. */
const Pigment *density_colors_read(Reader *reader);
const ColorMap *density_map_read(Reader *parent, const EvalBlock *block); /* build_map.c; the same */
/* build_film.c: animation { … }; false after a report. */
bool film_read(BuildContext *context, const EvalBlock *block, Film *out);

/* ---- build_texture.c ---- */
BlockBuilder build_texture, build_material, build_wind_field;
/* Reads a texture's items from the reader's position on; NULL after a report. */
const Texture *texture_read(Reader *reader);
/* interior_texture { … } over those before it, in the space that `place` maps from. */
void read_interior_texture(Reader *reader, const Word *word, const Texture **texture, const Transform *place);
BlockBuilder build_normal; /* build_normal.c */
/* A copy with its transform followed by `t`. */
const Normal *normal_placed(const BuildContext *context, const Normal *normal, const Transform *t);
const Texture *texture_default(const BuildContext *context);
/* Copies with all layers changed: placed by `t`; laid over `bottom`. */
const Texture *texture_placed(const BuildContext *context, const Texture *texture, const Transform *t);
const Texture *texture_over(const BuildContext *context, const Texture *top, const Texture *bottom);
/* The same, with an error at `span` where there are too many layers; `top` alone then. */
const Texture *texture_layered(const BuildContext *context, const Texture *top, const Texture *bottom, Span span);
/* Takes texture, pigment, finish, normal, interior and material onto *texture, which may be NULL (the default then).
 * `place`: transform so far of what carries the texture. */
/* The interior of a material, in the space of the material's user, or NULL. */
const Interior *material_interior(const BuildContext *context, const void *material);
/* Its interior_texture, in the space of the material's user, or NULL. */
const Texture *material_inside(const BuildContext *context, const void *material);
bool take_looks(BuildContext *context, const Argument *value, const Texture **texture,
                const InertNote **inert, const Transform *place);

/* ---- build_object.c ---- */
/* An object while its block is read. */
typedef struct ObjectDraft {
    Object object;
    Transform transform; /* becomes the object's place */
    ObjectRest rest;
    bool no_shadow, no_image, inverse, no_reflection, no_radiosity, double_illuminate, cutaway;
    const char *word; /* the block's */
} ObjectDraft;
ObjectDraft object_begin(const EvalBlock *block, ObjectKind kind);
/* Takes the interior, if the value is one or a material that has one, as it stands after the transforms so far. */
void take_interior(const BuildContext *context, const Argument *value, ObjectDraft *draft);
/* Takes looks and transforms; target: an ObjectDraft. */
bool object_on_value(Reader *reader, const Argument *value, void *target);
/* Reads to the end of the block, with the modifiers of all objects; false after a diagnostic. */
bool object_read(Reader *reader, ObjectDraft *draft);
/* The finished object as a value; false after a diagnostic. */
bool object_make(Reader *reader, const ObjectDraft *draft, Value *out);
/* Both: for objects whose own numbers stand before the modifiers. */
bool object_finish(Reader *reader, ObjectDraft *draft, Value *out);
/* The block is `sphere { S … }` with a declared object S: a copy of S with modifiers. */
bool object_is_copy(const EvalBlock *block);
BlockBuilder build_object, build_csg, build_unmodelled;
/* An object for a surface or a texel that stands where objects are wanted; NULL for other values. */
const Object *object_from_value(const BuildContext *context, const Argument *value);

BlockBuilder build_sphere, build_box, build_cone, build_plane, build_disc, build_torus; /* build_solid.c */
BlockBuilder build_triangle, build_mesh, build_mesh2;                                   /* build_mesh.c */
BlockBuilder build_mesh_file; /* build_mesh_file.c: mesh { "file" … } */
static inline bool block_begins_with_string(const EvalBlock *block) {
    return block->count && block->items[0].kind == ITEM_VALUE && block->items[0].value.kind == VALUE_STRING;
}
BlockBuilder build_quadric, build_polynomial, build_superellipsoid, build_ovus, build_polygon, build_lathe, build_sor, build_prism,
    build_sweep, build_patch, build_blob, build_isosurface, build_parametric, build_julia, build_text,
    build_height_field; /* build_rare_kinds.c */
BlockBuilder build_camera;                                                              /* build_camera.c */
BlockBuilder build_light;                                                               /* build_light.c */
const Light *light_placed(const BuildContext *context, const Light *light, const Transform *t);
/* build_light_group.c: gives all lights in an object to `take`, in the scene's space. Returns the object, changed where light groups keep
 * lights apart. */
typedef struct LightFinder {
    BuildContext *context;
    void (*take)(void *target, BuildContext *context, const Light *light);
    void *target;
    uint32_t group_count; /* so far */
} LightFinder;
const Object *lights_find(LightFinder *finder, const Object *object);
BlockBuilder build_sky_sphere, build_fog, build_rainbow; /* build_sky.c */
bool background_read(BuildContext *context, const EvalBlock *block, Color *out);
/* geo_origin of global_settings (eval_geo.c). */
void settings_read_origin(Reader *reader, const Word *word, void *target);
/* Gives the scene its origin on the globe. False after a report, where it has another already; what a terrain without an `origin` of its
 * own does is to ask context->geo_origin.set first. */
bool geo_origin_set(BuildContext *context, const GeoOrigin *origin);
/* Somebody was told where a place of the globe is in the scene: whether the earth is round is settled. */
void geo_note_asked(BuildContext *context, Span span);
bool settings_read(BuildContext *context, const EvalBlock *block,
                   GlobalSettings *settings); /* build_settings.c */
BlockBuilder build_texel;                     /* build_texel.c */
BlockBuilder build_particles;                 /* build_particles.c */
BlockBuilder build_lsystem;                   /* build_lsystem.c */
/* The word that a system derives (eval_plant.c); false after a report, or interrupted. */
bool plant_derive(const BuildContext *context, const LSystem *system, LSystemWord *word);
BlockBuilder build_surface;                   /* build_surface.c */
/* ARRAY of `count` vectors, or a kept block { n, <…>, … } of them; `what` names it in messages. NULL after an error. */
const Vec3 *vectors_read(Reader *reader, const EvalBlock *body, const char *what, size_t *count);
BlockBuilder build_terrain;                   /* build_terrain.c */
BlockBuilder build_volume;                    /* build_volume.c */
/* The ground of the maps that the text at `span` names (eval_path.c); false after a report. */
bool terrain_load(const BuildContext *context, EvalTerrainRequest *request, const Span *spans, Span span, Terrain *out);
BlockBuilder build_cloth;                     /* build_cloth.c */
/* Where the masses of a cloth are at the scene's time (eval_cloth.c); false after a report, or interrupted. */
bool cloth_places(const BuildContext *context, const ClothSpec *spec, Span span, Vec3 *places);
BlockBuilder build_skin;                                                   /* build_skin.c */
bool mapping_read(Reader *parent, const Word *word, SkinMapping *mapping); /* build_mapping.c */
bool jitter_read(Reader *parent, const Word *word, SkinJitter *jitter);

#endif
