#include "terrain/projection_system.h"

/* GeoTIFF's codes (OGC 19-008, annex C). */
enum {
    METHOD_TRANSVERSE_MERCATOR = 1,
    METHOD_MERCATOR = 7,
    METHOD_LAMBERT_2 = 8,
    METHOD_LAMBERT_1 = 9,
    METHOD_LAMBERT_AZIMUTHAL = 10,
    METHOD_ALBERS = 11,
    METHOD_POLAR = 15,
    METHOD_EQUIRECTANGULAR = 17,
    KEY_PARALLEL_1 = 3078,
    KEY_PARALLEL_2 = 3079,
    KEY_ORIGIN_LONGITUDE = 3080,
    KEY_ORIGIN_LATITUDE = 3081,
    KEY_EAST = 3082,
    KEY_NORTH = 3083,
    KEY_FALSE_ORIGIN_LONGITUDE = 3084,
    KEY_FALSE_ORIGIN_LATITUDE = 3085,
    KEY_FALSE_ORIGIN_EAST = 3086,
    KEY_FALSE_ORIGIN_NORTH = 3087,
    KEY_CENTRE_LONGITUDE = 3088,
    KEY_CENTRE_LATITUDE = 3089,
    KEY_CENTRE_EAST = 3090,
    KEY_CENTRE_NORTH = 3091,
    KEY_ORIGIN_SCALE = 3092,
    KEY_CENTRE_SCALE = 3093,
    KEY_POLE_LONGITUDE = 3095,
    WEB_MERCATOR = 3857,
    WEB_MERCATOR_OLD = 3785,
};

static const char WAY_OUT[] = "; say where the map lies with 'georeference', or convert it: gdalwarp -t_srs EPSG:4326";

/* ---- datums ---- */

/* Datums on the ellipsoids of WGS84 and GRS80 lie within metres of WGS84, except these (tens to hundreds of metres: EPSG's transformations). */
static const int distant_datums[] = {
    1112, /* Cyprus Geodetic Reference System 1993 */
    6121, /* Greek Geodetic Reference System 1987 */
    6141, /* Israel 1993 */
    6319, /* Kuwait Utility */
    6750, /* ST87 Ouvea */
    6756, /* Vietnam 2000 */
};

static bool is_distant(int datum) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(distant_datums); i++)
        if (distant_datums[i] == datum) return true;
    return false;
}

/* A shift to WGS84 that the file itself gives: metres of translation, and what rotations and scale make of the earth's radius. */
static double shift_size(const GeotiffSystem *s) {
    double radius = 6.4e6, size = 0;
    for (int i = 0; i < s->shift_count; i++) size += fabs(s->shift[i]) * (i < 3 ? 1 : i < 6 ? radius * VTS_RADIANS / 3600 : radius * 1e-6);
    return size;
}

static bool datum_fits(const GeotiffSystem *s) {
    static const double AXIS = 6378137, FLATTENING = 1 / 298.257223563;
    double flattening = 1 - s->semi_minor / s->semi_major;
    return fabs(s->semi_major - AXIS) < 1.5 && fabs(flattening - FLATTENING) < 1e-8 && !is_distant(s->datum) && shift_size(s) < 10;
}

static bool refuse_datum(const GeotiffSystem *s, StrBuf *error) {
    if (!error) return false;
    if (s->datum_name[0]) strbuf_addf(error, "its datum '%s' is not WGS84's, from which it lies metres to hundreds of metres off%s", s->datum_name, WAY_OUT);
    else if (s->semi_major > 0)
        strbuf_addf(error, "it is drawn for an earth of axes %.3f m and %.3f m, which are not WGS84's%s", s->semi_major, s->semi_minor, WAY_OUT);
    else strbuf_addf(error, "its datum is not known%s", WAY_OUT);
    return false;
}

/* ---- methods ---- */

static const struct MethodName {
    int method;
    const char *name;
} unmodelled[] = {
    {2, "transverse Mercator modified for Alaska"}, {3, "oblique Mercator"}, {4, "Laborde's oblique Mercator"}, {5, "the Swiss oblique Mercator"},
    {6, "oblique Mercator"}, {12, "azimuthal equidistant"}, {13, "equidistant conic"}, {14, "stereographic"}, {16, "oblique stereographic"},
    {18, "Cassini-Soldner"}, {19, "gnomonic"}, {20, "Miller cylindrical"}, {21, "orthographic"}, {22, "polyconic"}, {23, "Robinson"},
    {24, "sinusoidal"}, {25, "van der Grinten"}, {26, "the New Zealand Map Grid"}, {27, "transverse Mercator with axes to the south and west"},
    {28, "cylindrical equal-area"}, {9815, "Hotine's oblique Mercator"},
};

