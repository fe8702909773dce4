/* Surfaces of revolution about y: lathe and sor. */
#include "shape/outline.h"
#include "shape/roots.h"
#include "shape/solid.h"
#include "shape/solid_parts.h"

static const uint32_t PART_LOW = UINT32_MAX, PART_HIGH = UINT32_MAX - 1;

typedef struct LocalLine {
    Vec3 o, d;           /* d of unit length, o the point of the line nearest to the axis' middle */
    double shift, scale; /* t = (local + shift)·scale */
} LocalLine;

static LocalLine localize(const Ray *ray, Vec3 middle) {
    double length = vec3_length(ray->direction);
    Vec3 d = vec3_scale(ray->direction, 1 / length);
    double shift = -vec3_dot(vec3_sub(ray->origin, middle), d);
    return (LocalLine){vec3_madd(ray->origin, d, shift), d, shift, 1 / length};
}

static Vec3 turned_box_middle(const Outline *outline) {
    return vec3(0, (outline->min.y + outline->max.y) / 2, 0);
}

static Box3 turned_box(const Outline *outline) {
    double r = double_max(fabs(outline->min.x), fabs(outline->max.x));
    return (Box3){{-r, outline->min.y, -r}, {r, outline->max.y, r}};
}

/* ---- lathe ---- */

typedef struct Lathe {
    Outline outline;
    Outline mirrored; /* x and y changed over: POV-Ray tells the inside by what of the curve is above */
} Lathe;

static const void *lathe_prepare(const Object *object, Arena *arena) {
    const Solid *s = object->as.solid;
    Lathe *lathe = arena_new(arena, Lathe);
    outline_add_curve(arena, &lathe->outline, s->as.turned.curve, s->as.turned.points, s->as.turned.count);
    for (size_t i = 0; i < lathe->outline.count; i++)
        outline_add(arena, &lathe->mirrored, lathe->outline.items[i].y, lathe->outline.items[i].x);
    return lathe->outline.count ? lathe : NULL;
}

/* The part of the line, somewhat widened, on which pieces are looked for. */
typedef struct LineSpan {
    double near, far, slack;
} LineSpan;

static LineSpan span_of(const LocalLine *line, double size, const SolidSink *sink) {
    double slack = 1e-9 * (size + fabs(line->shift) * 1e-3);
    return (LineSpan){sink->t_min / line->scale - line->shift - slack, sink->t_max / line->scale - line->shift + slack, slack};
}

/* Whether the line comes, between the heights of the piece, as near to the axis as it and as far away. */
static bool may_meet(const OutlinePiece *piece, const LocalLine *line, LineSpan span) {
    Vec3 o = line->o, d = line->d;
    double low = piece->min.y - span.slack, high = piece->max.y + span.slack;
    if (d.y == 0 && (o.y < low || o.y > high)) return false;
    if (d.y != 0) {
        double t0 = (low - o.y) / d.y, t1 = (high - o.y) / d.y;
        span.near = double_max(span.near, double_min(t0, t1)), span.far = double_min(span.far, double_max(t0, t1));
    }
    if (span.near > span.far) return false;
    double across = d.x * d.x + d.z * d.z, along = o.x * d.x + o.z * d.z, off = o.x * o.x + o.z * o.z;
    double nearest = across > 0 ? double_clamp(-along / across, span.near, span.far) : 0;
    double outer = double_max(fabs(piece->min.x), fabs(piece->max.x)) + span.slack,
           inner = piece->min.x > 0 ? piece->min.x : piece->max.x < 0 ? -piece->max.x : 0;
    if ((across * nearest + 2 * along) * nearest + off > outer * outer) return false;
    inner = double_max(inner - span.slack, 0);
    return !((across * span.near + 2 * along) * span.near + off < inner * inner && (across * span.far + 2 * along) * span.far + off < inner * inner);
}

/* The squared distance from the axis is quadratic along the line, and y tells the place on the line: with y = y(s),
 * dy²·x(s)² = |dy·(oₓ, o_z) + (y(s) - o_y)·(dₓ, d_z)|², of degree 6 for cubic pieces. */
