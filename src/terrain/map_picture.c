/* Maps that OpenImageIO reads: GeoTIFF, and any other picture of one channel with a world file beside it. */
#include "image/oiio_module.h"
#include "terrain/map_file.h"
#include "terrain/map_place.h"

#include <stdlib.h>
#include <string.h>

#define MOST_BAND ((size_t)1 << 28) /* samples that may have to be read at a time: lying headers ask for more */

typedef struct PictureReader {
    const OiioShim *shim;
    OiioReader *reader;
    int row_step, rows, columns;
    int row;                   /* the next to be handed out */
    int band_first, band_rows; /* in `band` */
    float *band;
} PictureReader;

static void picture_close(MapFile *file) {
    PictureReader *picture = file->state;
    if (picture->reader) picture->shim->close(picture->reader);
    free(picture->band);
    free(picture);
}

static bool read_band(PictureReader *picture, StrBuf *error) {
    char why[OIIO_ERROR_SIZE] = "";
    picture->band_first = picture->row / picture->row_step * picture->row_step;
    picture->band_rows = int_min(picture->row_step, picture->rows - picture->band_first);
    return picture->shim->read_rows(picture->reader, picture->band_first, 0, picture->band, why) || map_fail(error, "%s", why);
}

static bool picture_read(MapFile *file, int count, float *samples, StrBuf *error) {
    PictureReader *picture = file->state;
    for (; count > 0; count--, picture->row++, samples += picture->columns) {
        bool held = picture->row >= picture->band_first && picture->row < picture->band_first + picture->band_rows;
        if (!held && !read_band(picture, error)) return false;
        memcpy(samples, picture->band + (size_t)(picture->row - picture->band_first) * (size_t)picture->columns,
               (size_t)picture->columns * sizeof *samples);
    }
    return true;
}

/* `picture` is empty but for its shim. */
static bool open_picture(MapFile *file, PictureReader *picture, StrBuf *error) {
    char why[OIIO_ERROR_SIZE] = "";
    OiioHeader header;
    file->state = picture;
    file->close = picture_close;
    file->read = picture_read;
    if (!picture->shim->open(file->path, &picture->reader, &header, why)) return map_fail(error, "%s", why);
    if (header.width < 1 || header.height < 1 || header.width > MAP_LARGEST_SIDE || header.height > MAP_LARGEST_SIDE)
        return map_fail(error, "%d x %d posts are none, or more than a map may have", header.width, header.height);
    size_t band = (size_t)header.row_step * (size_t)header.width;
    picture->band = band <= MOST_BAND ? malloc(band * sizeof *picture->band) : NULL;
    if (!picture->band) return map_fail(error, "its %d rows of %d samples that are stored together are too many", header.row_step, header.width);
    if (header.channels >= 3) return map_fail(error, "it is a picture in colours: heights are one channel");
    picture->row_step = header.row_step;
    file->rows = picture->rows = header.height;
    file->columns = picture->columns = header.width;
    file->samples = image_sample_name(header.sample);
    file->small_samples = header.sample == IMAGE_SAMPLE_I16;
    return true;
}

static bool open_by_shim(MapFile *file, StrBuf *error) {
    const OiioShim *shim = oiio_module_load(error);
    PictureReader *picture = shim ? calloc(1, sizeof *picture) : NULL;
    if (!picture) return shim ? map_fail(error, "not enough memory") : false;
    picture->shim = shim;
    return open_picture(file, picture, error);
}

bool map_open_picture(MapFile *file, StrBuf *error) {
    file->format = "picture";
    if (!open_by_shim(file, error)) return false;
    map_place_picture(file);
    return true;
}

bool map_open_tiff(MapFile *file, StrBuf *error) {
    if (!open_by_shim(file, error)) return false;
    map_place_picture(file);
    file->format = file->place.placed ? "GeoTIFF" : "TIFF";
    return true;
}
