#include "image/image.h"

#include "image/image_part.h"
#include "image/oiio_module.h"
#include "image/pnm.h"
#include "image/srgb.h"
#include "image/whole_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

typedef struct FormatRow {
    const char *suffix;
    ImageFormat format;
} FormatRow;

static const FormatRow FORMATS[] = {
    {".exr", IMAGE_FORMAT_EXR},   {".png", IMAGE_FORMAT_PNG},  {".tif", IMAGE_FORMAT_TIFF},
    {".tiff", IMAGE_FORMAT_TIFF}, {".jpg", IMAGE_FORMAT_JPEG}, {".jpeg", IMAGE_FORMAT_JPEG},
    {".hdr", IMAGE_FORMAT_HDR},   {".pfm", IMAGE_FORMAT_PFM},  {".ppm", IMAGE_FORMAT_PPM},
    {".pgm", IMAGE_FORMAT_PGM},
};

static const float LARGEST_HALF = 65504;

static const char *suffix_of(const char *path) {
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    return dot ? dot : "";
}

ImageFormat image_format_of(const char *path) {
    const char *suffix = suffix_of(path);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(FORMATS); i++)
        if (strcasecmp(suffix, FORMATS[i].suffix) == 0) return FORMATS[i].format;
    return IMAGE_FORMAT_NONE;
}

bool image_can_write(const char *path, StrBuf *error) {
    if (image_format_of(path) != IMAGE_FORMAT_NONE) return whole_file_can_replace(path, error);
    if (!error) return false;
    if (*suffix_of(path))
        strbuf_addf(error, "cannot write '%s': unknown picture format '%s'", path, suffix_of(path));
    else
        strbuf_addf(error, "cannot write '%s': the name has no suffix to tell the format", path);
    strbuf_adds(error, " (known:");
    for (size_t i = 0; i < VTS_ARRAY_COUNT(FORMATS); i++) strbuf_addf(error, " %s", FORMATS[i].suffix);
    strbuf_adds(error, ")");
    return false;
}

/* What a display format shows of a picture: indices of one or three colour channels, and of alpha or -1. */
typedef struct Selection {
    int index[3];
    int colours;
    int alpha;
} Selection;

static Selection select_channels(const Image *image, bool with_alpha) {
    int r = image_channel(image, "R"), g = image_channel(image, "G"), b = image_channel(image, "B");
    int alpha = with_alpha ? image_channel(image, "A") : -1;
    if (r >= 0 && g >= 0 && b >= 0) return (Selection){{r, g, b}, 3, alpha};
    int grey = int_max(image_channel(image, "Y"), 0);
    return (Selection){{grey, grey, grey}, 1, alpha == grey ? -1 : alpha};
}

/* Three times the same channel, for formats that have only colour. */
static Selection as_colour(Selection selection) {
    selection.colours = 3;
    return selection;
}

static uint16_t quantize(double value, int largest) {
    return (uint16_t)(double_clamp(value > 0 ? value : 0, 0, 1) * largest + 0.5);
}

/* One row through the sRGB curve, alpha unassociated: what 8- and 16-bit files hold. */
static void encode_row(const Image *image, const Selection *selection, int y, int largest, uint16_t *codes) {
    for (int x = 0; x < image->width; x++) {
        const float *pixel = image_pixel(image, x, y);
        if (image->coded) {
            for (int c = 0; c < selection->colours; c++) *codes++ = (uint16_t)pixel[selection->index[c]];
            if (selection->alpha >= 0) *codes++ = (uint16_t)pixel[selection->alpha];
            continue;
        }
        double alpha = selection->alpha >= 0 ? (double)pixel[selection->alpha] : 1;
        double factor = alpha > 0 ? 1 / alpha : 1;
        for (int c = 0; c < selection->colours; c++)
            *codes++ = quantize(srgb_encode((double)pixel[selection->index[c]] * factor), largest);
        if (selection->alpha >= 0) *codes++ = quantize(alpha, largest);
    }
}

static void select_row(const Image *image, const Selection *selection, int y, float *samples) {
    for (int x = 0; x < image->width; x++)
        for (int c = 0; c < selection->colours; c++)
            *samples++ = image_pixel(image, x, y)[selection->index[c]];
}

static bool fail(StrBuf *error, const char *path, const char *why) {
    if (error) strbuf_addf(error, "cannot write '%s': %s", path, why);
    return false;
}

/* Whether the picture's own rows are those of a PFM: its colours alone, in their order. */
static bool is_all(const Image *image, const Selection *selection) {
    bool all = image->channels == selection->colours;
    for (int c = 0; c < selection->colours; c++) all &= selection->index[c] == c;
    return all;
}

