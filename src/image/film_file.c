#include "image/film_file.h"

#include "image/image.h"
#include "image/oiio_module.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { LARGEST_GIF_SIDE = 65535 };

static bool fail(StrBuf *error, const char *path, const char *why) {
    strbuf_addf(error, "cannot write '%s': %s", path, why);
    return false;
}

/* R G B of 8 bits; grey stands for all three. */
static void bytes_of(const Image *image, unsigned char *bytes) {
    int r = image_channel(image, "R"), g = image_channel(image, "G"), b = image_channel(image, "B");
    int from[3] = {int_max(r, 0), g >= 0 ? g : int_max(r, 0), b >= 0 ? b : int_max(r, 0)};
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            for (int c = 0; c < 3; c++)
                *bytes++ = (unsigned char)float_clamp(image_pixel(image, x, y)[from[c]], 0, 255);
}

static bool add_picture(const OiioShim *shim, OiioFilm *film, const char *path, int width, int height,
                        unsigned char *bytes, StrBuf *error) {
    Image image = {0};
    char why[OIIO_ERROR_SIZE] = "";
    bool loaded = image_load(&image, path, IMAGE_AS_STORED, NULL, error),
         fits = loaded && image.width == width && image.height == height;
    if (loaded && !fits)
        strbuf_addf(error, "'%s' has %d x %d pixels, those before it %d x %d", path, image.width,
                    image.height, width, height);
    if (fits) bytes_of(&image, bytes);
    image_free(&image);
    if (!fits) return false;
    return shim->film_add(film, bytes, why) || fail(error, path, why);
}

static bool size_of(const char *path, int *width, int *height, StrBuf *error) {
    Image first = {0};
    bool loaded = image_load(&first, path, IMAGE_AS_STORED, NULL, error);
    *width = first.width, *height = first.height;
    image_free(&first);
    return loaded;
}

static bool write_all(const OiioShim *shim, const char *const *paths, size_t count, double fps,
                      const char *path, StrBuf *error) {
    int width, height;
    OiioFilm *film;
    char why[OIIO_ERROR_SIZE] = "";
    if (!size_of(paths[0], &width, &height, error)) return false;
    if (width > LARGEST_GIF_SIDE || height > LARGEST_GIF_SIDE)
        return fail(error, path, "a GIF has at most 65535 pixels each way");
    unsigned char *bytes = malloc((size_t)width * (size_t)height * 3);
    if (!bytes) return fail(error, path, "not enough memory");
    bool good = shim->film_open(path, "gif", width, height, fps, &film, why) || fail(error, path, why),
         opened = good;
    for (size_t i = 0; i < count && good; i++)
        good = add_picture(shim, film, paths[i], width, height, bytes, error);
    if (opened && !shim->film_close(film, why) && good) good = fail(error, path, why);
    free(bytes);
    return good;
}

/* OpenImageIO's writer of GIFs does not see that a disk is full: a file ends with a semicolon, 0x3B. */
static bool ends_as_gif(const char *path) {
    FILE *file = fopen(path, "rb");
    bool whole = file && fseek(file, -1, SEEK_END) == 0 && fgetc(file) == 0x3B;
    if (file) fclose(file);
    return whole;
}

bool film_file_save_gif(const char *const *paths, size_t count, double fps, const char *output_path,
                        StrBuf *error) {
    const OiioShim *shim = oiio_module_load(error);
    if (!shim) return false;
    StrBuf temporary = {0};
    strbuf_addf(&temporary, "%s.%ld.tmp.gif", output_path, (long)getpid());
    bool good = write_all(shim, paths, count, fps, temporary.data, error);
    if (good && !ends_as_gif(temporary.data))
        good = fail(error, output_path, "the disk is full, or it fails");
    if (good && rename(temporary.data, output_path) != 0) good = fail(error, output_path, strerror(errno));
    if (!good) unlink(temporary.data);
    strbuf_free(&temporary);
    return good;
}
