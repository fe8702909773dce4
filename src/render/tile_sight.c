#include "render/tile_sight.h"

static Ray line_at(const TileSight *sight, double x, double y) {
    const Cone cone = view_cone(&sight->compiled->view, sight->x0 + x + 0.5, sight->y0 + y + 0.5, 1);
    return (Ray){cone.origin, cone.direction};
}

/* Whether lines between those of the corners are between them in space, too: as far as the middles of the four sides tell. */
static bool hold_sides(const TileSight *sight, const Ray corners[4], int x0, int y0, int x1, int y1) {
    static const int around[] = {0, 1, 3, 2};
    const double xs[] = {x0, x1}, ys[] = {y0, y1};
    for (int k = 0; k < 4; k++) {
        const int a = around[k], b = around[(k + 1) % 4], opposite = around[(k + 2) % 4];
        const Ray side = line_at(sight, (xs[a & 1] + xs[b & 1]) / 2, (ys[a >> 1] + ys[b >> 1]) / 2);
        const Vec3 n = vec3_cross(corners[a].direction, corners[b].direction);
        if (!(vec3_dot(n, side.direction) * vec3_dot(n, corners[opposite].direction) > 0)) return false;
    }
    return true;
}

/* Lines of sight around those through the middles of four pixels and all between; false where they do not hold these. Where the picture is no plane
 * they lie a little further out, by more than rows and columns bend. */
static bool lines_of(const TileSight *sight, int x0, int y0, int x1, int y1, Ray out[4]) {
    enum { BENT = 16 };
    const View *view = &sight->compiled->view;
    const bool flat = view_is_flat(view);
    const double beside = flat ? 0 : (double)int_max(x1 - x0, y1 - y0) / BENT;
    if (!flat && !view_is_round(view)) return false;
    for (int k = 0; k < 4; k++) out[k] = line_at(sight, k & 1 ? x1 + beside : x0 - beside, k & 2 ? y1 + beside : y0 - beside);
    return flat || hold_sides(sight, out, x0, y0, x1, y1);
}

/* So many pixels at this place. */
static VistaWidth width_of(const TileSight *sight, double pixels, double x, double y) {
    const Cone cone = view_cone(&sight->compiled->view, x, y, pixels);
    return (VistaWidth){cone.spread, cone.width};
}

static bool has_narrower(const TileSight *sight, const Ray corners[4], double pixels, int columns, int rows) {
    return vista_has_thin(hierarchy_pieces(sight->compiled->hierarchy), corners, width_of(sight, pixels, sight->x0 + columns / 2.0, sight->y0 + rows / 2.0));
}

TileSight tile_sight(const CompiledScene *compiled, int x0, int y0, int columns, int rows) {
    TileSight sight = {.compiled = compiled, .x0 = x0, .y0 = y0, .vista = {.count = VISTA_MOST + 1}};
    Ray corners[4];
    if (!lines_of(&sight, 0, 0, columns - 1, rows - 1, corners)) return sight;
    sight.vista = vista_of(hierarchy_pieces(compiled->hierarchy), corners);
    sight.fine = has_narrower(&sight, corners, 3, columns, rows);
    return sight;
}

VistaView tile_sight_view(const TileSight *sight, int x0, int y0, int x1, int y1, uint32_t object) {
    Ray corners[4];
    if (sight->vista.count > VISTA_MOST || !lines_of(sight, x0, y0, x1, y1, corners)) return VISTA_OPEN;
    const VistaWidth wide = width_of(sight, x1 - x0 + y1 - y0, sight->x0 + (x0 + x1) / 2.0, sight->y0 + (y0 + y1) / 2.0);
    const VistaView view = vista_view(&sight->vista, corners, object, wide);
    return view == VISTA_SOME && sight->fine ? VISTA_OPEN : view;
}

bool tile_sight_thin(const CompiledScene *compiled, int x0, int y0, int columns, int rows) {
    const TileSight sight = {.compiled = compiled, .x0 = x0, .y0 = y0};
    Ray corners[4];
    return view_is_flat(&compiled->view) && lines_of(&sight, -1, -1, columns, rows, corners) && has_narrower(&sight, corners, 1, columns, rows);
}
