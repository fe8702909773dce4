/* What a TIFF says of its place, its samples and its heights. */
#include "terrain/geotiff_module.h"

#include "base/decimal.h"
#include "terrain/georeference.h"
#include "terrain/projection_system.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* ---- where pixels lie: x = m0 + m1 column + m2 row of the file's own pixel space ---- */

/* The least squares of `values` over the ties: Cramer's rule on the normal equations about the mean. */
static bool fit_plane(const GeotiffFile *file, int axis, double out[3]) {
    double mean[3] = {0}, uu = 0, uv = 0, vv = 0, uw = 0, vw = 0, n = (double)file->tie_count;
    for (size_t i = 0; i < file->tie_count; i++) {
        mean[0] += file->ties[i].pixel[0] / n;
        mean[1] += file->ties[i].pixel[1] / n;
        mean[2] += file->ties[i].place[axis] / n;
    }
    for (size_t i = 0; i < file->tie_count; i++) {
        double u = file->ties[i].pixel[0] - mean[0], v = file->ties[i].pixel[1] - mean[1], w = file->ties[i].place[axis] - mean[2];
        uu += u * u, uv += u * v, vv += v * v, uw += u * w, vw += v * w;
    }
    double determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-9 * uu * vv)) return false;
    out[1] = (uw * vv - vw * uv) / determinant;
    out[2] = (vw * uu - uw * uv) / determinant;
    out[0] = mean[2] - out[1] * mean[0] - out[2] * mean[1];
    return true;
}

/* Whether all ties lie where the affine map puts them, to a tenth of a pixel. */
static bool ties_agree(const GeotiffFile *file, const double x[3], const double y[3]) {
    double pixel = hypot(hypot(x[1], y[1]), hypot(x[2], y[2]));
    for (size_t i = 0; i < file->tie_count; i++) {
        const GeotiffTie *t = &file->ties[i];
        double dx = x[0] + x[1] * t->pixel[0] + x[2] * t->pixel[1] - t->place[0], dy = y[0] + y[1] * t->pixel[0] + y[2] * t->pixel[1] - t->place[1];
        if (!(hypot(dx, dy) < 0.1 * pixel)) return false;
    }
    return true;
}

static bool pixel_space(const GeotiffFile *file, double x[3], double y[3]) {
    if (file->has_matrix) {
        const double *m = file->matrix;
        memcpy(x, (double[]){m[2], m[0], m[1]}, 3 * sizeof *x);
        memcpy(y, (double[]){m[5], m[3], m[4]}, 3 * sizeof *y);
        return true;
    }
    if (file->has_scale && file->tie_count >= 1) {
        const GeotiffTie *t = &file->ties[0];
        memcpy(x, (double[]){t->place[0] - file->scale[0] * t->pixel[0], file->scale[0], 0}, 3 * sizeof *x);
        memcpy(y, (double[]){t->place[1] + file->scale[1] * t->pixel[1], 0, -file->scale[1]}, 3 * sizeof *y);
        return true;
    }
    return file->tie_count >= 3 && fit_plane(file, 0, x) && fit_plane(file, 1, y);
}

/* A pixel that is an area has its sample in its middle. */
static void to_samples(bool area, double m[3]) {
    if (area) m[0] += 0.5 * (m[1] + m[2]);
}

/* False with a line in `error` for a place that cannot be used; a file without one is none. */
static bool read_place(const GeotiffFile *file, Georeference *r, StrBuf *error) {
    double x[3], y[3];
    bool area = !file->point, has_system = file->has_keys && file->system.model != GEOTIFF_MODEL_NONE;
    int columns = (int)file->width, rows = (int)file->height;
    if (has_system && !projection_from_system(&r->projection, &file->system, error)) return false;
    r->has_projection = has_system;
    if (!pixel_space(file, x, y)) {
        if (file->tie_count < 3) return true;
        strbuf_adds(error, "its tie points lie on a line");
        return false;
    }
    if (!file->has_matrix && !file->has_scale && !ties_agree(file, x, y)) {
        strbuf_adds(error, "its tie points are those of a bent map; straighten it: gdalwarp -t_srs EPSG:4326");
        return false;
    }
    to_samples(area, x);
    to_samples(area, y);
    if (!has_system) {
        if (!georeference_looks_like_degrees(x, y, columns, rows)) {
            strbuf_adds(error, "it says where its pixels lie, but not in which coordinate system; say it with 'georeference'");
            return false;
        }
        projection_lonlat(&r->projection);
        r->has_projection = true;
    }
    if (georeference_from_affine(r, &r->projection, x, y, columns, rows, area)) return true;
    strbuf_adds(error, "the place that it gives for itself is nowhere on the globe");
    return false;
}

/* ---- what samples mean ---- */

static bool read_number(const char *text, double *out) {
    char *end;
    if (!text) return false;
    *out = decimal_strtod(text, &end);
    return end != text;
}

