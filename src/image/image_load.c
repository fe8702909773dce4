#include "image/image.h"

#include "image/oiio_module.h"
#include "image/pnm.h"
#include "image/srgb.h"
#include "image/whole_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

/* What stands for 1 in files of this kind of sample; 0 for those that hold plain numbers. */
static double full_scale(ImageSample sample) {
    switch (sample) {
    case IMAGE_SAMPLE_U8: return 0xFF;
    case IMAGE_SAMPLE_I8: return 0x7F;
    case IMAGE_SAMPLE_U16: return 0xFFFF;
    case IMAGE_SAMPLE_I16: return 0x7FFF;
    case IMAGE_SAMPLE_U32: return 0xFFFFFFFF;
    case IMAGE_SAMPLE_I32: return 0x7FFFFFFF;
    default: return 0;
    }
}

/* Codes of 8 and 16 bits take few values: the curve is computed once for each. NULL: not worth it, or no memory. */
static float *decoding_table(ImageSample sample) {
    if (sample != IMAGE_SAMPLE_U8 && sample != IMAGE_SAMPLE_U16) return NULL;
    size_t count = (size_t)full_scale(sample) + 1;
    float *table = malloc(count * sizeof *table);
    for (size_t i = 0; table && i < count; i++)
        table[i] = (float)srgb_decode((double)i / (double)(count - 1));
    return table;
}

static void multiply_alpha(float *pixel, int channels, int alpha) {
    for (int c = 0; c < channels; c++)
        if (c != alpha) pixel[c] *= pixel[alpha];
}

/* Stored numbers → linear light, associated alpha, in place. */
static void to_colour(Image *image, const OiioHeader *header) {
    double scale = full_scale(header->sample);
    float *table = scale > 0 && !header->linear ? decoding_table(header->sample) : NULL;
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < count; i++) {
        float *pixel = image->pixels + i * (size_t)image->channels;
        for (int c = 0; scale > 0 && c < image->channels; c++)
            if (c == header->alpha || header->linear)
                pixel[c] = (float)((double)pixel[c] / scale);
            else
                pixel[c] = table ? table[(size_t)pixel[c]] : (float)srgb_decode((double)pixel[c] / scale);
        if (header->alpha >= 0 && header->alpha_unassociated)
            multiply_alpha(pixel, image->channels, header->alpha);
    }
    free(table);
}

static bool fail(StrBuf *error, const char *path, const char *why) {
    if (error) strbuf_addf(error, "cannot read '%s': %s", path, why);
    return false;
}

static bool read_opened(Image *image, const OiioShim *shim, OiioReader *reader, const OiioHeader *header,
                        const char *path, ImageReading reading, MemoryBudget *budget, StrBuf *error) {
    char why[OIIO_ERROR_SIZE];
    if (!image_init(image, header->width, header->height, header->channels, header->names, budget, error))
        return false;
    if (!shim->read(reader, image->pixels, why)) {
        image_free(image);
        return fail(error, path, why);
    }
    image->stored_as = header->sample;
    image->colour_stored_as = header->colour_sample;
    image->stored_linear = header->linear;
    image->coded = reading == IMAGE_AS_STORED && full_scale(header->sample) > 0;
    for (size_t i = 0; i < header->attribute_count; i++) {
        const ImageAttribute *attribute = &header->attributes[i];
        if (attribute->text)
            image_set_text(image, attribute->name, attribute->text);
        else
            image_set_number(image, attribute->name, attribute->number);
    }
    if (reading == IMAGE_AS_COLOUR) to_colour(image, header);
    return true;
}

static bool load_with_oiio(Image *image, const char *path, ImageReading reading, MemoryBudget *budget,
                           StrBuf *error) {
    StrBuf missing = {0};
    const OiioShim *shim = oiio_module_load(&missing);
    if (!shim) {
        fail(error, path, missing.data);
        strbuf_free(&missing);
        return false;
    }
    char why[OIIO_ERROR_SIZE];
    OiioReader *reader;
    OiioHeader header;
    if (!shim->open(path, &reader, &header, why)) return fail(error, path, why);
    bool done = read_opened(image, shim, reader, &header, path, reading, budget, error);
    shim->close(reader);
    return done;
}

bool image_load(Image *image, const char *path, ImageReading reading, MemoryBudget *budget, StrBuf *error) {
    *image = (Image){0};
    unsigned char magic[4];
    struct stat info;
    /* It is opened more than once; and a pipe might wait for ever. */
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode)) return fail(error, path, "it is no regular file");
    FILE *stream = fopen(path, "rb");
    size_t got = stream ? fread(magic, 1, sizeof magic, stream) : 0;
    if (stream) fclose(stream);
    if (stream && got > 0 && !pnm_recognizes(magic, got))
        return load_with_oiio(image, path, reading, budget, error);
    size_t size;
    unsigned char *data = whole_file_read(path, &size, error);
    if (!data) return false;
    bool done = pnm_recognizes(data, size) ? pnm_decode(image, data, size, path, reading, budget, error)
                                           : fail(error, path, "it is empty");
    free(data);
    return done;
}