static void lathe_piece(const OutlinePiece *piece, uint32_t index, const LocalLine *line, SolidSink *sink) {
    Vec3 o = line->o, d = line->d;
    double rise[4], square[7], polynomial[7] = {0}, s[7];
    for (int i = 0; i < 4; i++) rise[i] = piece->y[i] - (i == 0 ? o.y : 0);
    roots_multiply(rise, 3, rise, 3, square);
    double across = d.x * d.x + d.z * d.z, along = o.x * d.x + o.z * d.z, off = o.x * o.x + o.z * o.z;
    for (int i = 0; i < 7; i++) polynomial[i] = across * square[i];
    for (int i = 0; i < 4; i++) polynomial[i] += 2 * along * d.y * rise[i];
    polynomial[0] += off * d.y * d.y;
    roots_multiply(piece->x, 3, piece->x, 3, square);
    for (int i = 0; i < 7; i++) polynomial[i] -= d.y * d.y * square[i];
    int count = roots_in(polynomial, 6, 0, 1, s);
    for (int i = 0; i < count; i++) {
        /* y gives t well where the line climbs, the distance from the axis where it does not. */
        Point2 p = outline_at(piece, s[i]);
        double half = sqrt(double_max(along * along - across * (off - p.x * p.x), 0)), t = (p.y - o.y) / d.y;
        if (across > 0) {
            double t0 = (-along - half) / across, t1 = (-along + half) / across;
            double nearer = fabs(t0 - t) <= fabs(t1 - t) ? t0 : t1;
            if (fabs(d.y) < 0.5) t = nearer;
        }
        solid_offer(sink, (t + line->shift) * line->scale, (SolidTag){index, s[i], 0});
    }
}

/* A line across the axis stays at one height. */
static void lathe_level(const OutlinePiece *piece, uint32_t index, const LocalLine *line, SolidSink *sink) {
    Vec3 o = line->o, d = line->d;
    double s[3], across = d.x * d.x + d.z * d.z, along = o.x * d.x + o.z * d.z, off = o.x * o.x + o.z * o.z;
    int count = outline_meet(piece, 0, 1, -o.y, s);
    for (int i = 0; i < count; i++) {
        double x = outline_at(piece, s[i]).x, inner = along * along - across * (off - x * x);
        if (!(inner >= 0)) continue;
        for (int side = -1; side <= 1; side += 2)
            solid_offer(sink, ((-along + side * sqrt(inner)) / across + line->shift) * line->scale,
                        (SolidTag){index, s[i], 0});
    }
}

static void lathe_cross(const void *data, const Ray *ray, SolidSink *sink) {
    const Outline *outline = &((const Lathe *)data)->outline;
    LocalLine line = localize(ray, turned_box_middle(outline));
    double size = turned_box(outline).max.x + outline->max.y - outline->min.y;
    bool level = fabs(line.d.y) * size < 1e-12 * size;
    if (level) line.d.y = 0;
    for (size_t i = 0; i < outline->count; i++)
        if (may_meet(&outline->items[i], &line, span_of(&line, size, sink)))
            (level ? lathe_level : lathe_piece)(&outline->items[i], (uint32_t)i, &line, sink);
}

static Vec3 spun_normal(Point2 tangent, Vec3 p, double side) {
    double r = hypot(p.x, p.z), c = r > 0 ? p.x / r : 0, s = r > 0 ? p.z / r : 0;
    return vec3_normalize(vec3(side * tangent.y * c, -tangent.x * side, side * tangent.y * s));
}

/* To the right of the curve, which for one that climbs is the outside. */
static Vec3 lathe_normal(const void *data, Vec3 p, const SolidTag *tag) {
    const OutlinePiece *piece = &((const Lathe *)data)->outline.items[tag->part];
    Point2 at = outline_at(piece, tag->u), tangent = outline_tangent(piece, tag->u);
    if (at.x < 0) tangent.x = -tangent.x; /* what lies beyond the axis is turned half round */
    return spun_normal(tangent, p, 1);
}

