/* blob: where the sum of the parts' densities is the threshold. */
#include "shape/roots.h"
#include "shape/solid.h"
#include "shape/solid_parts.h"
#include "shape/tessellate.h"

#include <stdlib.h>

/* The density of a part along a line is, from place to place, a polynomial of degree 4: in the ball at an end, or along the
 * straight between two ends. */
typedef struct Stage {
    double begin, end; /* along the line, in its own length */
    double density[5];
} Stage;

enum { FEW_STAGES = 64 };
typedef struct StageList {
    Stage *items;
    size_t count, capacity;
} StageList;


/* How the squared distance from the part changes along a line: a t² + b t + c. */
static void add_stage(Arena *arena, StageList *list, const BlobPart *part, double a, double b, double c,
                      double begin, double end) {
    double r2 = part->radius * part->radius, rest[3] = {1 - c / r2, -b / r2, -a / r2};
    double discriminant = rest[1] * rest[1] - 4 * rest[0] * rest[2];
    if (!(discriminant > 0) || !(r2 > 0)) {
        if (!(rest[1] == 0 && rest[2] == 0 && rest[0] > 0)) return;
    } else {
        double half = sqrt(discriminant) / (2 * fabs(rest[2])), middle = -rest[1] / (2 * rest[2]);
        begin = double_max(begin, middle - half);
        end = double_min(end, middle + half);
    }
    if (!(begin < end)) return;
    Stage stage = {.begin = begin, .end = end};
    roots_multiply(rest, 2, rest, 2, stage.density);
    for (int i = 0; i < 5; i++) stage.density[i] *= part->strength;
    *list_push(arena, list) = stage;
}

static void add_ball(Arena *arena, StageList *list, const BlobPart *part, Vec3 center, Vec3 o, Vec3 d,
                     double begin, double end) {
    Vec3 from = vec3_sub(o, center);
    add_stage(arena, list, part, vec3_length_squared(d), 2 * vec3_dot(from, d), vec3_length_squared(from),
              begin, end);
}

static void add_part(Arena *arena, StageList *list, const BlobPart *part, Vec3 o, Vec3 d, double reach) {
    o = transform_point_back(&part->transform, o);
    d = transform_vector_back(&part->transform, d);
    Vec3 axis = vec3_sub(part->cap, part->base);
    double length = vec3_length(axis);
    if (length == 0) {
        add_ball(arena, list, part, part->base, o, d, -reach, reach);
        return;
    }
    axis = vec3_scale(axis, 1 / length);
    /* z = z0 + z1 t along the axis: before the base, between, past the cap. */
    Vec3 from = vec3_sub(o, part->base);
    double z0 = vec3_dot(from, axis), z1 = vec3_dot(d, axis);
    Vec3 across = vec3_madd(from, axis, -z0), side = vec3_madd(d, axis, -z1);
    double a = vec3_length_squared(side), b = 2 * vec3_dot(across, side), c = vec3_length_squared(across);
    if (z1 == 0) {
        if (z0 < 0)
            add_ball(arena, list, part, part->base, o, d, -reach, reach);
        else if (z0 > length)
            add_ball(arena, list, part, part->cap, o, d, -reach, reach);
        else
            add_stage(arena, list, part, a, b, c, -reach, reach);
        return;
    }
    double at_base = -z0 / z1, at_cap = (length - z0) / z1;
    bool up = z1 > 0;
    add_ball(arena, list, part, up ? part->base : part->cap, o, d, -reach, up ? at_base : at_cap);
    add_stage(arena, list, part, a, b, c, double_max(-reach, up ? at_base : at_cap),
              double_min(reach, up ? at_cap : at_base));
    add_ball(arena, list, part, up ? part->cap : part->base, o, d, up ? at_cap : at_base, reach);
}