/* The value of an attribute within a tag that begins at `tag` and ends at `end`, compared whole. */
static bool attribute_is(const char *tag, const char *end, const char *name, const char *value) {
    size_t name_length = strlen(name), value_length = strlen(value);
    for (const char *p = tag; (p = strstr(p, name)) && p + name_length + value_length + 3 <= end; p += name_length)
        if (p[-1] == ' ' && p[name_length] == '=' && (p[name_length + 1] == '"' || p[name_length + 1] == '\'') &&
            strncmp(p + name_length + 2, value, value_length) == 0 && p[name_length + 2 + value_length] == p[name_length + 1])
            return true;
    return false;
}

static bool has_attribute(const char *tag, const char *end, const char *name) {
    const char *p = strstr(tag, name);
    return p && p < end;
}

/* The text of the first channel's <Item role="…"> of GDAL's metadata, or NULL. */
static const char *metadata_item(const char *metadata, const char *role) {
    for (const char *tag = metadata; tag && (tag = strstr(tag, "<Item ")); tag++) {
        const char *end = strchr(tag, '>');
        if (!end) return NULL;
        bool first = attribute_is(tag, end, "sample", "0") || !has_attribute(tag, end, " sample=");
        if (first && attribute_is(tag, end, "role", role)) return end + 1;
    }
    return NULL;
}

/* Metres of GDAL's names of units; 0: not known. */
static double unit_called(const char *text) {
    static const struct {
        const char *name;
        double metres;
    } units[] = {{"metre", 1}, {"meter", 1}, {"m<", 1}, {"US survey foot", 1200.0 / 3937}, {"us-ft", 1200.0 / 3937}, {"ftUS", 1200.0 / 3937},
                 {"foot", 0.3048}, {"feet", 0.3048}, {"ft", 0.3048}, {"cm<", 0.01}, {"km<", 1000}};
    for (size_t i = 0; text && i < VTS_ARRAY_COUNT(units); i++)
        if (strncmp(text, units[i].name, strlen(units[i].name)) == 0) return units[i].metres;
    return 0;
}

/* Vertical codes of the first GeoTIFF specification that are heights above an ellipsoid. */
static bool is_ellipsoid_code(int code) { return code >= 5001 && code <= 5033; }

static void read_samples(const GeotiffFile *file, Georeference *r) {
    double scale, offset;
    r->has_nodata = read_number(file->nodata, &r->nodata);
    if (read_number(metadata_item(file->metadata, "scale"), &scale) && isfinite(scale) && scale != 0) r->scale = scale;
    if (read_number(metadata_item(file->metadata, "offset"), &offset) && isfinite(offset)) r->offset = offset;
    r->vertical_epsg = file->vertical;
    double called = unit_called(metadata_item(file->metadata, "unittype"));
    r->unit = file->vertical_metres != 0 && isfinite(file->vertical_metres) ? file->vertical_metres : called > 0 ? called : 1;
    r->heights = file->vertical ? is_ellipsoid_code(file->vertical) ? GEO_HEIGHTS_ELLIPSOID : GEO_HEIGHTS_GEOID
                 : file->above_ellipsoid ? GEO_HEIGHTS_ELLIPSOID
                                         : GEO_HEIGHTS_UNKNOWN;
}

static void read_facts(const GeotiffFile *file, TiffFacts *facts) {
    *facts = (TiffFacts){.width = (int)file->width, .height = (int)file->height, .bits = file->bits, .channels = file->channels};
    facts->is_float = file->sample_format == 3;
    facts->is_signed = file->sample_format == 2;
}

/* Pipes and devices would be waited for. */
static bool is_file(const char *path) {
    struct stat about;
    return stat(path, &about) == 0 && S_ISREG(about.st_mode);
}

GeoreferenceStatus georeference_read_tiff(const char *path, Georeference *reference, TiffFacts *facts, StrBuf *error) {
    GeotiffFile file;
    StrBuf ignored = {0}, *words = error ? error : &ignored;
    char why[GEOTIFF_ERROR_SIZE];
    GeoreferenceStatus status = GEOREFERENCE_UNREADABLE;
    georeference_init(reference);
    const GeotiffShim *shim = is_file(path) ? geotiff_module_load(words) : NULL;
    if (!is_file(path)) strbuf_adds(words, "there is no such file, or it cannot be read");
    else if (shim && !shim->read(path, &file, why)) strbuf_addf(words, "it is no TIFF that can be read: %s", why);
    else if (shim && (file.width < 1 || file.height < 1 || file.width > INT_MAX || file.height > INT_MAX)) {
        strbuf_addf(words, "its size, %lu x %lu pixels, cannot be true", (unsigned long)file.width, (unsigned long)file.height);
        shim->release(&file);
    } else if (shim) {
        read_samples(&file, reference);
        if (facts) read_facts(&file, facts);
        status = read_place(&file, reference, words) ? GEOREFERENCE_OK : GEOREFERENCE_REFUSED;
        shim->release(&file);
    }
    strbuf_free(&ignored);
    return status;
}
