#include "grow/particles.h"

#include "base/random.h"
#include "shape/tessellate_solids.h"

#include <string.h>

enum { MOST_SEGMENTS = 256 };

static const double FOLD_HALF_ANGLE = 55 * VTS_RADIANS;

/* ---- frames ---- */

typedef struct Frame {
    Vec3 place, tangent;
    Vec3 across; /* unit, along the width */
    Vec3 front;  /* across × tangent */
} Frame;

/* Of one trajectory. It lies in the plane across `binormal`; the frame that minimises rotation keeps its angle to it. */
typedef struct Sweep {
    const Particle *particle;
    Vec3 binormal, straight; /* straight: the tangent of a trajectory on a line; else zero */
    double angle;        /* from binormal × tangent to the width axis, towards the binormal, at the foot */
    double cosine, sine; /* of it */
    int segments, sides;
    double factor; /* circumradius of the tube's polygon over its radius */
    Frame rows[MOST_SEGMENTS + 1];
} Sweep;

static Vec3 velocity_at(const Particle *particle, double t) {
    return vec3_madd(particle->velocity, particle->acceleration, t);
}

static Vec3 place_at(const Particle *particle, double t) {
    return vec3_madd(vec3_madd(particle->position, particle->velocity, t), particle->acceleration,
                     0.5 * t * t);
}

static double hashed_turn(const Particle *particle) {
    const double numbers[6] = {particle->position.x + 0.0, particle->position.y + 0.0,
                               particle->position.z + 0.0, particle->velocity.x + 0.0,
                               particle->velocity.y + 0.0, particle->velocity.z + 0.0};
    uint64_t bits, hash = 0;
    for (int i = 0; i < 6; i++) {
        memcpy(&bits, &numbers[i], sizeof bits);
        hash = random_mix(hash ^ bits);
    }
    return 2 * VTS_PI * random_unit(hash);
}

/* A horizontal vector across which the blade is wide; not of unit length. */
static Vec3 lean(const Particle *particle) {
    Vec3 start = particle->velocity, mean = velocity_at(particle, particle->life / 2);
    if (hypot(start.x, start.z) > 1e-6 * fabs(start.y)) return vec3(start.x, 0, start.z);
    if (hypot(mean.x, mean.z) > 1e-6 * fabs(mean.y)) return vec3(mean.x, 0, mean.z);
    double turn = hashed_turn(particle);
    return vec3(cos(turn), 0, sin(turn));
}

static Vec3 tangent_at(const Sweep *sweep, double t) {
    if (vec3_length_squared(sweep->straight) > 0) return sweep->straight;
    return vec3_normalize(velocity_at(sweep->particle, t));
}

/* False where there is no direction at all. */
static bool start_sweep(const Particle *particle, Sweep *sweep) {
    Vec3 v = vec3_scale(particle->velocity, particle->life);
    Vec3 a = vec3_scale(particle->acceleration, particle->life * particle->life);
    Vec3 normal = vec3_cross(v, a);
    sweep->particle = particle;
    sweep->straight = vec3_splat(0);
    /* On a line when the plane is lost in rounding. */
    if (vec3_length(normal) <= 1e-12 * (vec3_length_squared(v) + vec3_length_squared(a))) {
        sweep->straight = vec3_normalize(vec3_length_squared(v) > 1e-24 * vec3_length_squared(a) ? v : a);
        if (!(vec3_length_squared(sweep->straight) > 0)) return false;
    }
    Vec3 tangent = tangent_at(sweep, 0);
    Vec3 across = vec3_cross(lean(particle), vec3(0, 1, 0));
    across = vec3_normalize(vec3_madd(across, tangent, -vec3_dot(across, tangent)));
    sweep->binormal =
        vec3_length_squared(sweep->straight) > 0 ? vec3_cross(tangent, across) : vec3_normalize(normal);
    sweep->cosine = vec3_dot(across, vec3_cross(sweep->binormal, tangent));
    sweep->sine = vec3_dot(across, sweep->binormal);
    sweep->angle = atan2(sweep->sine, sweep->cosine);
    return true;
}