static bool refuse_method(int method, StrBuf *error) {
    if (!error) return false;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(unmodelled); i++)
        if (unmodelled[i].method == method) {
            strbuf_addf(error, "its map projection, %s, is not modelled%s", unmodelled[i].name, WAY_OUT);
            return false;
        }
    strbuf_addf(error, "its map projection is not known%s", WAY_OUT);
    return false;
}

/* The first of the keys that is given; keys end with 0. */
static double parameter(const GeotiffSystem *s, const int *keys, double otherwise) {
    for (; *keys; keys++)
        for (int i = 0; i < s->parameter_count; i++)
            if (s->parameters[i].key == *keys) return s->parameters[i].value;
    return otherwise;
}

static void read_parameters(const GeotiffSystem *s, ProjectionParameters *a) {
    static const int latitude[] = {KEY_ORIGIN_LATITUDE, KEY_FALSE_ORIGIN_LATITUDE, KEY_CENTRE_LATITUDE, 0};
    static const int longitude[] = {KEY_ORIGIN_LONGITUDE, KEY_FALSE_ORIGIN_LONGITUDE, KEY_CENTRE_LONGITUDE, KEY_POLE_LONGITUDE, 0};
    static const int east[] = {KEY_EAST, KEY_FALSE_ORIGIN_EAST, KEY_CENTRE_EAST, 0};
    static const int north[] = {KEY_NORTH, KEY_FALSE_ORIGIN_NORTH, KEY_CENTRE_NORTH, 0};
    static const int scale[] = {KEY_ORIGIN_SCALE, KEY_CENTRE_SCALE, 0};
    static const int first[] = {KEY_PARALLEL_1, 0}, second[] = {KEY_PARALLEL_2, 0};
    a->latitude = parameter(s, latitude, 0);
    a->longitude = parameter(s, longitude, 0);
    a->false_east = parameter(s, east, 0);
    a->false_north = parameter(s, north, 0);
    a->scale = parameter(s, scale, 1);
    a->parallels[0] = parameter(s, first, 0);
    a->parallels[1] = parameter(s, second, a->parallels[0]);
}

/* A latitude that is no pole is the one of true scale. */
static void polar_parameters(ProjectionParameters *a) {
    double latitude = a->latitude;
    a->latitude = latitude < 0 ? -90 : 90;
    if (fabs(latitude) == 90) return;
    a->parallels[0] = latitude;
    a->scale = 0;
}

static bool method_parameters(const GeotiffSystem *s, ProjectionParameters *a) {
    read_parameters(s, a);
    if (s->projected == WEB_MERCATOR || s->projected == WEB_MERCATOR_OLD) {
        a->kind = PROJECTION_WEB_MERCATOR;
        return true;
    }
    switch (s->method) {
    case METHOD_TRANSVERSE_MERCATOR: a->kind = PROJECTION_TRANSVERSE_MERCATOR; return true;
    case METHOD_LAMBERT_AZIMUTHAL: a->kind = PROJECTION_LAMBERT_AZIMUTHAL; return true;
    case METHOD_MERCATOR: a->kind = PROJECTION_MERCATOR; return true;
    case METHOD_EQUIRECTANGULAR: a->kind = PROJECTION_EQUIRECTANGULAR; return true;
    case METHOD_ALBERS: a->kind = PROJECTION_ALBERS; return true;
    case METHOD_LAMBERT_2:
        a->kind = PROJECTION_LAMBERT_CONFORMAL;
        a->scale = 1;
        return true;
    case METHOD_LAMBERT_1:
        a->kind = PROJECTION_LAMBERT_CONFORMAL;
        a->parallels[0] = a->parallels[1] = a->latitude;
        return true;
    case METHOD_POLAR:
        a->kind = PROJECTION_POLAR_STEREOGRAPHIC;
        polar_parameters(a);
        return true;
    default: return false;
    }
}

bool projection_from_system(Projection *projection, const GeotiffSystem *system, StrBuf *error) {
    ProjectionParameters a = {.kind = PROJECTION_LONLAT};
    if (system->model != GEOTIFF_MODEL_PROJECTED && system->model != GEOTIFF_MODEL_GEOGRAPHIC) {
        if (error) strbuf_addf(error, "its coordinate system is neither geographic nor projected%s", WAY_OUT);
        return false;
    }
    if (!datum_fits(system)) return refuse_datum(system, error);
    bool projected = system->model == GEOTIFF_MODEL_PROJECTED;
    if (projected && !method_parameters(system, &a)) return refuse_method(system->method, error);
    a.axis = system->semi_major;
    a.flattening = 1 - system->semi_minor / system->semi_major;
    a.unit = projected ? system->metres : system->degrees;
    a.prime_meridian = system->prime_meridian;
    return projection_init(projection, &a, error);
}
