/* cloth { size <3, 2> grid 24, 16 pin left … }: an object whose surface is a sheet of springs and masses at the scene's time. */
#include "eval/build_parts.h"

/* What masses may be in a sheet; their springs take 0.5 GB. */
enum { MOST_MASSES = 1000000 };

typedef struct ClothDraft {
    ObjectDraft common;
    ClothSpec spec;
} ClothDraft;

static void read_size(Reader *reader, const Word *word, void *target) {
    ClothSpec *spec = &((ClothDraft *)target)->spec;
    Vec3 size;
    if (!word_arguments(reader, word, 1, 1) || !word_vector(reader, word, 0, &size)) return;
    if (!(size.x > 0 && size.y > 0)) reader_error(reader, word->arguments[0].span, "'size' must be greater than 0 along both sides, found <%g, %g>", size.x, size.y);
    spec->width = size.x, spec->height = size.y;
}

static void read_grid(Reader *reader, const Word *word, void *target) {
    ClothSpec *spec = &((ClothDraft *)target)->spec;
    int nu, nv;
    if (!word_arguments(reader, word, 2, 2) || !word_int(reader, word, 0, &nu) || !word_int(reader, word, 1, &nv)) return;
    if (nu < 1 || nv < 1 || (nu + 1.0) * (nv + 1.0) > MOST_MASSES) {
        reader_error(reader, word->whole, "'grid' must be at least 1, 1, and at most %d corners, found %d, %d", MOST_MASSES, nu, nv);
        return;
    }
    spec->nu = nu, spec->nv = nv;
}

/* pin left right: what is held, one word after the other. */
static void read_pin(Reader *reader, const Word *word, void *target) {
    static const struct {
        const char *word;
        unsigned pin;
    } sides[] = {{"left", CLOTH_PIN_LEFT}, {"right", CLOTH_PIN_RIGHT}, {"top", CLOTH_PIN_TOP}, {"bottom", CLOTH_PIN_BOTTOM}, {"corners", CLOTH_PIN_CORNERS}};
    ClothSpec *spec = &((ClothDraft *)target)->spec;
    bool any = false, found = word->count == 0;
    while (found) {
        found = false;
        for (size_t i = 0; i < VTS_ARRAY_COUNT(sides) && !found; i++) {
            Word side;
            if (!reader_take_word(reader, sides[i].word, &side)) continue;
            spec->pins |= sides[i].pin;
            any = found = true;
            if (side.count) word_arguments(reader, &side, 0, 0);
        }
    }
    if (!any) reader_expect_word(reader, word, "left, right, top, bottom or corners");
}

static void read_share(Reader *reader, const Word *word, double *out) {
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, out)) return;
    if (*out < 0) reader_error(reader, word->arguments[0].span, "'%s' must not be negative, found %g", word->text, *out);
}

static void read_stiffness(Reader *reader, const Word *word, void *target) { read_share(reader, word, &((ClothDraft *)target)->spec.stiffness); }
static void read_damping(Reader *reader, const Word *word, void *target) { read_share(reader, word, &((ClothDraft *)target)->spec.damping); }
static void read_elongation(Reader *reader, const Word *word, void *target) { read_share(reader, word, &((ClothDraft *)target)->spec.elongation); }

static const WordRule rules[] = {
    {"size", WORD_CUSTOM, 0, read_size, true},
    {"grid", WORD_CUSTOM, 0, read_grid, true},
    {"pin", WORD_CUSTOM, 0, read_pin, false},
    {"mass", WORD_POSITIVE, offsetof(ClothDraft, spec.mass), NULL, true},
    {"stiffness", WORD_CUSTOM, 0, read_stiffness, true},
    {"damping", WORD_CUSTOM, 0, read_damping, true},
    {"elongation", WORD_CUSTOM, 0, read_elongation, true},
    {"gravity", WORD_VECTOR, offsetof(ClothDraft, spec.gravity), NULL, true},
    {"wind_field", WORD_IGNORED, 0, NULL, true}, /* arrives as a value; here for "did you mean" */
};

static bool on_value(Reader *reader, const Argument *value, void *target) {
    ClothDraft *draft = target;
    if (value->value.kind != VALUE_WIND_FIELD) return object_on_value(reader, value, &draft->common);
    if (draft->spec.wind) reader_error(reader, value->span, "'wind_field' stands twice in 'cloth'");
    draft->spec.wind = value->value.as.wind_field;
    return true;
}

static bool lay(BuildContext *context, ClothDraft *draft) {
    Surface *surface = arena_new(context->arena, Surface);
    Vec3 *points = arena_new_array(context->arena, Vec3, cloth_mass_count(&draft->spec));
    if (!cloth_places(context, &draft->spec, draft->common.object.span, points)) return false;
    *surface = (Surface){.span = draft->common.object.span, .kind = SURFACE_PATCHES, .nu = draft->spec.nu, .nv = draft->spec.nv,
                         .points = points, .uv_axis = {0, 1, 0}, .texture = draft->common.object.texture, .transform = transform_identity()};
    surface_rehash(surface);
    draft->common.object.as.surface = surface;
    return true;
}

bool build_cloth(BuildContext *context, const EvalBlock *block, Value *out) {
    if (object_is_copy(block)) return build_object(context, block, out);
    ClothDraft draft = {.common = object_begin(block, OBJECT_SURFACE), .spec = cloth_default()};
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), &draft);
    reader.on_value = on_value;
    reader.value_target = &draft;
    return object_read(&reader, &draft.common) && lay(context, &draft) && object_make(&reader, &draft.common, out);
}
