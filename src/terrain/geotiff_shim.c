/* The only code that touches libgeotiff, libtiff and PROJ. What they have to say goes to the caller, never to a stream. */
#include "terrain/geotiff_shim.h"

#include <geo_normalize.h>
#include <geo_simpletags.h>
#include <geotiffio.h>
#include <proj.h>
#include <xtiffio.h>

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TAG_METADATA = 42112, TAG_NODATA = 42113 };

/* ---- words of the libraries ---- */

/* The first thing that was said; later ones are its consequences. */
static void keep_words(char *error, const char *format, va_list arguments) {
    if (*error) return;
    vsnprintf(error, GEOTIFF_ERROR_SIZE, format, arguments);
    for (char *c = error; *c; c++)
        if ((unsigned char)*c < ' ') *c = ' ';
}

static void silent_keys(GTIF *keys, int level, const char *format, ...) { (void)keys, (void)level, (void)format; }

#if TIFFLIB_VERSION >= 20221213
static int tiff_words(TIFF *tiff, void *user, const char *module, const char *format, va_list arguments) {
    (void)tiff, (void)module;
    keep_words(user, format, arguments);
    return 1;
}
static int tiff_silence(TIFF *tiff, void *user, const char *module, const char *format, va_list arguments) {
    (void)tiff, (void)user, (void)module, (void)format, (void)arguments;
    return 1;
}

/* A tag may claim any size: none that matters here is larger than this. */
static TIFF *open_tiff(const char *path, char *error) {
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    if (!options) return NULL;
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, 256 << 20);
    TIFFOpenOptionsSetErrorHandlerExtR(options, tiff_words, error);
    TIFFOpenOptionsSetWarningHandlerExtR(options, tiff_silence, NULL);
    TIFF *tiff = TIFFOpenExt(path, "r", options);
    TIFFOpenOptionsFree(options);
    return tiff;
}
#else
static TIFF *open_tiff(const char *path, char *error) {
    (void)error;
    TIFFSetErrorHandler(NULL);
    TIFFSetWarningHandler(NULL);
    return TIFFOpen(path, "r");
}
#endif

/* A context of PROJ that keeps silent; it outlives the keys that it is attached to. */
static PJ_CONTEXT *silent_proj(void) {
    PJ_CONTEXT *context = proj_context_create();
    if (!context) return NULL;
    proj_log_level(context, PJ_LOG_NONE);
    proj_context_set_enable_network(context, 0);
    return context;
}

/* ---- coordinate systems ---- */

static int code_of(short code) { return (int)(unsigned short)code; }

static void read_datum_name(PJ_CONTEXT *proj, int datum, GeotiffSystem *out) {
    char *name = NULL;
    if (datum > 0 && datum != KvUserDefined && GTIFGetDatumInfoEx(proj, datum, &name, NULL) && name) snprintf(out->datum_name, sizeof out->datum_name, "%s", name);
    if (name) GTIFFreeMemory(name);
}

static void read_system(GTIF *keys, PJ_CONTEXT *proj, GeotiffSystem *out) {
    GTIFDefn *d = GTIFAllocDefn();
    *out = (GeotiffSystem){0};
    if (d && GTIFGetDefn(keys, d)) {
        out->model = d->Model == ModelTypeProjected || d->Model == ModelTypeGeographic || d->Model == ModelTypeGeocentric ? d->Model : GEOTIFF_MODEL_NONE;
        out->projected = code_of(d->PCS);
        out->geographic = code_of(d->GCS);
        out->datum = code_of(d->Datum);
        out->semi_major = d->SemiMajor;
        out->semi_minor = d->SemiMinor;
        out->prime_meridian = d->PMLongToGreenwich;
        out->degrees = d->UOMAngleInDegrees;
        out->metres = d->UOMLengthInMeters;
        out->method = code_of(d->CTProjection);
        out->parameter_count = d->nParms < GEOTIFF_PARAMETERS ? d->nParms : GEOTIFF_PARAMETERS;
        for (int i = 0; i < out->parameter_count; i++) {
            out->parameters[i].key = d->ProjParmId[i];
            out->parameters[i].value = d->ProjParm[i];
        }
        out->shift_count = d->TOWGS84Count == 3 || d->TOWGS84Count == 7 ? d->TOWGS84Count : 0;
        memcpy(out->shift, d->TOWGS84, sizeof out->shift);
        read_datum_name(proj, out->datum, out);
    }
    if (d) GTIFFreeDefn(d);
}

