#include "shape/tessellate_branches.h"

#include "shape/tessellate_solids.h"

#include <math.h>

enum { MOST_SKIPPED = 16, MOST_RESERVED_SIDES = 5 };
/* Sharper bends than this (the cosine between what comes and what goes on) are not mitred: the mitre would become a thorn. */
static const double SHARPEST = -0.3;
/* Of the radius, where a place is left out: it is seen as area. */
static const double MOST_CHANGE = 0.03;

typedef struct TubeRow {
    Vec3 place, tangent; /* of what leads here; of the first row: of what leads on */
    Vec3 across, front;  /* unit, with the tangent a frame */
    Vec3 cut;            /* normal of the plane in which this row lies */
    double radius, v;
} TubeRow;

typedef struct Tube {
    TubeRow *rows;
    int count, sides;
    double factor; /* circumradius of the polygon over the circle's */
} Tube;

static SoupVertex tube_point(const void *context, int i, int j) {
    const Tube *tube = context;
    const TubeRow *row = &tube->rows[i];
    double c, s;
    tessellate_turn(j, tube->sides, &c, &s);
    Vec3 radial = vec3_madd(vec3_scale(row->across, c), row->front, -s);
    /* Along the tube to the plane of the cut. */
    Vec3 to = vec3_madd(radial, row->tangent, -vec3_dot(radial, row->cut) / vec3_dot(row->tangent, row->cut));
    return (SoupVertex){vec3_madd(row->place, to, row->radius * tube->factor), radial, {(double)j / tube->sides, row->v}, NULL, NULL};
}

static void push_end(const Tube *tube, bool tip, Arena *arena, TriangleSoup *out) {
    int i = tip ? tube->count - 1 : 0;
    const TubeRow *row = &tube->rows[i];
    Vec3 normal = tip ? row->tangent : vec3_negate(row->tangent);
    if (row->radius == 0) return;
    uint32_t center = soup_vertex(arena, out, row->place, normal, 0.5, 0.5), first = center + 1;
    for (int j = 0; j <= tube->sides; j++) {
        double c, s;
        tessellate_turn(j, tube->sides, &c, &s);
        soup_vertex(arena, out, tube_point(tube, i, j).position, normal, 0.5 + 0.5 * c, 0.5 + 0.5 * s);
    }
    for (uint32_t j = 0; j < (uint32_t)tube->sides; j++) soup_triangle(arena, out, center, first + (tip ? j : j + 1), first + (tip ? j + 1 : j), true);
}

/* Frames along the rows: turned with the tangent, and no further. */
static void lay_frames(Tube *tube) {
    for (int i = 0; i < tube->count; i++) {
        TubeRow *row = &tube->rows[i];
        Vec3 in = vec3_normalize(vec3_sub(row->place, tube->rows[i ? i - 1 : 0].place)), on = in;
        if (i + 1 < tube->count) on = vec3_normalize(vec3_sub(tube->rows[i + 1].place, row->place));
        if (i == 0) {
            in = on;
            vec3_frame(in, &row->across, &row->front);
        } else {
            /* The least rotation from one tangent to the next. */
            const TubeRow *before = &tube->rows[i - 1];
            Vec3 turn = vec3_add(before->tangent, in);
            double square = vec3_length_squared(turn);
            row->across = before->across;
            if (square > 0) row->across = vec3_madd(row->across, turn, -2 * vec3_dot(row->across, turn) / square);
            row->across = vec3_normalize(vec3_madd(row->across, in, -vec3_dot(row->across, in)));
        }
        row->tangent = in;
        row->front = vec3_cross(row->across, in);
        row->cut = vec3_normalize(vec3_add(in, on));
    }
}

static void push_tube(Tube *tube, double tolerance, Arena *arena, TriangleSoup *out) {
    double thickest = 0;
    if (tube->count < 2) return;
    for (int i = 0; i < tube->count; i++) thickest = double_max(thickest, tube->rows[i].radius);
    if (!(thickest > 0)) return;
    tube->sides = tessellate_sides(thickest, tolerance);
    tube->factor = tessellate_perimeter_factor(tube->sides);
    lay_frames(tube);
    const SoupGrid grid = {tube->count - 1, tube->sides, tube->rows[0].radius == 0, tube->rows[tube->count - 1].radius == 0, true};
    soup_grid(arena, out, &grid, tube_point, tube);
    push_end(tube, false, arena, out);
    push_end(tube, true, arena, out);
}

