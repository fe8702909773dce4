#include "terrain/ground.h"

#include "terrain/ground_ray.h"

enum { SAMPLES = 17 }; /* of the map along each side, where something of all of it is asked */

/* ---- the source ---- */

static double post_height(const void *map, int column, int row) {
    const Ground *ground = map;
    float height;
    heightmap_block(ground->map, column, row, 1, 1, 1, &height);
    return ground->exaggeration * (double)height;
}

static void post_block(const void *map, int column, int row, int columns, int rows, float *heights) {
    const Ground *ground = map;
    heightmap_block(ground->map, column, row, 1, columns, rows, heights);
    for (size_t i = 0; i < (size_t)columns * (size_t)rows; i++) heights[i] = (float)(ground->exaggeration * (double)heights[i]);
}

static Vec3 post_place(const void *map, double column, double row, double height) {
    const Ground *ground = map;
    GeoPlace place;
    Vec3 p;
    bool ok = heightmap_to_geo(ground->map, column, row, &place);
    if (ok) place.height = height;
    return ok && geo_to_scene(&ground->frame, place, &p) ? p : vec3_splat((double)NAN);
}

/* ---- what is found from samples ---- */

static Vec3 sample(const Ground *g, double i, double j, double height) {
    return g->source.place(g, i / (SAMPLES - 1) * (g->source.columns - 1), j / (SAMPLES - 1) * (g->source.rows - 1), height);
}

/* How far the middle of an edge is from the chord, over its length squared. */
static double bend_between(const Ground *g, int i0, int j0, int i1, int j1) {
    Vec3 a = sample(g, i0, j0, 0), b = sample(g, i1, j1, 0), middle = sample(g, (i0 + i1) / 2.0, (j0 + j1) / 2.0, 0);
    double posts = hypot((double)(i1 - i0) * (g->source.columns - 1), (double)(j1 - j0) * (g->source.rows - 1)) / (SAMPLES - 1);
    double length = posts * g->source.spacing, off = vec3_length(vec3_sub(middle, vec3_lerp(a, b, 0.5)));
    return isfinite(off) && length > 0 ? off / (length * length) : 0;
}

static void measure_bend(Ground *g) {
    for (int j = 0; j < SAMPLES; j++)
        for (int i = 0; i < SAMPLES; i++) {
            if (i + 1 < SAMPLES) g->source.bend = fmax(g->source.bend, bend_between(g, i, j, i + 1, j));
            if (j + 1 < SAMPLES) g->source.bend = fmax(g->source.bend, bend_between(g, i, j, i, j + 1));
        }
    g->source.bend *= 1.5; /* edges between the samples */
}

static double step_length(const Ground *g, double column, double row, double across, double down) {
    Vec3 a = g->source.place(g, column, row, 0), b = g->source.place(g, column + across, row + down, 0);
    double length = vec3_length(vec3_sub(a, b));
    return isfinite(length) ? length : 0;
}

static void measure_spacing(Ground *g) {
    const GroundSource *s = &g->source;
    double spacing = 0;
    for (int j = 0; j < SAMPLES; j++)
        for (int i = 0; i < SAMPLES; i++) {
            double column = (double)i / (SAMPLES - 1) * (s->columns - 2), row = (double)j / (SAMPLES - 1) * (s->rows - 2);
            spacing = fmax(spacing, fmax(step_length(g, column, row, 1, 0), step_length(g, column, row, 0, 1)));
        }
    g->source.spacing = spacing;
}

static void measure_bounds(Ground *g) {
    const HeightmapExtent *extent = heightmap_extent(g->map);
    double a = g->exaggeration * extent->lowest, b = g->exaggeration * extent->highest;
    double along = g->source.spacing * (double)int_max(g->source.columns, g->source.rows) / (SAMPLES - 1);
    g->bounds = box3_empty();
    if (!(extent->lowest <= extent->highest)) return;
    for (int j = 0; j < SAMPLES; j++)
        for (int i = 0; i < SAMPLES; i++)
            for (int top = 0; top < 2; top++) {
                Vec3 p = sample(g, i, j, top ? b : a);
                if (vec3_is_finite(p)) g->bounds = box3_add_point(g->bounds, p);
            }
    double margin = 2 * g->source.bend * along * along + 1e-6 * (1 + fabs(a) + fabs(b));
    g->bounds.min = vec3_sub(g->bounds.min, vec3_splat(margin));
    g->bounds.max = vec3_add(g->bounds.max, vec3_splat(margin));
}

