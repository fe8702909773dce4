/* Codes of the EPSG's list: those that are arithmetic are known here, so that they need no module. */
#include "terrain/geotiff_module.h"
#include "terrain/projection_system.h"

static const double GRS80_FLATTENING = 1 / 298.257222101, AXIS = 6378137;

/* UTM: codes that count zones upwards. */
static const struct UtmCodes {
    int first, last, zone; /* of the first */
    bool north, grs80;
} utm_codes[] = {
    {32601, 32660, 1, true, false},  /* WGS84 */
    {32701, 32760, 1, false, false},
    {25828, 25838, 28, true, true},  /* ETRS89 */
    {26901, 26923, 1, true, true},   /* NAD83 */
    {28348, 28358, 48, false, true}, /* GDA94 */
    {7846, 7859, 46, false, true},   /* GDA2020 */
};

static const int lonlat_codes[] = {4326, 4979, 4258, 4937, 4269, 4283, 7844};

static const struct PolarCode {
    int code;
    double latitude, longitude, parallel, scale, shift;
} polar_codes[] = {
    {32661, 90, 0, 0, 0.994, 2000000}, {5041, 90, 0, 0, 0.994, 2000000}, {32761, -90, 0, 0, 0.994, 2000000}, {5042, -90, 0, 0, 0.994, 2000000},
    {3031, -90, 0, -71, 0, 0},         {3413, 90, -45, 70, 0, 0},        {3995, 90, 0, 71, 0, 0},
};

static bool arithmetic(int code, ProjectionParameters *a) {
    *a = (ProjectionParameters){0};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(lonlat_codes); i++)
        if (lonlat_codes[i] == code) return true;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(utm_codes); i++) {
        const struct UtmCodes *u = &utm_codes[i];
        if (code < u->first || code > u->last) continue;
        Projection utm;
        projection_utm(&utm, u->zone + code - u->first, u->north);
        *a = utm.parameters;
        if (u->grs80) a->flattening = GRS80_FLATTENING;
        return true;
    }
    for (size_t i = 0; i < VTS_ARRAY_COUNT(polar_codes); i++) {
        const struct PolarCode *p = &polar_codes[i];
        if (p->code != code) continue;
        *a = (ProjectionParameters){.kind = PROJECTION_POLAR_STEREOGRAPHIC, .latitude = p->latitude, .longitude = p->longitude, .scale = p->scale};
        a->parallels[0] = p->parallel;
        a->false_east = a->false_north = p->shift;
        return true;
    }
    a->kind = code == 3857 ? PROJECTION_WEB_MERCATOR : PROJECTION_LAMBERT_AZIMUTHAL;
    if (code == 3857) return true;
    *a = (ProjectionParameters){PROJECTION_LAMBERT_AZIMUTHAL, AXIS, GRS80_FLATTENING, .latitude = 52, .longitude = 10, .false_east = 4321000, .false_north = 3210000};
    return code == 3035;
}

bool projection_from_epsg(Projection *projection, int code, StrBuf *error) {
    ProjectionParameters a;
    GeotiffSystem system;
    if (arithmetic(code, &a)) return projection_init(projection, &a, error);
    const GeotiffShim *shim = geotiff_module_load(error);
    if (!shim) return false;
    if (shim->system(code, &system)) return projection_from_system(projection, &system, error);
    if (error) strbuf_addf(error, "EPSG:%d is no coordinate system that is known here; 326zz and 327zz are UTM zones zz north and south, 4326 is longitude and latitude", code);
    return false;
}