/* Whether all places between two may be left out. */
static bool is_straight(const BranchNode *nodes, const uint32_t *between, int count, const BranchNode *a, const BranchNode *b, double tolerance) {
    Vec3 line = vec3_sub(b->position, a->position);
    double square = vec3_length_squared(line);
    for (int i = 0; i < count; i++) {
        const BranchNode *n = &nodes[between[i]];
        double along = square > 0 ? vec3_dot(vec3_sub(n->position, a->position), line) / square : 0;
        Vec3 off = vec3_sub(n->position, vec3_madd(a->position, line, along));
        double radius = a->radius + (b->radius - a->radius) * along, change = fabs(n->radius - radius);
        if (!(along > 0 && along < 1) || vec3_length(off) + change > tolerance || change > MOST_CHANGE * radius) return false;
    }
    return true;
}

static void add_row(Tube *tube, const BranchNode *node, int number) {
    tube->rows[tube->count++] = (TubeRow){.place = node->position, .radius = fabs(node->radius), .v = number};
}

static bool bends_sharply(const Tube *tube, Vec3 next) {
    if (tube->count < 2) return false;
    Vec3 at = tube->rows[tube->count - 1].place, in = vec3_sub(at, tube->rows[tube->count - 2].place), on = vec3_sub(next, at);
    return vec3_dot(in, on) < SHARPEST * vec3_length(in) * vec3_length(on);
}

/* The branch that begins at a node, following `next`. */
static void push_branch(const BranchNode *nodes, const uint32_t *next, uint32_t first, Tube *tube, double tolerance, Arena *arena, TriangleSoup *out) {
    uint32_t skipped[MOST_SKIPPED], from = first;
    int skipped_count = 0, number = 0;
    tube->count = 0;
    add_row(tube, &nodes[first], 0);
    for (uint32_t i = next[first]; i != BRANCH_FIRST; i = next[i]) {
        number++;
        const BranchNode *node = &nodes[i];
        if (vec3_length(vec3_sub(node->position, nodes[from].position)) == 0) continue;
        if (next[i] != BRANCH_FIRST && skipped_count < MOST_SKIPPED) {
            skipped[skipped_count] = i;
            if (is_straight(nodes, skipped, skipped_count + 1, &nodes[from], &nodes[next[i]], tolerance)) {
                skipped_count++;
                continue;
            }
        }
        if (bends_sharply(tube, node->position)) {
            TubeRow last = tube->rows[tube->count - 1];
            push_tube(tube, tolerance, arena, out);
            tube->rows[0] = last;
            tube->count = 1;
        }
        add_row(tube, node, number);
        from = i;
        skipped_count = 0;
    }
    push_tube(tube, tolerance, arena, out);
}

/* As if no place were left out, and nothing very round: what is thick and straight needs less, and must not ask for too much. */
static void reserve(const BranchNode *nodes, size_t count, double tolerance, Arena *arena, TriangleSoup *out) {
    size_t vertices = 0, triangles = 0;
    for (size_t i = 0; i < count; i++) {
        size_t sides = (size_t)int_min(tessellate_sides(fabs(nodes[i].radius), tolerance), MOST_RESERVED_SIDES);
        bool begins = nodes[i].previous == BRANCH_FIRST;
        vertices += sides + 1 + (begins ? 2 * (sides + 2) : 0);
        triangles += 2 * sides;
    }
    soup_reserve(arena, out, vertices, triangles);
}

void tessellate_branches(const Object *object, double tolerance, Arena *arena, TriangleSoup *out) {
    const BranchNode *nodes = object->as.branches.items;
    size_t count = object->as.branches.count, longest = 1;
    uint32_t *next = arena_new_array(arena, uint32_t, count + 1), *length = arena_new_array(arena, uint32_t, count + 1);
    for (size_t i = 0; i < count; i++) {
        next[i] = BRANCH_FIRST;
        length[i] = 1;
        if (nodes[i].previous == BRANCH_FIRST) continue;
        next[nodes[i].previous] = (uint32_t)i;
        length[i] += length[nodes[i].previous];
        if (length[i] > longest) longest = length[i];
    }
    reserve(nodes, count, tolerance, arena, out);
    Tube tube = {.rows = arena_new_array(arena, TubeRow, longest)};
    for (size_t i = 0; i < count; i++)
        if (nodes[i].previous == BRANCH_FIRST) push_branch(nodes, next, (uint32_t)i, &tube, tolerance, arena, out);
}