const Ground *ground_create(const Heightmap *map, const GeoFrame *frame, double exaggeration, Arena *arena) {
    const HeightmapExtent *extent = heightmap_extent(map);
    Ground *g = arena_new(arena, Ground);
    *g = (Ground){.map = map, .frame = *frame, .exaggeration = exaggeration};
    g->source = (GroundSource){.columns = extent->columns, .rows = extent->rows, .height = post_height, .block = post_block, .place = post_place, .map = g};
    measure_spacing(g);
    measure_bend(g);
    measure_bounds(g);
    return g->source.spacing > 0 ? g : NULL;
}

Hash128 ground_hash(const Ground *g) {
    Hash128 h = hash_begin(0x7e44a1);
    hash_add_hash(&h, heightmap_hash(g->map));
    const double numbers[] = {g->frame.origin.latitude, g->frame.origin.longitude, g->frame.origin.height, g->frame.flat, g->exaggeration};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++) hash_add_double(&h, numbers[i]);
    return h;
}

/* ---- what others ask ---- */

enum { MOST_STEPS = 50 };
static const double CLOSE = 1e-7; /* metres */

/* The vertical of the frame is not that of the place, but near it: what is missing in height is missing in y, nearly. */
static bool height_at(const Ground *g, Vec3 p, double *y) {
    double at = 0;
    for (int i = 0; i < MOST_STEPS; i++) {
        GeoPlace place;
        double height;
        if (!scene_to_geo(&g->frame, vec3(p.x, at, p.z), &place) || !heightmap_height(g->map, place, &height)) return false;
        double missing = g->exaggeration * height - place.height;
        at += missing;
        if (fabs(missing) < CLOSE) break;
    }
    *y = at;
    return isfinite(at);
}

static Vec3 upwards(const Ground *g, double column, double row) {
    return vec3_sub(post_place(g, column, row, 1), post_place(g, column, row, 0));
}

static Vec3 place_on_ground(const Ground *g, double column, double row) {
    column = double_clamp(column, 0, g->source.columns - 1), row = double_clamp(row, 0, g->source.rows - 1);
    return post_place(g, column, row, ground_source_height(&g->source, column, row));
}

static Vec3 normal_at(const Ground *g, Vec3 p) {
    const double step = 1e-3; /* posts */
    GeoPlace place;
    double c, r;
    if (!scene_to_geo(&g->frame, p, &place) || !heightmap_from_geo(g->map, place, &c, &r)) return vec3(0, 1, 0);
    Vec3 across = vec3_sub(place_on_ground(g, c + step, r), place_on_ground(g, c - step, r));
    Vec3 down = vec3_sub(place_on_ground(g, c, r + step), place_on_ground(g, c, r - step));
    Vec3 n = vec3_normalize(vec3_cross(across, down)), up = upwards(g, c, r);
    if (!vec3_is_finite(n) || vec3_length_squared(n) == 0) return vec3(0, 1, 0);
    return vec3_dot(n, up) < 0 ? vec3_negate(n) : n;
}

static void allow_evenly(const void *context, const GroundSpot *spot, double *error, double *side) {
    (void)spot;
    *error = *(const double *)context;
    *side = HUGE_VAL;
}

static bool even_mesh(const Ground *g, double tolerance, size_t most_vertices, Arena *arena, MeshData *out) {
    GroundErrors errors;
    const GroundDetail detail = {.allow = allow_evenly, .context = &tolerance, .most_vertices = most_vertices};
    ground_errors_build(&g->source, NULL, arena, &errors);
    return ground_mesh_build(&g->source, &errors, &detail, arena, arena, out, NULL);
}

const TerrainOps ground_ops = {.height = height_at, .meet = ground_meet, .normal = normal_at, .mesh = even_mesh};
