#include "image/png_file.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>

enum { SIGNATURE = 8, KEYWORD = 79 };

bool png_file_recognizes(const unsigned char *data, size_t size) {
    return size >= 4 && png_sig_cmp(data, 0, size_min(size, SIGNATURE)) == 0;
}

/* libpng's errors leave by longjmp, with their text in OIIO_ERROR_SIZE characters. */
static void fail(png_structp png, png_const_charp text) {
    char *why = png_get_error_ptr(png);
    snprintf(why, OIIO_ERROR_SIZE, "%s", text);
    png_longjmp(png, 1);
}

static void ignore_warning(png_structp png, png_const_charp text) { (void)png, (void)text; }

/* ---- reading ---- */

/* Everything lies in here: after a longjmp locals may have lost their values. */
typedef struct Reading {
    const unsigned char *data;
    size_t size, at;
    png_structp png;
    png_infop info;
    Image *image;
    OiioHeader *header;
    MemoryBudget *budget;
    StrBuf *error;
    unsigned char *rows; /* one, or all of an interlaced picture */
    char why[OIIO_ERROR_SIZE];
} Reading;

static void take_bytes(png_structp png, png_bytep out, size_t count) {
    Reading *r = png_get_io_ptr(png);
    if (count > r->size - r->at) png_error(png, "it ends too soon");
    memcpy(out, r->data + r->at, count);
    r->at += count;
}

/* Integers that hold linear light, says the file. */
static bool is_linear(const Reading *r) {
    double gamma;
    int intent;
    if (png_get_sRGB(r->png, r->info, &intent)) return false;
    return png_get_gAMA(r->png, r->info, &gamma) && fabs(gamma - 1) < 0.01;
}

static bool read_header(Reading *r) {
    png_read_info(r->png, r->info);
    *r->header = (OiioHeader){.linear = is_linear(r)};
    png_set_expand(r->png);
    int channels = png_get_channels(r->png, r->info);
    bool palette = png_get_color_type(r->png, r->info) == PNG_COLOR_TYPE_PALETTE;
    bool keyed = png_get_valid(r->png, r->info, PNG_INFO_tRNS) != 0;
    channels = (palette ? 3 : channels) + keyed;
    r->header->sample = png_get_bit_depth(r->png, r->info) == 16 ? IMAGE_SAMPLE_U16 : IMAGE_SAMPLE_U8;
    r->header->alpha = channels % 2 == 0 ? channels - 1 : -1;
    r->header->alpha_unassociated = true;
    return image_init(r->image, (int)png_get_image_width(r->png, r->info),
                      (int)png_get_image_height(r->png, r->info), channels, NULL, r->budget, r->error);
}

static void widen_row(const Reading *r, const unsigned char *codes, int y) {
    float *out = image_pixel(r->image, 0, y);
    size_t count = (size_t)r->image->width * (size_t)r->image->channels;
    if (r->header->sample == IMAGE_SAMPLE_U16)
        for (size_t i = 0; i < count; i++) out[i] = (float)(codes[2 * i] << 8 | codes[2 * i + 1]);
    else
        for (size_t i = 0; i < count; i++) out[i] = (float)codes[i];
}

static void read_rows(Reading *r) {
    int passes = png_set_interlace_handling(r->png);
    png_read_update_info(r->png, r->info);
    size_t stride = png_get_rowbytes(r->png, r->info), kept = passes > 1 ? (size_t)r->image->height : 1;
    r->rows = calloc(kept, stride);
    if (!r->rows) png_error(r->png, "not enough memory");
    for (int pass = 0; pass < passes; pass++)
        for (int y = 0; y < r->image->height; y++) {
            unsigned char *row = r->rows + (kept > 1 ? (size_t)y * stride : 0);
            png_read_row(r->png, row, NULL);
            if (pass == passes - 1) widen_row(r, row, y);
        }
    png_read_end(r->png, r->info);
}

static void take_texts(Reading *r) {
    png_textp texts;
    int count;
    png_get_text(r->png, r->info, &texts, &count);
    for (int i = 0; i < count; i++)
        image_set_text(r->image, texts[i].key, texts[i].text ? texts[i].text : "");
}