static TexCoord lathe_uv(const void *data, Vec3 p, const SolidTag *tag) {
    double pieces = (double)((const Lathe *)data)->outline.count;
    return (TexCoord){solid_turn(p.x, p.z), (tag->part + tag->u) / pieces};
}

static bool lathe_inside(const void *data, Vec3 p) {
    return outline_odd(&((const Lathe *)data)->mirrored, (Point2){p.y, hypot(p.x, p.z)});
}

static Box3 lathe_bounds(const void *data) { return turned_box(&((const Lathe *)data)->outline); }

const SolidOps solid_lathe_ops = {.prepare = lathe_prepare,
                                  .cross = lathe_cross,
                                  .normal = lathe_normal,
                                  .inside = lathe_inside,
                                  .uv = lathe_uv,
                                  .bounds = lathe_bounds};

/* ---- sor: r² is a cubic of the height between each two points ---- */

typedef struct SorPiece {
    double low, high, square[4]; /* r² = Σ square[i]·(y - low)ⁱ */
} SorPiece;

typedef struct Sor {
    SorPiece *pieces;
    size_t count;
    bool open;
    double largest; /* radius */
} Sor;

/* r² and its slope at both ends, the slopes from the neighbours' radii: 2r·dr/dy. */
static void sor_piece(const Point2 p[4], SorPiece *piece) {
    double h = p[2].y - p[1].y, v0 = p[1].x * p[1].x, v1 = p[2].x * p[2].x;
    double s0 = 2 * p[1].x * (p[2].x - p[0].x) / (p[2].y - p[0].y),
           s1 = 2 * p[2].x * (p[3].x - p[1].x) / (p[3].y - p[1].y);
    if (!isfinite(s0)) s0 = 0;
    if (!isfinite(s1)) s1 = 0;
    double rise = (v1 - v0) / h;
    *piece =
        (SorPiece){p[1].y, p[2].y, {v0, s0, (3 * rise - 2 * s0 - s1) / h, (s0 + s1 - 2 * rise) / (h * h)}};
}

static double piece_value(const SorPiece *piece, double y) {
    return roots_value(piece->square, 3, y - piece->low);
}

static const void *sor_prepare(const Object *object, Arena *arena) {
    const Solid *s = object->as.solid;
    Sor *sor = arena_new(arena, Sor);
    sor->open = s->as.turned.open;
    sor->count = s->as.turned.count - 3;
    sor->pieces = arena_new_array(arena, SorPiece, sor->count);
    for (size_t i = 0; i < sor->count; i++) {
        SorPiece *piece = &sor->pieces[i];
        sor_piece(&s->as.turned.points[i], piece);
        double height = piece->high - piece->low, places[4] = {0, height};
        double slope[3] = {piece->square[1], 2 * piece->square[2], 3 * piece->square[3]};
        int count = 2 + roots_in(slope, 2, 0, height, places + 2);
        for (int k = 0; k < count; k++)
            sor->largest =
                double_max(sor->largest, sqrt(double_max(piece_value(piece, piece->low + places[k]), 0)));
    }
    return sor;
}

static void sor_caps(const Sor *sor, const LocalLine *line, SolidSink *sink) {
    if (sor->open || line->d.y == 0) return;
    const SorPiece *ends[2] = {&sor->pieces[0], &sor->pieces[sor->count - 1]};
    for (int k = 0; k < 2; k++) {
        double y = k ? ends[1]->high : ends[0]->low, t = (y - line->o.y) / line->d.y;
        Vec3 p = vec3_madd(line->o, line->d, t);
        if (p.x * p.x + p.z * p.z <= piece_value(ends[k], y))
            solid_offer(sink, (t + line->shift) * line->scale, (SolidTag){k ? PART_HIGH : PART_LOW, 0, 0});
    }
}