static int by_value(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

enum { FEW_PLACES = 24 };

static void sort_places(double *places, size_t count) {
    if (count > FEW_PLACES) {
        qsort(places, count, sizeof *places, by_value);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        double place = places[i];
        size_t at = i;
        for (; at > 0 && places[at - 1] > place; at--) places[at] = places[at - 1];
        places[at] = place;
    }
}

static Box3 part_bounds(const BlobPart *part) {
    Vec3 r = vec3_splat(fabs(part->radius));
    Box3 box = {vec3_sub(vec3_min(part->base, part->cap), r), vec3_add(vec3_max(part->base, part->cap), r)};
    return box3_transform(&part->transform, box);
}

/* A ball of the blob's space that a part does not reach out of. */
typedef struct PartBall {
    Vec3 center;
    double square; /* of its radius */
} PartBall;

typedef struct Blob {
    const Solid *solid;
    Box3 reach; /* of all parts */
    const PartBall *balls;
} Blob;

static PartBall part_ball(const BlobPart *part) {
    Vec3 middle = vec3_lerp(part->base, part->cap, 0.5);
    double radius = vec3_length(vec3_sub(part->cap, middle)) + fabs(part->radius);
    radius *= (1 + 1e-9) * tessellate_stretch(&part->transform.linear);
    return (PartBall){transform_point(&part->transform, middle), radius * radius};
}

/* `d` is of unit length. */
static bool line_misses(const PartBall *ball, Vec3 o, Vec3 d) {
    Vec3 to = vec3_sub(ball->center, o);
    double along = vec3_dot(to, d);
    return vec3_length_squared(vec3_madd(to, d, -along)) > ball->square;
}

/* Parts of negative strength only take away. */
static Box3 bounds(const void *data) {
    const Solid *s = ((const Blob *)data)->solid;
    Box3 box = box3_empty();
    if (s->as.blob.threshold <= 0) return (Box3){vec3_splat(-VTS_INFINITY), vec3_splat(VTS_INFINITY)};
    for (size_t i = 0; i < s->as.blob.count; i++)
        if (s->as.blob.parts[i].strength > 0) box = box3_union(box, part_bounds(&s->as.blob.parts[i]));
    return box;
}

static void solve(const StageList *list, double threshold, double *places, size_t count, double shift,
                  double length, SolidSink *sink) {
    sort_places(places, count);
    for (size_t i = 0; i + 1 < count; i++) {
        double sum[5] = {-threshold}, t[4], middle = (places[i] + places[i + 1]) / 2;
        bool any = false;
        if (!(places[i] < places[i + 1])) continue;
        for (size_t k = 0; k < list->count; k++) {
            if (middle <= list->items[k].begin || middle >= list->items[k].end) continue;
            for (int m = 0; m < 5; m++) sum[m] += list->items[k].density[m];
            any = true;
        }
        int zeros = any ? roots_in(sum, 4, places[i], places[i + 1], t) : 0;
        for (int k = 0; k < zeros; k++) solid_offer(sink, (t[k] + shift) / length, (SolidTag){0, 0, 0});
    }
}

static const void *prepare(const Object *object, Arena *arena) {
    Blob *blob = arena_new(arena, Blob);
    const Solid *s = blob->solid = object->as.solid;
    blob->reach = box3_empty();
    PartBall *balls = arena_new_array(arena, PartBall, s->as.blob.count);
    for (size_t i = 0; i < s->as.blob.count; i++) {
        blob->reach = box3_union(blob->reach, part_bounds(&s->as.blob.parts[i]));
        balls[i] = part_ball(&s->as.blob.parts[i]);
    }
    blob->balls = balls;
    return blob;
}

static void cross(const void *data, const Ray *ray, SolidSink *sink) {
    const Blob *blob = data;
    const Solid *s = blob->solid;
    const Box3 box = blob->reach;
    double length = vec3_length(ray->direction), reach = 2 * vec3_length(vec3_sub(box.max, box.min));
    Vec3 d = vec3_scale(ray->direction, 1 / length);
    double shift = vec3_dot(vec3_sub(vec3_lerp(box.min, box.max, 0.5), ray->origin), d);
    Vec3 o = vec3_madd(ray->origin, d, shift);
    Arena scratch;
    arena_init(&scratch, NULL, 8192);
    Stage few[FEW_STAGES]; /* the arena is asked for more only if they do not do */
    double few_places[2 * FEW_STAGES];
    StageList list = {few, 0, FEW_STAGES};
    for (size_t i = 0; i < s->as.blob.count; i++)
        if (!line_misses(&blob->balls[i], o, d)) add_part(&scratch, &list, &s->as.blob.parts[i], o, d, reach);
    double *places = list.count <= FEW_STAGES ? few_places : arena_new_array(&scratch, double, 2 * list.count);
    for (size_t i = 0; i < list.count; i++)
        places[2 * i] = list.items[i].begin, places[2 * i + 1] = list.items[i].end;
    solve(&list, s->as.blob.threshold, places, 2 * list.count, shift, length, sink);
    arena_destroy(&scratch);
}

/* What the nearest point of the part's segment is to p, both in the part's space. */
static Vec3 offset_from(const BlobPart *part, Vec3 p) {
    Vec3 axis = vec3_sub(part->cap, part->base);
    double square = vec3_length_squared(axis);
    double z = square > 0 ? double_clamp(vec3_dot(vec3_sub(p, part->base), axis) / square, 0, 1) : 0;
    return vec3_sub(p, vec3_madd(part->base, axis, z));
}

static double density_at(const Blob *blob, Vec3 p, Vec3 *downhill) {
    const Solid *s = blob->solid;
    double sum = 0;
    *downhill = vec3_splat(0);
    for (size_t i = 0; i < s->as.blob.count; i++) {
        const BlobPart *part = &s->as.blob.parts[i];
        if (vec3_length_squared(vec3_sub(p, blob->balls[i].center)) > blob->balls[i].square) continue;
        Vec3 off = offset_from(part, transform_point_back(&part->transform, p));
        double r2 = part->radius * part->radius, rest = 1 - vec3_length_squared(off) / r2;
        if (!(rest > 0)) continue;
        sum += part->strength * rest * rest;
        Vec3 n = transform_normal(&part->transform, off);
        *downhill = vec3_madd(*downhill, n, 4 * part->strength * rest / r2);
    }
    return sum;
}

/* Insertion into the `count` heaviest. */
static size_t add_share(BlobShare *out, size_t count, size_t most, BlobShare share) {
    size_t at = count < most ? count++ : most;
    for (; at > 0 && out[at - 1].weight < share.weight; at--)
        if (at < most) out[at] = out[at - 1];
    if (at < most) out[at] = share;
    return count;
}

size_t solid_blob_shares(const Solid *s, Vec3 p, BlobShare *out, size_t most) {
    double plain = 0, sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < s->as.blob.count; i++) {
        const BlobPart *part = &s->as.blob.parts[i];
        Vec3 off = offset_from(part, transform_point_back(&part->transform, p));
        double rest = 1 - vec3_length_squared(off) / (part->radius * part->radius), weight = fabs(part->strength) * rest * rest;
        if (!(rest > 0 && weight > 0)) continue;
        if (part->texture) count = add_share(out, count, most - 1, (BlobShare){(int)i, weight});
        else plain += weight;
    }
    if (plain > 0 || count == 0) out[count++] = (BlobShare){-1, plain > 0 ? plain : 1};
    for (size_t i = 0; i < count; i++) sum += out[i].weight;
    for (size_t i = 0; i < count; i++) out[i].weight /= sum;
    return count;
}

static Vec3 normal(const void *data, Vec3 p, const SolidTag *tag) {
    Vec3 n;
    (void)tag;
    density_at(data, p, &n);
    return vec3_normalize(n);
}

static bool inside(const void *data, Vec3 p) {
    Vec3 n;
    const Blob *blob = data;
    return density_at(blob, p, &n) > blob->solid->as.blob.threshold;
}

const SolidOps solid_blob_ops = {
    .prepare = prepare, .cross = cross, .normal = normal, .inside = inside, .bounds = bounds};