static Frame frame_at(const Sweep *sweep, double share) {
    const Particle *particle = sweep->particle;
    double t = particle->life * share, cosine = sweep->cosine, sine = sweep->sine;
    if (particle->twist != 0) {
        double angle = sweep->angle + particle->twist * VTS_RADIANS * share;
        cosine = cos(angle), sine = sin(angle);
    }
    Frame frame = {.place = place_at(particle, t), .tangent = tangent_at(sweep, t)};
    Vec3 normal = vec3_cross(sweep->binormal, frame.tangent);
    frame.across = vec3_madd(vec3_scale(normal, cosine), sweep->binormal, sine);
    frame.front = vec3_cross(frame.across, frame.tangent);
    return frame;
}

static double half_width_at(const Particle *particle, double share) {
    double foot = fabs(particle->width_foot), tip = fabs(particle->width_tip);
    return 0.5 * (share == 1 ? tip : foot + (tip - foot) * share);
}

/* ---- strips ---- */

/* A strip between two curves that follow the trajectory at fixed places of its frame. */
typedef struct Strip {
    const Sweep *sweep;
    double x[2], y[2]; /* of the two curves, in half widths along `across` and `front` */
    double u[2];
} Strip;

static Vec3 strip_place(const Strip *strip, const Frame *frame, double half_width, int j) {
    Vec3 place = vec3_madd(frame->place, frame->across, strip->x[j] * half_width);
    return vec3_madd(place, frame->front, strip->y[j] * half_width);
}

static SoupVertex strip_point(const void *context, int i, int j) {
    const Strip *strip = context;
    double share = (double)i / strip->sweep->segments;
    const Frame *frame = &strip->sweep->rows[i];
    Vec3 across = vec3_madd(vec3_scale(frame->across, strip->x[1] - strip->x[0]), frame->front,
                            strip->y[1] - strip->y[0]);
    return (SoupVertex){strip_place(strip, frame, half_width_at(strip->sweep->particle, share), j),
                        vec3_normalize(vec3_cross(across, frame->tangent)),
                        {strip->u[j], share},
                        NULL,
                        NULL};
}

static void push_strip(const Strip *strip, Arena *arena, TriangleSoup *out) {
    const Particle *particle = strip->sweep->particle;
    const SoupGrid grid = {strip->sweep->segments, 1, particle->width_foot == 0, particle->width_tip == 0,
                           false};
    soup_grid(arena, out, &grid, strip_point, strip);
}

/* ---- tubes ---- */

static SoupVertex tube_point(const void *context, int i, int j) {
    const Sweep *sweep = context;
    double share = (double)i / sweep->segments, c, s;
    tessellate_turn(j, sweep->sides, &c, &s);
    const Frame *frame = &sweep->rows[i];
    Vec3 radial = vec3_madd(vec3_scale(frame->across, c), frame->front, -s);
    double radius = half_width_at(sweep->particle, share) * sweep->factor;
    return (SoupVertex){
        vec3_madd(frame->place, radial, radius), radial, {(double)j / sweep->sides, share}, NULL, NULL};
}

static void push_tube_end(const Sweep *sweep, bool tip, Arena *arena, TriangleSoup *out) {
    int row = tip ? sweep->segments : 0;
    const Frame *frame = &sweep->rows[row];
    Vec3 normal = tip ? frame->tangent : vec3_negate(frame->tangent);
    if (half_width_at(sweep->particle, tip ? 1 : 0) == 0) return;
    uint32_t center = soup_vertex(arena, out, frame->place, normal, 0.5, 0.5), first = center + 1;
    for (int j = 0; j <= sweep->sides; j++) {
        double c, s;
        tessellate_turn(j, sweep->sides, &c, &s);
        soup_vertex(arena, out, tube_point(sweep, row, j).position, normal, 0.5 + 0.5 * c, 0.5 + 0.5 * s);
    }
    for (uint32_t j = 0; j < (uint32_t)sweep->sides; j++) {
        uint32_t a = first + j, b = a + 1;
        soup_triangle(arena, out, center, tip ? a : b, tip ? b : a, true);
    }
}

static void push_tube(const Sweep *sweep, Arena *arena, TriangleSoup *out) {
    const SoupGrid grid = {sweep->segments, sweep->sides, sweep->particle->width_foot == 0,
                           sweep->particle->width_tip == 0, true};
    soup_grid(arena, out, &grid, tube_point, sweep);
    push_tube_end(sweep, false, arena, out);
    push_tube_end(sweep, true, arena, out);
}

/* ---- segments ---- */

static double distance_from_line(Vec3 p, Vec3 a, Vec3 b) {
    Vec3 line = vec3_sub(b, a), to = vec3_sub(p, a);
    double square = vec3_length_squared(line),
           along = square > 0 ? double_clamp(vec3_dot(to, line) / square, 0, 1) : 0;
    return vec3_length(vec3_madd(to, line, -along));
}