/* Keys that hold nothing but the code. */
static bool find_system(int code, bool projected, PJ_CONTEXT *proj, GeotiffSystem *system) {
    ST_TIFF *tags = ST_Create();
    GTIF *keys = tags ? GTIFNewSimpleTags(tags) : NULL;
    *system = (GeotiffSystem){0};
    if (keys) {
        GTIFAttachPROJContext(keys, proj);
        GTIFKeySet(keys, GTModelTypeGeoKey, TYPE_SHORT, 1, projected ? ModelTypeProjected : ModelTypeGeographic);
        GTIFKeySet(keys, projected ? ProjectedCSTypeGeoKey : GeographicTypeGeoKey, TYPE_SHORT, 1, code);
        read_system(keys, proj, system);
        GTIFFree(keys);
    }
    if (tags) ST_Destroy(tags);
    return system->semi_major > 0 && (!projected || system->parameter_count > 0);
}

static bool shim_system(int code, GeotiffSystem *system) {
    PJ_CONTEXT *proj = silent_proj();
    bool known = proj && code > 0 && code < KvUserDefined && (find_system(code, true, proj, system) || find_system(code, false, proj, system));
    if (proj) proj_context_destroy(proj);
    return known;
}

/* ---- tags ---- */

/* A tag's values, whichever way libtiff was told to hand them over; NULL where there are none of the type. */
static const void *tag_values(TIFF *tiff, uint32_t tag, TIFFDataType type, size_t *count) {
    const TIFFField *field = TIFFFindField(tiff, tag, TIFF_ANY);
    void *values = NULL;
    uint32_t wide = 0;
    uint16_t narrow = 0;
    *count = 0;
    if (!field || TIFFFieldDataType(field) != type) return NULL;
    if (!TIFFFieldPassCount(field)) {
        if (type != TIFF_ASCII || !TIFFGetField(tiff, tag, &values) || !values) return NULL;
        *count = strlen(values);
    } else if (TIFFFieldReadCount(field) == TIFF_VARIABLE2) {
        if (!TIFFGetField(tiff, tag, &wide, &values)) return NULL;
        *count = wide;
    } else {
        if (!TIFFGetField(tiff, tag, &narrow, &values)) return NULL;
        *count = narrow;
    }
    return values;
}

/* A text that ends, whether the file ends it or not. */
static char *tag_text(TIFF *tiff, uint32_t tag) {
    size_t count;
    const char *values = tag_values(tiff, tag, TIFF_ASCII, &count);
    char *text = values ? malloc(count + 1) : NULL;
    if (!text) return NULL;
    memcpy(text, values, count);
    text[count] = '\0';
    return text;
}

static void read_placing(TIFF *tiff, GeotiffFile *file) {
    size_t count;
    const double *v = tag_values(tiff, TIFFTAG_GEOPIXELSCALE, TIFF_DOUBLE, &count);
    if (v && count >= 2) {
        file->has_scale = true;
        memcpy(file->scale, v, sizeof file->scale);
    }
    v = tag_values(tiff, TIFFTAG_GEOTRANSMATRIX, TIFF_DOUBLE, &count);
    if (v && count >= 8) {
        const double rows[6] = {v[0], v[1], v[3], v[4], v[5], v[7]};
        file->has_matrix = true;
        memcpy(file->matrix, rows, sizeof rows);
    }
    v = tag_values(tiff, TIFFTAG_GEOTIEPOINTS, TIFF_DOUBLE, &count);
    size_t ties = count / 6 < GEOTIFF_TIE_POINTS ? count / 6 : GEOTIFF_TIE_POINTS;
    file->ties = v && ties ? malloc(ties * sizeof *file->ties) : NULL;
    file->tie_count = file->ties ? ties : 0;
    for (size_t i = 0; i < file->tie_count; i++, v += 6) file->ties[i] = (GeotiffTie){{v[0], v[1]}, {v[3], v[4]}};
}

static int short_key(GTIF *keys, geokey_t key) {
    unsigned short value = 0;
    return GTIFKeyGetSHORT(keys, key, &value, 0, 1) == 1 ? value : 0;
}

