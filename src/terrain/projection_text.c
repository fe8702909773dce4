/* Projections in words. */
#include "terrain/projection.h"

static const char *const names[] = {
    [PROJECTION_LONLAT] = "longitude and latitude",
    [PROJECTION_TRANSVERSE_MERCATOR] = "transverse Mercator",
    [PROJECTION_LAMBERT_CONFORMAL] = "Lambert's conformal conic",
    [PROJECTION_ALBERS] = "Albers' equal-area conic",
    [PROJECTION_POLAR_STEREOGRAPHIC] = "polar stereographic",
    [PROJECTION_MERCATOR] = "Mercator",
    [PROJECTION_WEB_MERCATOR] = "web Mercator",
    [PROJECTION_LAMBERT_AZIMUTHAL] = "Lambert's azimuthal equal-area",
    [PROJECTION_EQUIRECTANGULAR] = "equirectangular",
};

static bool is_utm(const ProjectionParameters *a) {
    double zone = (a->longitude + 183) / 6;
    return a->kind == PROJECTION_TRANSVERSE_MERCATOR && a->scale == 0.9996 && a->latitude == 0 && a->prime_meridian == 0 && a->false_east == 500000 &&
           (a->false_north == 0 || a->false_north == 10000000) && zone == floor(zone) && zone >= 1 && zone <= 60;
}

static void add_degrees(StrBuf *out, double value, const char *positive, const char *negative) {
    strbuf_addf(out, "%.10g%s", fabs(value), value < 0 ? negative : positive);
}

static void add_unit(StrBuf *out, const ProjectionParameters *a) {
    static const struct {
        double unit;
        const char *name;
    } known[] = {{0.3048, "feet"}, {1200.0 / 3937, "US survey feet"}, {1000, "kilometres"}};
    if (a->kind == PROJECTION_LONLAT || a->unit == 1) return;
    for (size_t i = 0; i < VTS_ARRAY_COUNT(known); i++)
        if (fabs(a->unit - known[i].unit) < 1e-10 * known[i].unit) {
            strbuf_addf(out, ", in %s", known[i].name);
            return;
        }
    strbuf_addf(out, ", in units of %.10g m", a->unit);
}

void projection_describe(const Projection *projection, StrBuf *out) {
    const ProjectionParameters *a = &projection->parameters;
    bool conic = a->kind == PROJECTION_LAMBERT_CONFORMAL || a->kind == PROJECTION_ALBERS;
    if (is_utm(a)) {
        strbuf_addf(out, "UTM zone %d %s", (int)((a->longitude + 183) / 6), a->false_north > 0 ? "south" : "north");
        add_unit(out, a);
        return;
    }
    strbuf_adds(out, names[a->kind]);
    if (a->kind == PROJECTION_LONLAT || a->kind == PROJECTION_WEB_MERCATOR) return;
    strbuf_adds(out, " about ");
    add_degrees(out, a->latitude, "N", "S");
    strbuf_addc(out, ' ');
    add_degrees(out, projection->meridian, "E", "W");
    if (conic) {
        strbuf_adds(out, ", parallels ");
        add_degrees(out, a->parallels[0], "N", "S");
        strbuf_adds(out, " and ");
        add_degrees(out, a->parallels[1], "N", "S");
    }
    add_unit(out, a);
}
