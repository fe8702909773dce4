/* image_map { [format] "file" options }: everything that the text says about a picture, and where its file lies. */
#include "eval/build_parts.h"

#include <string.h>
#include <strings.h>

typedef struct ImageDraft {
    ImageMap image;
    struct {
        double *items;
        size_t count, capacity;
    } palette;
    Span file; /* where the text names it */
    const UserFunction *made; /* by a function, not from a file; or NULL */
    Span made_span;
    bool textures;
} ImageDraft;

static void take_file(Reader *reader, ImageDraft *draft, const char *name, Span span) {
    if (draft->image.path || draft->made) reader_error(reader, span, "a second picture");
    draft->image.path = picture_find(reader->context, name, draft->image.format, span);
    draft->file = span;
    reader->failed |= draft->image.path == NULL;
}

static void read_format(Reader *reader, const Word *word, void *target) {
    ImageDraft *draft = target;
    const char *name;
    if (!word_arguments(reader, word, 1, 1) || !word_string(reader, word, 0, &name)) return;
    draft->image.format = arena_strdup(reader->context->arena, word->text);
    take_file(reader, draft, name, word->arguments[0].span);
}

static void read_map_type(Reader *reader, const Word *word, void *target) {
    int *type = &((ImageDraft *)target)->image.map_type;
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, type)) return;
    if (*type < 0 || (*type > 2 && *type != 5 && *type != 7))
        reader_error(reader, word->arguments[0].span, "'map_type' is 0, 1, 2, 5 or 7, found %d", *type);
}

static void read_gamma(Reader *reader, const Word *word, void *target) {
    double *gamma = &((ImageDraft *)target)->image.gamma;
    Word curve;
    if (word->count == 0 && reader_take_word(reader, "srgb", &curve))
        *gamma = -1;
    else if (word_arguments(reader, word, 1, 1) && word_float(reader, word, 0, gamma) && !(*gamma > 0))
        reader_error(reader, word->arguments[0].span, "'gamma' must be greater than 0, found %g", *gamma);
}

static void read_premultiplied(Reader *reader, const Word *word, void *target) {
    ImageMap *image = &((ImageDraft *)target)->image;
    double on = 1;
    if (!word_arguments(reader, word, 0, 1) || (word->count && !word_float(reader, word, 0, &on))) return;
    image->premultiplied = on != 0;
    image->straight = on == 0;
}

/* `filter all 0.3`, `filter 5, 0.3` of palette entry 5; the same of transmit. */
static void read_share(Reader *reader, const Word *word, void *target) {
    ImageDraft *draft = target;
    bool filter = word->text[0] == 'f';
    Word all;
    if (word->count == 0 && reader_take_word(reader, "all", &all)) {
        if (word_arguments(reader, &all, 1, 1))
            word_float(reader, &all, 0, filter ? &draft->image.filter_all : &draft->image.transmit_all);
        return;
    }
    double entry[2];
    if (!word_arguments(reader, word, 2, 2) || !word_float(reader, word, 0, &entry[0]) ||
        !word_float(reader, word, 1, &entry[1]))
        return;
    *list_push(reader->context->arena, &draft->palette) = entry[0];
    *list_push(reader->context->arena, &draft->palette) = filter ? entry[1] : 0;
    *list_push(reader->context->arena, &draft->palette) = filter ? 0 : entry[1];
}

#define FORMAT(word)                                                                                         \
    { word, WORD_CUSTOM, 0, read_format, false }
#define FIELD(name) offsetof(ImageDraft, image.name)
static const WordRule rules[] = {
    FORMAT("gif"),
    FORMAT("tga"),
    FORMAT("png"),
    FORMAT("ppm"),
    FORMAT("pgm"),
    FORMAT("jpeg"),
    FORMAT("tiff"),
    FORMAT("sys"),
    FORMAT("iff"),
    FORMAT("exr"),
    FORMAT("hdr"),
    {"map_type", WORD_CUSTOM, 0, read_map_type, false},
    {"interpolate", WORD_INT, FIELD(interpolate), NULL, false},
    {"once", WORD_MARK, FIELD(once), NULL, false},
    {"georeferenced", WORD_MARK, FIELD(georeferenced), NULL, false},
    {"use_index", WORD_MARK, FIELD(use_index), NULL, false},
    {"use_color", WORD_IGNORED, 0, NULL, false},
    {"use_colour", WORD_IGNORED, 0, NULL, false},
    {"use_alpha", WORD_MARK, FIELD(use_alpha), NULL, false},
    {"bump_size", WORD_FLOAT, FIELD(bump_size), NULL, false},
    {"premultiplied", WORD_CUSTOM, 0, read_premultiplied, false},
    {"gamma", WORD_CUSTOM, 0, read_gamma, false},
    {"filter", WORD_CUSTOM, 0, read_share, false},
    {"transmit", WORD_CUSTOM, 0, read_share, false},
};

static bool on_value(Reader *reader, const Argument *value, void *target) {
    ImageDraft *draft = target;
    Transform ignored = transform_identity();
    switch (value->value.kind) {
    case VALUE_STRING:
        take_file(reader, draft,
                  arena_printf(reader->context->arena, "%.*s", (int)value->value.as.string.length,
                               value->value.as.string.text),
                  value->span);
        return true;
    case VALUE_FLOAT: return true; /* function WIDTH, HEIGHT { … } */
    case VALUE_FUNCTION:
        if (draft->image.path || draft->made) reader_error(reader, value->span, "a second picture");
        draft->made = value->value.as.function;
        draft->made_span = value->span;
        return true;
    case VALUE_TEXTURE: return draft->textures; /* of a material_map: its reader's */
    default: return take_transform(value, &ignored);
    }
}

enum { LARGEST_SIDE = 1 << 14, MOST_PIXELS = 1 << 24 };

