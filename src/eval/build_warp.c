#include "eval/build_pattern.h"

#include <string.h>

typedef struct WarpDraft {
    Warp warp;
    const char *kind; /* its first word; NULL: none yet */
    bool ignored;
} WarpDraft;

static bool begin_kind(Reader *reader, const Word *word, WarpDraft *draft, WarpKind kind) {
    if (draft->kind) {
        reader_error(reader, word->span, "this warp is '%s' already", draft->kind);
        return false;
    }
    draft->kind = word->text;
    draft->warp.kind = kind;
    return true;
}

static void read_hole(Reader *reader, const Word *word, void *target) {
    WarpDraft *draft = target;
    if (!begin_kind(reader, word, draft, WARP_BLACK_HOLE) || !word_arguments(reader, word, 2, 2)) return;
    word_vector(reader, word, 0, &draft->warp.center);
    word_float(reader, word, 1, &draft->warp.radius);
}

/* The one axis that is not 0, and how far along it. */
static void read_repeat_axis(Reader *reader, const Word *word, Warp *warp) {
    Vec3 v;
    if (!word_vector(reader, word, 0, &v)) return;
    warp->axis = v.x != 0 ? 0 : v.y != 0 ? 1 : 2;
    warp->width = vec3_get(v, warp->axis);
    if (warp->width == 0)
        reader_error(reader, word->arguments[0].span, "'repeat' takes a vector along x, y or z");
}

/* In a black hole the distances of its copies. */
static void read_repeat(Reader *reader, const Word *word, void *target) {
    WarpDraft *draft = target;
    if (!word_arguments(reader, word, 1, 1)) return;
    if (draft->kind && draft->warp.kind == WARP_BLACK_HOLE) {
        draft->warp.repeated = word_vector(reader, word, 0, &draft->warp.repeat);
    } else if (begin_kind(reader, word, draft, WARP_REPEAT)) {
        read_repeat_axis(reader, word, &draft->warp);
    }
}

static void read_turbulence(Reader *reader, const Word *word, void *target) {
    WarpDraft *draft = target;
    if (!word_arguments(reader, word, 1, 1)) return;
    if (draft->kind && draft->warp.kind == WARP_BLACK_HOLE)
        word_vector(reader, word, 0, &draft->warp.uncertainty);
    else if (begin_kind(reader, word, draft, WARP_TURBULENCE))
        word_vector(reader, word, 0, &draft->warp.turbulence);
}

static void read_flip(Reader *reader, const Word *word, void *target) {
    Warp *warp = &((WarpDraft *)target)->warp;
    Vec3 v;
    if (word_arguments(reader, word, 1, 1) && word_vector(reader, word, 0, &v))
        warp->flip = vec3(v.x != 0 ? -1 : 1, v.y != 0 ? -1 : 1, v.z != 0 ? -1 : 1);
}

static void read_octaves(Reader *reader, const Word *word, void *target) {
    Warp *warp = &((WarpDraft *)target)->warp;
    if (word_arguments(reader, word, 1, 1) && word_int(reader, word, 0, &warp->octaves))
        warp->octaves = int_clamp(warp->octaves, 1, 10);
}

static void read_mapping(Reader *reader, const Word *word, void *target) {
    static const struct {
        const char *word;
        WarpKind kind;
    } kinds[] = {{"cylindrical", WARP_CYLINDRICAL},
                 {"spherical", WARP_SPHERICAL},
                 {"toroidal", WARP_TOROIDAL},
                 {"cubic", WARP_CUBIC}};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(kinds); i++)
        if (strcmp(kinds[i].word, word->text) == 0) begin_kind(reader, word, target, kinds[i].kind);
    word_arguments(reader, word, 0, 0);
}

/* planar [ ORIENTATION [, distance] ] */
static void read_planar(Reader *reader, const Word *word, void *target) {
    WarpDraft *draft = target;
    if (!begin_kind(reader, word, draft, WARP_PLANAR) || !word_arguments(reader, word, 0, 2)) return;
    if (word->count > 0) word_vector(reader, word, 0, &draft->warp.orientation);
    if (word->count > 1) word_float(reader, word, 1, &draft->warp.exponent);
}