/* False with a text in `why`, or in `error` already. */
static bool read_guarded(Reading *r) {
    if (setjmp(png_jmpbuf(r->png))) return false;
    png_set_read_fn(r->png, r, take_bytes);
    if (!read_header(r)) return false;
    read_rows(r);
    take_texts(r);
    return true;
}

bool png_file_decode(Image *image, const unsigned char *data, size_t size, const char *path,
                     MemoryBudget *budget, OiioHeader *header, StrBuf *error) {
    Reading r = {
        .data = data, .size = size, .image = image, .header = header, .budget = budget, .error = error};
    *image = (Image){0};
    r.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, r.why, fail, ignore_warning);
    if (r.png) r.info = png_create_info_struct(r.png);
    bool done = r.info && read_guarded(&r);
    if (!r.info) snprintf(r.why, sizeof r.why, "libpng cannot be started");
    png_destroy_read_struct(&r.png, &r.info, NULL);
    free(r.rows);
    if (done) return true;
    image_free(image);
    if (*r.why && error) strbuf_addf(error, "cannot read '%s': %s", path, r.why);
    return false;
}

/* ---- writing ---- */

typedef struct Writing {
    png_structp png;
    png_infop info;
    const OiioPicture *picture;
    StrBuf *out;
} Writing;

static void put_bytes(png_structp png, png_bytep bytes, size_t count) {
    const Writing *w = png_get_io_ptr(png);
    strbuf_add(w->out, (const char *)bytes, count);
}

static void flush_nothing(png_structp png) { (void)png; }

static bool is_ascii(const char *text) {
    while (*text)
        if ((unsigned char)*text++ > 0x7E) return false;
    return true;
}

static void put_attribute(const Writing *w, const ImageAttribute *attribute) {
    char key[KEYWORD + 1], number[32], *text = number;
    snprintf(key, sizeof key, "%s", attribute->name);
    snprintf(number, sizeof number, "%.17g", attribute->number);
    if (attribute->text) text = (char *)(uintptr_t)attribute->text; /* libpng copies it */
    png_text chunk = {.compression = is_ascii(text) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE,
                      .key = key,
                      .text = text,
                      .text_length = strlen(text)};
    png_set_text(w->png, w->info, &chunk, 1);
}

static void write_rows(const Writing *w) {
    const OiioPicture *p = w->picture;
    bool wide = p->sample == IMAGE_SAMPLE_U16;
    size_t stride = (size_t)p->width * (size_t)p->channels * (wide ? 2 : 1);
    static const uint16_t one = 1;
    if (wide && *(const unsigned char *)&one == 1)
        png_set_swap(w->png); /* the file's high byte is the first */
    for (int y = 0; y < p->height; y++)
        png_write_row(w->png, (const unsigned char *)p->data + (size_t)y * stride);
}

static bool write_guarded(const Writing *w) {
    static const int types[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                PNG_COLOR_TYPE_RGB_ALPHA};
    const OiioPicture *p = w->picture;
    if (setjmp(png_jmpbuf(w->png))) return false;
    png_set_write_fn(w->png, (void *)(uintptr_t)w, put_bytes, flush_nothing);
    png_set_IHDR(w->png, w->info, (png_uint_32)p->width, (png_uint_32)p->height,
                 p->sample == IMAGE_SAMPLE_U16 ? 16 : 8, types[p->channels - 1], PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (p->srgb) png_set_sRGB_gAMA_and_cHRM(w->png, w->info, PNG_sRGB_INTENT_PERCEPTUAL);
    for (size_t i = 0; i < p->attribute_count; i++) put_attribute(w, &p->attributes[i]);
    png_write_info(w->png, w->info);
    write_rows(w);
    png_write_end(w->png, w->info);
    return true;
}

bool png_file_encode(const OiioPicture *picture, StrBuf *out, char error[OIIO_ERROR_SIZE]) {
    Writing w = {.picture = picture, .out = out};
    snprintf(error, OIIO_ERROR_SIZE, "libpng cannot be started");
    w.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, error, fail, ignore_warning);
    if (w.png) w.info = png_create_info_struct(w.png);
    bool done = w.info && write_guarded(&w);
    png_destroy_write_struct(&w.png, &w.info);
    return done;
}
