#include "terrain/drape.h"

#include "terrain/map_place.h"

/* Places are looked up in a lattice over x and z, at height 0 and as they lean with height: the geodesy of each point of a picture would take
 * longer than the picture. It is made finer until it is right to this part of a pixel; if it never is, places are calculated. */
static const double PIXELS_OFF = 0.1;
enum { FIRST_SIDE = 17, MOST_SIDE = 257, RIM_SAMPLES = 33 };
/* Between these heights the lean was measured, metres; others are calculated. */
static const double LOWEST = -1000, HIGHEST = 9000;

typedef struct Node {
    double u, v, u_lean, v_lean; /* per metre of y */
} Node;

typedef struct Drape {
    PicturePlace base; /* first: a Drape is one */
    GeoFrame frame;
    Georeference where;
    int columns, rows; /* pixels */
    int side;          /* nodes along each side of the lattice; 0: none */
    double x0, z0, dx, dz;
    Node *nodes;
} Drape;

static bool calculate(const Drape *d, Vec3 p, double *u, double *v) {
    GeoPlace place;
    double column, row;
    if (!scene_to_geo(&d->frame, p, &place) || !georeference_from_geo(&d->where, place, &column, &row)) return false;
    *u = (column + 0.5) / d->columns;
    *v = 1 - (row + 0.5) / d->rows;
    return isfinite(*u) && isfinite(*v);
}

static Node mix(const Node *a, const Node *b, double t) {
    return (Node){a->u + t * (b->u - a->u), a->v + t * (b->v - a->v), a->u_lean + t * (b->u_lean - a->u_lean), a->v_lean + t * (b->v_lean - a->v_lean)};
}

static bool look_up(const Drape *d, Vec3 p, double *u, double *v) {
    double x = (p.x - d->x0) / d->dx, z = (p.z - d->z0) / d->dz;
    if (!d->side || !(x >= 0 && x <= d->side - 1 && z >= 0 && z <= d->side - 1) || !(p.y >= LOWEST && p.y <= HIGHEST)) return false;
    int c = int_min((int)x, d->side - 2), r = int_min((int)z, d->side - 2);
    const Node *n = &d->nodes[r * d->side + c];
    Node south = mix(&n[0], &n[1], x - c), north = mix(&n[d->side], &n[d->side + 1], x - c), at = mix(&south, &north, z - r);
    *u = at.u + p.y * at.u_lean;
    *v = at.v + p.y * at.v_lean;
    return true;
}

static bool find(const PicturePlace *place, Vec3 p, double *u, double *v) {
    const Drape *d = (const Drape *)place;
    return look_up(d, p, u, v) || calculate(d, p, u, v);
}

/* ---- the lattice ---- */

/* Where the picture's rim lies in the scene, at two heights. */
static Box3 rim_box(const Drape *d) {
    Box3 box = box3_empty();
    for (int k = 0; k < RIM_SAMPLES * RIM_SAMPLES; k++) {
        double s = k % RIM_SAMPLES / (RIM_SAMPLES - 1.0), t = k / RIM_SAMPLES / (RIM_SAMPLES - 1.0);
        GeoPlace place;
        Vec3 p;
        if (!georeference_to_geo(&d->where, s * d->columns - 0.5, t * d->rows - 0.5, &place)) continue;
        for (int top = 0; top < 2; top++) {
            place.height = top ? HIGHEST : LOWEST;
            if (geo_to_scene(&d->frame, place, &p) && vec3_is_finite(p)) box = box3_add_point(box, p);
        }
    }
    return box;
}

static bool fill_lattice(Drape *d) {
    for (int r = 0; r < d->side; r++)
        for (int c = 0; c < d->side; c++) {
            const double x = d->x0 + c * d->dx, z = d->z0 + r * d->dz;
            Node *n = &d->nodes[r * d->side + c];
            double u, v;
            if (!calculate(d, vec3(x, 0, z), &n->u, &n->v) || !calculate(d, vec3(x, HIGHEST, z), &u, &v)) return false;
            n->u_lean = (u - n->u) / HIGHEST;
            n->v_lean = (v - n->v) / HIGHEST;
        }
    return true;
}

/* In the middles of cells and of their sides, where lines bend away most, and half way up. */
static bool lattice_is_right(const Drape *d) {
    const double heights[] = {LOWEST, 0, 0.5 * HIGHEST};
    for (int k = 0; k < 3; k++)
        for (int r = 0; r < 2 * d->side - 1; r++)
            for (int c = 0; c < 2 * d->side - 1; c++) {
                const Vec3 p = vec3(d->x0 + 0.5 * c * d->dx, heights[k], d->z0 + 0.5 * r * d->dz);
                double u, v, fast_u, fast_v;
                if (!calculate(d, p, &u, &v) || !look_up(d, p, &fast_u, &fast_v)) return false;
                if (!(fabs(u - fast_u) * d->columns <= PIXELS_OFF && fabs(v - fast_v) * d->rows <= PIXELS_OFF)) return false;
            }
    return true;
}

static void make_lattice(Drape *d, Arena *arena) {
    const Box3 box = rim_box(d);
    const Vec3 size = vec3_sub(box.max, box.min);
    if (!(size.x > 0 && size.z > 0 && vec3_is_finite(size))) return;
    d->nodes = arena_new_array(arena, Node, (size_t)MOST_SIDE * MOST_SIDE);
    for (d->side = FIRST_SIDE; d->side <= MOST_SIDE; d->side = 2 * d->side - 1) {
        d->dx = 1.02 * size.x / (d->side - 1), d->dz = 1.02 * size.z / (d->side - 1);
        d->x0 = box.min.x - 0.01 * size.x, d->z0 = box.min.z - 0.01 * size.z;
        if (!fill_lattice(d)) break;
        if (lattice_is_right(d)) return;
    }
    d->side = 0;
}

static Hash128 hash_of(const Drape *d) {
    Hash128 h = hash_begin(0x647261);
    const double numbers[] = {d->frame.origin.latitude, d->frame.origin.longitude, d->frame.origin.height, d->frame.flat, d->columns, d->rows};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++) hash_add_double(&h, numbers[i]);
    hash_add(&h, d->where.x, sizeof d->where.x);
    hash_add(&h, d->where.y, sizeof d->where.y);
    double u = 0, v = 0; /* of the projection: where the scene's origin lies in it */
    if (calculate(d, vec3_splat(0), &u, &v)) hash_add_double(&h, u), hash_add_double(&h, v);
    return h;
}

const PicturePlace *drape_open(const char *path, int columns, int rows, const GeoFrame *frame, Arena *arena, StrBuf *error) {
    MapFile file = {.path = path, .columns = columns, .rows = rows};
    georeference_init(&file.place);
    map_place_picture(&file);
    if (!file.place.placed) strbuf_adds(error, file.misplaced.size ? file.misplaced.data : "nothing says where it lies");
    strbuf_free(&file.misplaced);
    if (!file.place.placed) return NULL;
    Drape *d = arena_new(arena, Drape);
    *d = (Drape){.base.find = find, .frame = *frame, .where = file.place, .columns = columns, .rows = rows};
    make_lattice(d, arena);
    d->base.hash = hash_of(d);
    return &d->base;
}
