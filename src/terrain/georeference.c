#include "terrain/georeference.h"

void georeference_init(Georeference *reference) { *reference = (Georeference){.scale = 1, .unit = 1}; }

static void to_map(const Georeference *r, double column, double row, double *x, double *y) {
    *x = r->x[0] + r->x[1] * column + r->x[2] * row;
    *y = r->y[0] + r->y[1] * column + r->y[2] * row;
}

/* Half of the globe's girth on the map, twice: 0 where meridians are not the same distance apart. */
static double period_of(const Projection *p) {
    ProjectionKind kind = p->parameters.kind;
    double x[2], y;
    if (kind != PROJECTION_LONLAT && kind != PROJECTION_MERCATOR && kind != PROJECTION_WEB_MERCATOR && kind != PROJECTION_EQUIRECTANGULAR) return 0;
    for (int i = 0; i < 2; i++)
        if (!projection_forward(p, (GeoPlace){0, p->meridian + (i ? 90 : -90), 0}, &x[i], &y)) return 0;
    return 2 * (x[1] - x[0]);
}

static bool is_folded(const double x[3], const double y[3]) {
    double area = x[1] * y[2] - x[2] * y[1], size = (fabs(x[1]) + fabs(x[2])) * (fabs(y[1]) + fabs(y[2]));
    return !(fabs(area) > 1e-12 * size) || !isfinite(size) || !isfinite(x[0]) || !isfinite(y[0]);
}

bool georeference_from_affine(Georeference *reference, const Projection *projection, const double x[3], const double y[3], int columns, int rows,
                              bool area) {
    double middle_y;
    Georeference r = *reference;
    if (is_folded(x, y) || columns < 1 || rows < 1) return false;
    r.projection = *projection;
    for (int i = 0; i < 3; i++) {
        r.x[i] = x[i];
        r.y[i] = y[i];
    }
    r.area = area;
    r.period = period_of(projection);
    to_map(&r, 0.5 * (columns - 1), 0.5 * (rows - 1), &r.middle_x, &middle_y);
    if (!projection_reverse(projection, r.middle_x, middle_y, &r.middle)) return false;
    r.placed = r.has_projection = true;
    *reference = r;
    return true;
}

/* From the first sample and the step; a single post has any step. */
static void line_up(double from, double to, int count, bool area, double otherwise, double *first, double *step) {
    double length = to - from;
    *step = area ? length / count : count > 1 ? length / (count - 1) : copysign(otherwise, length);
    *first = area ? from + 0.5 * *step : count > 1 ? from : 0.5 * (from + to);
}

bool georeference_from_corners(Georeference *reference, const Projection *projection, const double west_south[2], const double east_north[2],
                               int columns, int rows, bool area) {
    double x[3] = {0}, y[3] = {0}, west = west_south[0], east = east_north[0], south = west_south[1], north = east_north[1];
    if (columns < 1 || rows < 1) return false;
    bool wide = area || columns > 1, high = area || rows > 1;
    if (projection->parameters.kind == PROJECTION_LONLAT && wide && !(east > west)) east += 360 / projection->parameters.unit;
    if ((wide && !(east > west)) || (high && !(north > south))) return false;
    double across = wide ? (east - west) / int_max(columns - 1, 1) : 1, down = high ? (north - south) / int_max(rows - 1, 1) : across;
    line_up(west, east, columns, area, wide ? 1 : down, &x[0], &x[1]);
    line_up(north, south, rows, area, across, &y[0], &y[2]);
    if (!high) y[2] = -fabs(y[2]);
    return georeference_from_affine(reference, projection, x, y, columns, rows, area);
}

bool georeference_looks_like_degrees(const double x[3], const double y[3], int columns, int rows) {
    Georeference r = {.x = {x[0], x[1], x[2]}, .y = {y[0], y[1], y[2]}};
    for (int corner = 0; corner < 4; corner++) {
        double longitude, latitude;
        to_map(&r, corner & 1 ? columns - 1 : 0, corner & 2 ? rows - 1 : 0, &longitude, &latitude);
        if (!(fabs(longitude) <= 360 && fabs(latitude) <= 90.001)) return false;
    }
    return true;
}

bool georeference_to_geo(const Georeference *reference, double column, double row, GeoPlace *out) {
    double x, y;
    GeoPlace place;
    if (!reference->placed) return false;
    to_map(reference, column, row, &x, &y);
    if (!projection_reverse(&reference->projection, x, y, &place)) return false;
    /* A map that is as wide as the globe keeps its two ends. */
    if (reference->period == 0) place.longitude = reference->middle.longitude + remainder(place.longitude - reference->middle.longitude, 360);
    *out = place;
    return true;
}

bool georeference_from_geo(const Georeference *reference, GeoPlace place, double *column, double *row) {
    const Georeference *r = reference;
    double x, y;
    if (!r->placed || !projection_forward(&r->projection, place, &x, &y)) return false;
    if (r->period > 0) x -= r->period * round((x - r->middle_x) / r->period);
    double dx = x - r->x[0], dy = y - r->y[0], area = r->x[1] * r->y[2] - r->x[2] * r->y[1];
    *column = (dx * r->y[2] - dy * r->x[2]) / area;
    *row = (dy * r->x[1] - dx * r->y[1]) / area;
    return true;
}
