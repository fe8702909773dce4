#include "image/image_part.h"

#include <stdlib.h>
#include <string.h>

/* Holes that are named; there may be more. */
enum { MOST_HOLES = 4 };

typedef struct Stitching {
    const char *const *paths;
    size_t count;
    const char *output;
    ImageReading reading;
    ImagePart first; /* the part that says what the whole is */
    ImageSample sample;
    Image whole;
    unsigned *owner; /* of each pixel: the number of its part from 1; 0: none yet */
    StrBuf *error;
} Stitching;

/* The value of a piece of metadata: of its own, or a line of the description; "" when there is none. Owned by `out`. */
static const char *value_of(const Image *image, const char *name, StrBuf *out) {
    const ImageAttribute *own = image_attribute(image, name), *description = image_attribute(image, "ImageDescription");
    size_t size = strlen(name);
    strbuf_adds(out, "");
    if (own && own->text) strbuf_adds(out, own->text);
    if (own && !own->text) strbuf_addf(out, "%.17g", own->number);
    if (own || !description || !description->text) return out->data ? out->data : "";
    for (const char *at = description->text; at; at = (at = strchr(at, '\n')) ? at + 1 : NULL)
        if (strncmp(at, name, size) == 0 && at[size] == '=') strbuf_add(out, at + size + 1, strcspn(at + size + 1, "\r\n"));
    return out->data ? out->data : "";
}

/* Of parts whose keys differ: names the first thing in which they do. */
static void tell_difference(const Stitching *s, const Image *part, const char *path) {
    static const struct {
        const char *name, *words;
    } rows[] = {{"vts:scene", "scene"}, {"vts:frame", "frame"}, {"vts:clock", "clock"}, {"vts:version", "version of the program"},
                {"vts:exposure", "exposure"}};
    strbuf_addf(s->error, "'%s' is no part of the picture that '%s' belongs to: ", path, s->paths[0]);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(rows); i++) {
        StrBuf here = {0}, there = {0};
        const char *a = value_of(part, rows[i].name, &here), *b = value_of(&s->whole, rows[i].name, &there);
        bool differ = *a && *b && strcmp(a, b) != 0;
        if (differ) strbuf_addf(s->error, "its %s is %s, not %s", rows[i].words, a, b);
        strbuf_free(&here);
        strbuf_free(&there);
        if (differ) return;
    }
    strbuf_adds(s->error, "the scene or what it was drawn with has changed in between");
}

/* Metadata of the whole: the parts' own, without what makes them parts, and without what a file format says of itself. */
static void take_metadata(Image *whole, const Image *part) {
    for (size_t i = 0; i < part->attribute_count; i++) {
        const ImageAttribute *a = &part->attributes[i];
        bool ours = strcmp(a->name, "Software") == 0 || strncmp(a->name, "vts:", 4) == 0;
        if (!ours || strcmp(a->name, IMAGE_PART_NAME) == 0) continue;
        if (a->text) image_set_text(whole, a->name, a->text);
        else image_set_number(whole, a->name, a->number);
    }
}

/* The description's lines, "name=value". */
static void take_description(Image *whole, const Image *part) {
    const ImageAttribute *description = image_attribute(part, "ImageDescription");
    for (const char *at = description ? description->text : NULL; at && *at;) {
        size_t line = strcspn(at, "\r\n"), name = strcspn(at, "=");
        if (name < line) {
            char *copy = arena_printf(&whole->texts, "%.*s", (int)line, at);
            copy[name] = '\0';
            if (strcmp(copy, IMAGE_PART_NAME) != 0) image_set_text(whole, copy, copy + name + 1);
        }
        at += line + strspn(at + line, "\r\n");
    }
}

static bool begin_whole(Stitching *s, const Image *part) {
    int width = s->first.whole_width, height = s->first.whole_height;
    if (!image_init(&s->whole, width, height, part->channels, part->names, NULL, s->error)) return false;
    s->owner = calloc((size_t)width * (size_t)height, sizeof *s->owner);
    if (!s->owner) {
        strbuf_adds(s->error, "not enough memory");
        return false;
    }
    s->whole.coded = part->coded;
    s->whole.stored_as = part->stored_as;
    s->sample = part->colour_stored_as;
    take_metadata(&s->whole, part);
    take_description(&s->whole, part);
    return true;
}

static bool same_channels(const Image *a, const Image *b) {
    bool same = a->channels == b->channels && a->coded == b->coded;
    for (int c = 0; same && c < a->channels; c++) same = strcmp(a->names[c], b->names[c]) == 0;
    return same;
}

static bool fits(const Stitching *s, const Image *image, const ImagePart *part, const char *path) {
    if (part->whole_width != s->first.whole_width || part->whole_height != s->first.whole_height)
        strbuf_addf(s->error, "'%s' is a part of %d x %d pixels, '%s' of %d x %d", path, part->whole_width, part->whole_height, s->paths[0],
                    s->first.whole_width, s->first.whole_height);
    else if (part->key != s->first.key)
        tell_difference(s, image, path);
    else if (!same_channels(image, &s->whole) || image->stored_as != s->whole.stored_as || image->colour_stored_as != s->sample)
        strbuf_addf(s->error, "'%s' has other channels or samples than '%s'", path, s->paths[0]);
    else
        return true;
    return false;
}