static void read_reset(Reader *reader, const Word *word, void *target) {
    (void)reader;
    WarpDraft *draft = target;
    draft->kind = word->text;
    draft->ignored = true;
}

#define FIELD(name) offsetof(WarpDraft, warp.name)
#define CUSTOM(word, handler)                                                                                \
    { word, WORD_CUSTOM, 0, handler, false }
static const WordRule rules[] = {
    CUSTOM("black_hole", read_hole),
    CUSTOM("repeat", read_repeat),
    CUSTOM("turbulence", read_turbulence),
    CUSTOM("cylindrical", read_mapping),
    CUSTOM("spherical", read_mapping),
    CUSTOM("toroidal", read_mapping),
    CUSTOM("cubic", read_mapping),
    CUSTOM("planar", read_planar),
    CUSTOM("flip", read_flip),
    CUSTOM("octaves", read_octaves),
    CUSTOM("reset_children", read_reset),
    {"offset", WORD_VECTOR, FIELD(turbulence), NULL, false},
    {"lambda", WORD_FLOAT, FIELD(lambda), NULL, false},
    {"omega", WORD_FLOAT, FIELD(omega), NULL, false},
    {"falloff", WORD_FLOAT, FIELD(falloff), NULL, false},
    {"strength", WORD_FLOAT, FIELD(strength), NULL, false},
    {"inverse", WORD_FLAG, FIELD(inverse), NULL, false},
    {"orientation", WORD_VECTOR, FIELD(orientation), NULL, false},
    {"dist_exp", WORD_FLOAT, FIELD(exponent), NULL, false},
    {"major_radius", WORD_FLOAT, FIELD(major_radius), NULL, false},
};

/* Copies of a black hole lie within their blocks: POV-Ray moves and parts them until they do. */
static void keep_apart(double repeat, double radius, double uncertainty, double *center, double *distance) {
    if (repeat <= 0) return;
    *center = double_max(*center, radius);
    *distance = double_max(repeat, *center + radius + uncertainty);
}

static void part_holes(Warp *w) {
    keep_apart(w->repeat.x, w->radius, w->uncertainty.x, &w->center.x, &w->repeat.x);
    keep_apart(w->repeat.y, w->radius, w->uncertainty.y, &w->center.y, &w->repeat.y);
    keep_apart(w->repeat.z, w->radius, w->uncertainty.z, &w->center.z, &w->repeat.z);
}

/* The warp comes after all transforms so far, which it takes over; later ones come after it. */
static void add_warp(Reader *reader, Pigment *pigment, Warp warp) {
    Warp *warps = arena_new_array(reader->context->arena, Warp, pigment->warp_count + 1);
    if (pigment->warp_count) memcpy(warps, pigment->warps, pigment->warp_count * sizeof *warps);
    warp.inner = pigment->transform;
    if (warp.repeated) part_holes(&warp);
    warps[pigment->warp_count++] = warp;
    pigment->warps = warps;
    pigment->transform = transform_identity();
}

void read_warp(Reader *reader, const Word *word, void *target) {
    WarpDraft draft = {.warp = {.octaves = 6,
                                .lambda = 2,
                                .omega = 0.5,
                                .flip = {1, 1, 1},
                                .strength = 1,
                                .falloff = 2,
                                .orientation = {0, 0, 1},
                                .major_radius = 1}};
    if (!word->body) {
        reader_error(reader, word->span, "'warp' is followed by { … }");
        return;
    }
    Transform own = transform_identity();
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, rules, VTS_ARRAY_COUNT(rules), &draft);
    reader_add_table(&body, transform_rules, transform_rule_count, &own);
    reader_run(&body);
    if (!reader_end_nested(reader, &body)) return;
    Pigment *pigment = &((PigmentDraft *)target)->pigment;
    pigment->transform = transform_then(&pigment->transform, &own);
    if (draft.kind && !draft.ignored) add_warp(reader, pigment, draft.warp);
}