/* From the bottom to the top; of pictures that hold nothing else out of their own memory. */
static bool save_pfm(const Image *image, const char *path, StrBuf *error) {
    Selection selection = select_channels(image, false);
    const size_t row = (size_t)image->width * (size_t)selection.colours, height = (size_t)image->height;
    const bool own = pnm_floats_are_own() && is_all(image, &selection);
    FilePiece *pieces = malloc((height + 1) * sizeof *pieces);
    float *samples = own ? NULL : malloc(row * height * sizeof *samples);
    if (!pieces || (!own && !samples)) {
        free(pieces);
        free(samples);
        return fail(error, path, "not enough memory");
    }
    StrBuf header = {0};
    pnm_add_pfm_header(&header, image, selection.colours);
    pieces[0] = (FilePiece){header.data, header.size};
    for (size_t y = 0; y < height; y++) {
        const int from = image->height - 1 - (int)y;
        if (!own) select_row(image, &selection, from, samples + y * row);
        pieces[y + 1] = (FilePiece){own ? image_pixel(image, 0, from) : samples + y * row, row * sizeof *samples};
    }
    if (!own) pnm_floats_to_file(samples, row * height);
    bool done = whole_file_replace_pieces(path, pieces, height + 1, error);
    strbuf_free(&header);
    free(samples);
    free(pieces);
    return done;
}

static bool save_pnm(const Image *image, const char *path, bool colour, bool wide, StrBuf *error) {
    Selection selection = select_channels(image, false);
    if (colour) selection = as_colour(selection);
    size_t row = (size_t)image->width * (size_t)selection.colours;
    uint16_t *codes = malloc(row * sizeof *codes);
    if (!codes) return fail(error, path, "not enough memory");
    int largest = wide ? 0xFFFF : 0xFF;
    StrBuf file = {0};
    pnm_add_header(&file, image, selection.colours, largest);
    for (int y = 0; y < image->height; y++) {
        encode_row(image, &selection, y, largest, codes);
        pnm_add_codes(&file, codes, row, wide);
    }
    bool done = whole_file_replace(path, file.data, file.size, error);
    strbuf_free(&file);
    free(codes);
    return done;
}

/* A colour picture as PGM: its luminance (Rec. 709 primaries, as sRGB's). */
static bool save_pgm(const Image *image, const char *path, bool wide, StrBuf *error) {
    Selection selection = select_channels(image, false);
    if (selection.colours == 1) return save_pnm(image, path, false, wide, error);
    Image grey;
    ImagePart part;
    if (!image_init(&grey, image->width, image->height, 1, NULL, NULL, error)) return false;
    if (image_part_of(image, &part)) image_part_set(&grey, &part);
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            const float *pixel = image_pixel(image, x, y);
            *image_pixel(&grey, x, y) = 0.2126f * pixel[selection.index[0]] +
                                        0.7152f * pixel[selection.index[1]] +
                                        0.0722f * pixel[selection.index[2]];
        }
    bool done = save_pnm(&grey, path, false, wide, error);
    image_free(&grey);
    return done;
}

static bool encode_and_write(const OiioPicture *picture, const char *path, StrBuf *error) {
    StrBuf missing = {0};
    const OiioShim *shim = oiio_module_load(&missing);
    if (!shim) {
        fail(error, path, missing.data);
        strbuf_free(&missing);
        return false;
    }
    char why[OIIO_ERROR_SIZE];
    void *bytes;
    size_t size;
    if (!shim->encode(picture, &bytes, &size, why)) return fail(error, path, why);
    bool done = whole_file_replace(path, bytes, size, error);
    free(bytes);
    return done;
}

static bool is_colour_name(const char *name) { return strlen(name) == 1 && strchr("RGBAY", *name); }

/* Past the largest half there is only infinity; a bright pixel stays finite. */
static void clamp_to_half(float *samples, size_t count) {
    for (size_t i = 0; i < count; i++)
        if (isfinite(samples[i])) samples[i] = float_clamp(samples[i], -LARGEST_HALF, LARGEST_HALF);
}