/* Bit by bit: a NaN is equal to itself. */
static bool place_pixels(Stitching *s, const Image *image, const ImagePart *part, unsigned number) {
    size_t bytes = (size_t)image->channels * sizeof(float);
    for (int y = 0; y < part->height; y++)
        for (int x = 0; x < part->width; x++) {
            unsigned *owner = &s->owner[(size_t)(y + part->y) * (size_t)s->whole.width + (size_t)(x + part->x)];
            const float *from = image_pixel(image, x, y);
            float *to = image_pixel(&s->whole, x + part->x, y + part->y);
            if (*owner && memcmp(to, from, bytes) != 0) {
                strbuf_addf(s->error, "'%s' and '%s' overlap and differ at %d,%d", s->paths[number - 1], s->paths[*owner - 1], x + part->x,
                            y + part->y);
                return false;
            }
            memcpy(to, from, bytes);
            if (!*owner) *owner = number;
        }
    return true;
}

static StitchStatus add_part(Stitching *s, size_t i) {
    Image image;
    ImagePart part;
    const char *path = s->paths[i];
    if (!image_load(&image, path, s->reading, NULL, s->error)) return STITCH_FILE;
    StitchStatus status = STITCH_OK;
    if (!image_part_of(&image, &part)) {
        strbuf_addf(s->error, "'%s' does not say of which picture it is a part: only what was drawn with --region does, and .hdr cannot", path);
        status = STITCH_MISFIT;
    } else if (i == 0) {
        s->first = part;
        status = begin_whole(s, &image) ? STITCH_OK : STITCH_FILE;
    }
    if (status == STITCH_OK && !(fits(s, &image, &part, path) && place_pixels(s, &image, &part, (unsigned)i + 1))) status = STITCH_MISFIT;
    image_free(&image);
    return status;
}

/* The largest rectangle from here to the right, and then down, that nobody owns; it is owned afterwards. */
static void fill_hole(Stitching *s, int x0, int y0, int *x1, int *y1) {
    size_t width = (size_t)s->whole.width;
    for (*x1 = x0; *x1 < s->whole.width && !s->owner[(size_t)y0 * width + (size_t)*x1]; ++*x1) continue;
    bool empty = true;
    for (*y1 = y0; *y1 < s->whole.height && empty; *y1 += empty)
        for (int x = x0; x < *x1; x++) empty &= !s->owner[(size_t)*y1 * width + (size_t)x];
    for (int y = y0; y < *y1; y++)
        for (int x = x0; x < *x1; x++) s->owner[(size_t)y * width + (size_t)x] = 1;
}

/* Names what is missing as what --region would draw. */
static StitchStatus check_holes(Stitching *s) {
    int holes = 0;
    for (int y = 0; y < s->whole.height; y++)
        for (int x = 0; x < s->whole.width; x++) {
            int x1, y1;
            if (s->owner[(size_t)y * (size_t)s->whole.width + (size_t)x]) continue;
            fill_hole(s, x, y, &x1, &y1);
            if (++holes > MOST_HOLES) continue;
            strbuf_addf(s->error, "%s%d,%d,%d,%d", holes == 1 ? "parts are missing: --region " : ", ", x, y, x1, y1);
        }
    if (holes > MOST_HOLES) strbuf_addf(s->error, " and %d more", holes - MOST_HOLES);
    if (holes) strbuf_addf(s->error, " of %d x %d pixels", s->whole.width, s->whole.height);
    return holes ? STITCH_MISFIT : STITCH_OK;
}

/* Codes stay codes on the way from a format to itself. */
static ImageReading reading_for(const Stitching *s) {
    ImageFormat format = image_format_of(s->output);
    bool codes = format == IMAGE_FORMAT_PNG || format == IMAGE_FORMAT_TIFF || format == IMAGE_FORMAT_PPM || format == IMAGE_FORMAT_PGM;
    for (size_t i = 0; i < s->count; i++) codes &= image_format_of(s->paths[i]) == format;
    return codes ? IMAGE_AS_STORED : IMAGE_AS_COLOUR;
}

StitchStatus image_stitch(const char *const *paths, size_t count, const char *output, StrBuf *error) {
    Stitching s = {.paths = paths, .count = count, .output = output, .error = error};
    if (!image_can_write(output, error)) return STITCH_FILE;
    s.reading = reading_for(&s);
    StitchStatus status = STITCH_OK;
    for (size_t i = 0; i < count && status == STITCH_OK; i++) status = add_part(&s, i);
    if (status == STITCH_OK) status = check_holes(&s);
    /* Samples that the output's format lacks are its default: 16 bits of a PNG stay 16 bits in a PNG alone. */
    if (status == STITCH_OK && !image_save(&s.whole, output, s.sample, error)) status = STITCH_FILE;
    image_free(&s.whole);
    free(s.owner);
    return status;
}
