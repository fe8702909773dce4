#include "render/tile_sight.h"

/* Through the middles of four pixels. */
static void lines_of(const TileSight *sight, int x0, int y0, int x1, int y1, Ray out[4]) {
    for (int k = 0; k < 4; k++) {
        double x = sight->x0 + (k & 1 ? x1 : x0) + 0.5, y = sight->y0 + (k & 2 ? y1 : y0) + 0.5;
        Cone cone = view_cone(&sight->compiled->view, x, y, 1);
        out[k] = (Ray){cone.origin, cone.direction};
    }
}

/* So many pixels at this place. */
static VistaWidth width_of(const TileSight *sight, double pixels, double x, double y) {
    const Cone cone = view_cone(&sight->compiled->view, x, y, pixels);
    return (VistaWidth){cone.spread, cone.width};
}

static bool has_narrower(const TileSight *sight, const Ray corners[4], double pixels, int columns, int rows) {
    return vista_has_thin(hierarchy_pieces(sight->compiled->hierarchy), corners, width_of(sight, pixels, sight->x0 + columns / 2.0, sight->y0 + rows / 2.0));
}

/* Only in flat pictures lines between others are between them in space, too. */
TileSight tile_sight(const CompiledScene *compiled, int x0, int y0, int columns, int rows) {
    TileSight sight = {.compiled = compiled, .x0 = x0, .y0 = y0, .vista = {.count = VISTA_MOST + 1}};
    Ray corners[4];
    if (!view_is_flat(&compiled->view)) return sight;
    lines_of(&sight, 0, 0, columns - 1, rows - 1, corners);
    sight.vista = vista_of(hierarchy_pieces(compiled->hierarchy), corners);
    sight.fine = has_narrower(&sight, corners, 3, columns, rows);
    return sight;
}

VistaView tile_sight_view(const TileSight *sight, int x0, int y0, int x1, int y1, uint32_t object) {
    Ray corners[4];
    if (sight->vista.count > VISTA_MOST) return VISTA_OPEN;
    lines_of(sight, x0, y0, x1, y1, corners);
    const VistaWidth wide = width_of(sight, x1 - x0 + y1 - y0, sight->x0 + (x0 + x1) / 2.0, sight->y0 + (y0 + y1) / 2.0);
    const VistaView view = vista_view(&sight->vista, corners, object, wide);
    return view == VISTA_SOME && sight->fine ? VISTA_OPEN : view;
}

bool tile_sight_thin(const CompiledScene *compiled, int x0, int y0, int columns, int rows) {
    const TileSight sight = {.compiled = compiled, .x0 = x0, .y0 = y0};
    if (!view_is_flat(&compiled->view)) return false;
    Ray corners[4];
    lines_of(&sight, -1, -1, columns, rows, corners);
    return has_narrower(&sight, corners, 1, columns, rows);
}