static bool save_exr(const Image *image, const char *path, bool half, StrBuf *error) {
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    ImageSample *samples = malloc((size_t)image->channels * sizeof *samples);
    float *pixels = half ? malloc(count * sizeof *pixels) : image->pixels;
    bool done = false;
    if (samples && pixels) {
        for (int c = 0; c < image->channels; c++)
            samples[c] = half && is_colour_name(image->names[c]) ? IMAGE_SAMPLE_HALF : IMAGE_SAMPLE_FLOAT;
        if (half) {
            memcpy(pixels, image->pixels, count * sizeof *pixels);
            for (size_t i = 0; i < count; i++)
                if (samples[i % (size_t)image->channels] == IMAGE_SAMPLE_HALF) clamp_to_half(&pixels[i], 1);
        }
        ImagePart part;
        OiioPicture picture = {.format = "openexr", .width = image->width, .height = image->height, .channels = image->channels,
                               .names = image->names, .sample = IMAGE_SAMPLE_FLOAT, .data = pixels, .samples = samples,
                               .alpha = image_channel(image, "A"), .attributes = image->attributes,
                               .attribute_count = image->attribute_count};
        if (image_part_of(image, &part))
            picture.x = part.x, picture.y = part.y, picture.whole_width = part.whole_width, picture.whole_height = part.whole_height;
        done = encode_and_write(&picture, path, error);
    } else {
        fail(error, path, "not enough memory");
    }
    free(samples);
    if (pixels != image->pixels) free(pixels);
    return done;
}

static const char *const *names_of(const Selection *selection) {
    static const char *const names[4][4] = {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
    return names[(selection->colours == 3 ? 2 : 0) + (selection->alpha >= 0 ? 1 : 0)];
}

/* Bytes are packed into the front of the same memory. */
static void narrow(uint16_t *codes, size_t count) {
    uint8_t *bytes = (uint8_t *)codes;
    for (size_t i = 0; i < count; i++) bytes[i] = (uint8_t)codes[i];
}

static bool save_codes(const Image *image, const char *path, const char *format, bool with_alpha, bool wide,
                       StrBuf *error) {
    Selection selection = select_channels(image, with_alpha);
    int channels = selection.colours + (selection.alpha >= 0 ? 1 : 0);
    size_t row = (size_t)image->width * (size_t)channels, count = row * (size_t)image->height;
    uint16_t *codes = malloc(count * sizeof *codes);
    if (!codes) return fail(error, path, "not enough memory");
    for (int y = 0; y < image->height; y++)
        encode_row(image, &selection, y, wide ? 0xFFFF : 0xFF, codes + (size_t)y * row);
    if (!wide) narrow(codes, count);
    OiioPicture picture = {.format = format, .width = image->width, .height = image->height, .channels = channels,
                           .names = names_of(&selection), .sample = wide ? IMAGE_SAMPLE_U16 : IMAGE_SAMPLE_U8, .data = codes,
                           .alpha = selection.alpha >= 0 ? channels - 1 : -1, .srgb = true, .attributes = image->attributes,
                           .attribute_count = image->attribute_count};
    bool done = encode_and_write(&picture, path, error);
    free(codes);
    return done;
}

static bool save_hdr(const Image *image, const char *path, StrBuf *error) {
    Selection selection = as_colour(select_channels(image, false));
    size_t row = (size_t)image->width * 3;
    float *samples = malloc(row * (size_t)image->height * sizeof *samples);
    if (!samples) return fail(error, path, "not enough memory");
    for (int y = 0; y < image->height; y++) select_row(image, &selection, y, samples + (size_t)y * row);
    OiioPicture picture = {.format = "hdr", .width = image->width, .height = image->height, .channels = 3, .names = names_of(&selection),
                           .sample = IMAGE_SAMPLE_FLOAT, .data = samples, .alpha = -1};
    bool done = encode_and_write(&picture, path, error);
    free(samples);
    return done;
}

bool image_save(const Image *image, const char *path, ImageSample sample, StrBuf *error) {
    if (!image_can_write(path, error)) return false;
    bool wide = sample == IMAGE_SAMPLE_U16;
    switch (image_format_of(path)) {
    case IMAGE_FORMAT_EXR: return save_exr(image, path, sample != IMAGE_SAMPLE_FLOAT, error);
    case IMAGE_FORMAT_PNG: return save_codes(image, path, "png", true, wide, error);
    case IMAGE_FORMAT_TIFF: return save_codes(image, path, "tiff", true, sample != IMAGE_SAMPLE_U8, error);
    case IMAGE_FORMAT_JPEG: return save_codes(image, path, "jpeg", false, false, error);
    case IMAGE_FORMAT_HDR: return save_hdr(image, path, error);
    case IMAGE_FORMAT_PFM: return save_pfm(image, path, error);
    case IMAGE_FORMAT_PPM: return save_pnm(image, path, true, wide, error);
    case IMAGE_FORMAT_PGM: return save_pgm(image, path, wide, error);
    case IMAGE_FORMAT_NONE: break;
    }
    return false;
}