static void sor_cross(const void *data, const Ray *ray, SolidSink *sink) {
    const Sor *sor = data;
    LocalLine line = localize(ray, vec3(0, (sor->pieces[0].low + sor->pieces[sor->count - 1].high) / 2, 0));
    Vec3 o = line.o, d = line.d;
    sor_caps(sor, &line, sink);
    for (size_t i = 0; i < sor->count; i++) {
        const SorPiece *piece = &sor->pieces[i];
        double c[4] = {0}, rise[2] = {o.y - piece->low, d.y}, power[4] = {1}, next[5], t[3];
        for (int k = 0; k < 4; k++) {
            for (int m = 0; m <= k; m++) c[m] -= piece->square[k] * power[m];
            if (k == 3) break;
            roots_multiply(power, k, rise, 1, next);
            for (int m = 0; m <= k + 1; m++) power[m] = next[m];
        }
        c[0] += o.x * o.x + o.z * o.z;
        c[1] += 2 * (o.x * d.x + o.z * d.z);
        c[2] += d.x * d.x + d.z * d.z;
        double reach = 2 * (sor->largest + sor->pieces[sor->count - 1].high - sor->pieces[0].low);
        int count = roots_in(c, 3, -reach, reach, t);
        for (int k = 0; k < count; k++) {
            double y = o.y + t[k] * d.y;
            if (y >= piece->low && y <= piece->high)
                solid_offer(sink, (t[k] + line.shift) * line.scale, (SolidTag){(uint32_t)i, 0, 0});
        }
    }
}

static Vec3 sor_normal(const void *data, Vec3 p, const SolidTag *tag) {
    if (tag->part >= PART_HIGH) return vec3(0, tag->part == PART_HIGH ? 1 : -1, 0);
    const SorPiece *piece = &((const Sor *)data)->pieces[tag->part];
    double y = p.y - piece->low;
    return vec3_normalize(
        vec3(2 * p.x, -((3 * piece->square[3] * y + 2 * piece->square[2]) * y + piece->square[1]), 2 * p.z));
}

/* On a cap v is the share of its radius, counted from the rim at the upper one. */
static TexCoord sor_uv(const void *data, Vec3 p, const SolidTag *tag) {
    const Sor *sor = data;
    double turn = solid_turn(p.x, p.z);
    if (tag->part >= PART_HIGH) {
        const SorPiece *end = tag->part == PART_HIGH ? &sor->pieces[sor->count - 1] : &sor->pieces[0];
        double rim = sqrt(double_max(piece_value(end, tag->part == PART_HIGH ? end->high : end->low), 0));
        double out = rim > 0 ? double_min(hypot(p.x, p.z) / rim, 1) : 0;
        return (TexCoord){turn, tag->part == PART_HIGH ? 1 - out : out};
    }
    const SorPiece *piece = &sor->pieces[tag->part];
    return (TexCoord){turn, (tag->part + (p.y - piece->low) / (piece->high - piece->low)) / (double)sor->count};
}

static bool sor_inside(const void *data, Vec3 p) {
    const Sor *sor = data;
    for (size_t i = 0; i < sor->count; i++)
        if (p.y >= sor->pieces[i].low && p.y <= sor->pieces[i].high)
            return p.x * p.x + p.z * p.z <= piece_value(&sor->pieces[i], p.y);
    return false;
}

bool solid_sor_at(const void *data, size_t index, double share, SorPlace *out) {
    const Sor *sor = data;
    if (index >= sor->count) return false;
    const SorPiece *piece = &sor->pieces[index];
    double y = share == 1 ? piece->high : piece->low + (piece->high - piece->low) * share, off = y - piece->low;
    out->y = y;
    out->square = double_max(piece_value(piece, y), 0);
    out->slope = (3 * piece->square[3] * off + 2 * piece->square[2]) * off + piece->square[1];
    return true;
}

static Box3 sor_bounds(const void *data) {
    const Sor *sor = data;
    return (Box3){{-sor->largest, sor->pieces[0].low, -sor->largest},
                  {sor->largest, sor->pieces[sor->count - 1].high, sor->largest}};
}

const SolidOps solid_sor_ops = {.prepare = sor_prepare,
                                .cross = sor_cross,
                                .normal = sor_normal,
                                .inside = sor_inside,
                                .uv = sor_uv,
                                .bounds = sor_bounds};