/* How far the middle of a segment is from its triangles, over the trajectory and the outermost curves of the profile. */
static double segment_deviation(const Frame *a, const Frame *m, const Frame *b, double wa, double wb) {
    static const double x[4] = {1, -1, 0, 0}, y[4] = {0, 0, 1, 0};
    double largest = 0;
    for (int i = 0; i < 4; i++) {
        const Strip curve = {NULL, {x[i], 0}, {y[i], 0}, {0, 0}};
        Vec3 pa = strip_place(&curve, a, wa, 0), pb = strip_place(&curve, b, wb, 0);
        largest = double_max(largest, distance_from_line(strip_place(&curve, m, (wa + wb) / 2, 0), pa, pb));
    }
    /* The diagonal of a twisted strip: a quarter of c0 - c1 + c2 - c3. */
    Vec3 warp = vec3_sub(vec3_scale(a->across, wa), vec3_scale(b->across, wb));
    double wedge = vec3_length(vec3_madd(warp, m->across, -vec3_dot(warp, m->across))) / 2;
    return largest + wedge;
}

/* Fills the rows on the way. */
static double sweep_deviation(Sweep *sweep, int segments) {
    double largest = 0;
    sweep->rows[0] = frame_at(sweep, 0);
    for (int i = 0; i < segments; i++) {
        double from = (double)i / segments, to = (double)(i + 1) / segments;
        Frame middle = frame_at(sweep, (from + to) / 2);
        sweep->rows[i + 1] = frame_at(sweep, to);
        double wa = half_width_at(sweep->particle, from), wb = half_width_at(sweep->particle, to);
        double here = segment_deviation(&sweep->rows[i], &middle, &sweep->rows[i + 1], wa, wb);
        largest = double_max(largest, here);
    }
    return largest;
}

static int sweep_segments(Sweep *sweep, double tolerance) {
    int segments = 1;
    /* One segment of a line that turns back would hide it. */
    if (vec3_length_squared(sweep->straight) > 0 && vec3_length_squared(sweep->particle->acceleration) > 0)
        segments = 2;
    for (;;) {
        double deviation = sweep_deviation(sweep, segments);
        if (deviation <= tolerance || segments >= MOST_SEGMENTS) return segments;
        /* The deviation goes as 1/segments², the wedge as 1/segments. */
        double wanted = ceil(segments * sqrt(deviation / tolerance));
        segments = wanted < MOST_SEGMENTS ? int_max(segments + 1, (int)wanted) : MOST_SEGMENTS;
    }
}

static void push_particle(const Particle *particle, double tolerance, Arena *arena, TriangleSoup *out) {
    double foot = fabs(particle->width_foot), tip = fabs(particle->width_tip);
    Sweep sweep;
    bool finite = vec3_is_finite(particle->position) && vec3_is_finite(particle->velocity) &&
                  vec3_is_finite(particle->acceleration) && isfinite(particle->life) && isfinite(foot + tip);
    if (!finite || !(particle->life > 0) || !(foot + tip > 0) || !start_sweep(particle, &sweep)) return;
    sweep.sides = tessellate_sides(0.5 * double_max(foot, tip), tolerance / 2);
    sweep.factor = tessellate_perimeter_factor(sweep.sides);
    sweep.segments = sweep_segments(&sweep, particle->profile == BLADE_ROUND ? tolerance / 2 : tolerance);
    double x = sin(FOLD_HALF_ANGLE), y = cos(FOLD_HALF_ANGLE);
    const Strip flat = {&sweep, {-1, 1}, {0, 0}, {0, 1}};
    const Strip left = {&sweep, {-x, 0}, {y / 2, -y / 2}, {0, 0.5}};
    const Strip right = {&sweep, {0, x}, {-y / 2, y / 2}, {0.5, 1}};
    switch (particle->profile) {
    case BLADE_V:
        push_strip(&left, arena, out);
        push_strip(&right, arena, out);
        break;
    case BLADE_ROUND: push_tube(&sweep, arena, out); break;
    case BLADE_FLAT: push_strip(&flat, arena, out); break;
    }
}

void particles_tessellate(const Particle *items, size_t count, double tolerance, Arena *arena,
                          TriangleSoup *out) {
    for (size_t i = 0; i < count; i++) push_particle(&items[i], tolerance, arena, out);
}