/* What the lists know of a vertical system: the length of its unit, negative where it counts downwards. */
static double vertical_metres(PJ_CONTEXT *proj, int code) {
    char text[16];
    const char *direction = NULL;
    double metres = 0;
    snprintf(text, sizeof text, "%d", code);
    PJ *system = proj_create_from_database(proj, "EPSG", text, PJ_CATEGORY_CRS, 0, NULL);
    PJ *axes = system && proj_get_type(system) == PJ_TYPE_VERTICAL_CRS ? proj_crs_get_coordinate_system(proj, system) : NULL;
    if (axes && proj_cs_get_axis_info(proj, axes, 0, NULL, NULL, &direction, &metres, NULL, NULL, NULL) && direction && strcmp(direction, "down") == 0) metres = -metres;
    if (axes) proj_destroy(axes);
    if (system) proj_destroy(system);
    return metres;
}

static bool has_heights(PJ_CONTEXT *proj, int geographic) {
    char text[16];
    snprintf(text, sizeof text, "%d", geographic);
    PJ *system = proj_create_from_database(proj, "EPSG", text, PJ_CATEGORY_CRS, 0, NULL);
    bool heights = system && proj_get_type(system) == PJ_TYPE_GEOGRAPHIC_3D_CRS;
    if (system) proj_destroy(system);
    return heights;
}

static void read_heights(GTIF *keys, PJ_CONTEXT *proj, GeotiffFile *file) {
    double metres = 0;
    file->vertical = short_key(keys, VerticalCSTypeGeoKey);
    int unit = short_key(keys, VerticalUnitsGeoKey);
    if (file->vertical > 0 && file->vertical != KvUserDefined) file->vertical_metres = vertical_metres(proj, file->vertical);
    else file->above_ellipsoid = has_heights(proj, short_key(keys, GeographicTypeGeoKey));
    if (unit && GTIFGetUOMLengthInfoEx(proj, unit, NULL, &metres)) file->vertical_metres = file->vertical_metres < 0 ? -metres : metres;
}

static void read_keys(TIFF *tiff, GeotiffFile *file) {
    GTIF *keys = GTIFNewEx(tiff, silent_keys, NULL);
    PJ_CONTEXT *proj = keys ? silent_proj() : NULL;
    int versions[3], count = 0;
    if (proj) {
        GTIFAttachPROJContext(keys, proj);
        GTIFDirectoryInfo(keys, versions, &count);
        file->has_keys = count > 0;
        if (file->has_keys) read_system(keys, proj, &file->system);
        file->point = short_key(keys, GTRasterTypeGeoKey) == RasterPixelIsPoint;
        read_heights(keys, proj, file);
    }
    if (keys) GTIFFree(keys);
    if (proj) proj_context_destroy(proj);
}

static void read_sizes(TIFF *tiff, GeotiffFile *file) {
    uint16_t bits = 1, channels = 1, format = SAMPLEFORMAT_UINT;
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &file->width);
    TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &file->height);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &channels);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &format);
    file->bits = bits;
    file->channels = channels;
    file->sample_format = format;
}

static bool shim_read(const char *path, GeotiffFile *file, char error[GEOTIFF_ERROR_SIZE]) {
    *file = (GeotiffFile){0};
    *error = '\0';
    XTIFFInitialize();
    TIFF *tiff = open_tiff(path, error);
    if (!tiff) {
        if (!*error) snprintf(error, GEOTIFF_ERROR_SIZE, "it is no TIFF");
        return false;
    }
    read_sizes(tiff, file);
    read_placing(tiff, file);
    read_keys(tiff, file);
    file->nodata = tag_text(tiff, TAG_NODATA);
    file->metadata = tag_text(tiff, TAG_METADATA);
    TIFFClose(tiff);
    *error = '\0';
    return true;
}

static void shim_release(GeotiffFile *file) {
    free(file->ties);
    free(file->nodata);
    free(file->metadata);
    *file = (GeotiffFile){0};
}

const GeotiffShim *vts_geotiff_shim(void) {
    static const GeotiffShim shim = {GEOTIFF_SHIM_VERSION, shim_read, shim_release, shim_system};
    return &shim;
}