/* A function's picture lies over the unit square: the middles of its outermost pixels are on its rim; its first row has y = 0 and is the
 * top of the picture, as in POV-Ray (measured). */
static const float (*sample(const UserFunction *function, Arena *arena))[4] {
    int columns = function->columns, rows = function->rows;
    float(*pixels)[4] = arena_push_array_(arena, (size_t)columns * (size_t)rows, sizeof *pixels), (*out)[4] = pixels;
    bool colored = tape_output_count(function->tape) >= 3;
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++, out++) {
            double place[3] = {(double)i / int_max(columns - 1, 1), (double)j / int_max(rows - 1, 1), 0};
            double value[TAPE_CALL_MAX] = {0};
            tape_eval_once(function->tape, place, value);
            for (int c = 0; c < 3; c++) (*out)[c] = (float)value[colored ? c : 0];
            (*out)[3] = colored ? (float)double_clamp(1 - value[4], 0, 1) : 1;
        }
    return (const float(*)[4])pixels;
}

static void make_picture(Reader *reader, ImageDraft *draft) {
    const UserFunction *f = draft->made;
    if (f->parameter_count != 3 || f->columns < 1 || f->rows < 1 || f->columns > LARGEST_SIDE || f->rows > LARGEST_SIDE || (int64_t)f->columns * f->rows > MOST_PIXELS) {
        reader_error(reader, draft->made_span, "the function of a picture needs its size before it: 'function 300, 200 {…}', at most %d pixels", MOST_PIXELS);
        return;
    }
    Arena scratch; /* of no budget: whoever runs out of that never comes back to destroy it */
    arena_init(&scratch, NULL, 1 << 16);
    bool good = picture_from_pixels(reader->context, f->columns, f->rows, sample(f, &scratch), &draft->image);
    arena_destroy(&scratch);
    if (!good) reader_error(reader, draft->made_span, "the picture does not fit into the memory limit");
}

static void rehash(ImageMap *image) {
    Hash128 *h = &image->hash;
    *h = hash_begin(0x696d61);
    if (image->path) hash_add(h, image->path, strlen(image->path));
    double numbers[] = {image->map_type,   image->interpolate,   image->once,
                        image->use_index,  image->premultiplied, image->straight,
                        image->filter_all, image->transmit_all,  image->gamma,
                        image->use_alpha,  image->assumed_gamma, image->georeferenced};
    hash_add(h, numbers, sizeof numbers);
    hash_add(h, image->palette_filter, 3 * image->palette_count * sizeof(double));
}

/* As POV-Ray: the numbers of a pattern are those of the file, and so are colours of formats whose gamma nothing tells. */
static double usual_gamma(const ImageMap *image, const char *word) {
    static const char *const plain[] = {"ppm", "pgm", "pnm", "tif", "tiff"};
    const char *dot = image->path ? strrchr(image->path, '.') : NULL;
    const char *format = image->format ? image->format : dot ? dot + 1 : "";
    bool is_plain = strcmp(word, "image_map") != 0;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(plain); i++) is_plain |= strcasecmp(format, plain[i]) == 0;
    return is_plain ? 1 : 0;
}

/* By its own place: nothing is left for map_type to say, and a scene that is nowhere has none for it. */
static void check_place(Reader *reader, const ImageDraft *draft, const Word *word) {
    if (!draft->image.georeferenced || reader->failed) return;
    if (draft->image.map_type != 0) reader_error(reader, word->span, "'georeferenced' and 'map_type' both say how the picture lies");
    if (draft->made) reader_error(reader, word->span, "'georeferenced' is for pictures from files, which say where they lie");
    if (reader->context->geo_origin.set) {
        geo_note_asked(reader->context, word->span);
        return;
    }
    Diagnostic *d = diag_error(reader->context->diags, word->span, "'georeferenced' needs the scene's place on the globe, which is not known yet");
    diag_hint(reader->context->diags, d, "write before it: global_settings { geo_origin <latitude, longitude, height> }, or a terrain");
    reader->failed = true;
}

const ImageMap *image_read(Reader *parent, const Word *word) {
    ImageDraft draft = {.image.span = word->whole, .textures = strcmp(word->text, "material_map") == 0};
    Transform ignored = transform_identity();
    if (!word->body) {
        reader_error(parent, word->span, "'%s' needs its block { … }", word->text);
        return NULL;
    }
    Reader reader = reader_nested(parent, word->body);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), &draft);
    reader_add_table(&reader, transform_rules, transform_rule_count, &ignored);
    reader.on_value = on_value;
    reader.value_target = &draft;
    reader_run(&reader);
    if (!reader.failed && !draft.image.path && !draft.made)
        reader_error(&reader, word->span, "'%s' needs the name of a file", word->text);
    check_place(&reader, &draft, word);
    if (!reader_end_nested(parent, &reader)) return NULL;
    if (draft.made) draft.image.gamma = 1; /* its numbers are the scene's */
    draft.image.palette_filter = draft.palette.items;
    draft.image.palette_count = draft.palette.count / 3;
    bool told = draft.image.gamma != 0 && !draft.made;
    if (!told) draft.image.gamma = usual_gamma(&draft.image, word->text);
    draft.image.assumed_gamma = !told && draft.image.gamma == 1 ? 1 : build_assumed_gamma(parent->context);
    draft.image.use_index = strcmp(word->text, "bump_map") == 0 ? draft.image.use_index : draft.textures;
    rehash(&draft.image);
    if (draft.image.path && !picture_file_load(parent->context, &draft.image, draft.file)) {
        parent->failed = true;
        return NULL;
    }
    if (draft.made) make_picture(parent, &draft);
    return arena_copy(parent->context->arena, &draft.image, sizeof draft.image);
}
