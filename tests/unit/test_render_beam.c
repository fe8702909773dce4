/* Triangles drawn into beams against brute force in doubles: every sample against every polygon. Samples that pass an edge too near to say are left out. */
#include "base/random.h"
#include "render/beam.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { COLUMNS = 7, ROWS = 5, PER_BIN = 12, SAMPLES = COLUMNS * ROWS * PER_BIN, PADDED = SAMPLES + BEAM_LANES - 1, POLYGONS = 40, MOST_SIDES = 6 };
static const double NEAREST = 0.5, NEAR_EDGE = 1e-4;

typedef struct Polygon {
    Vec3f corner[MOST_SIDES];
    int count;
} Polygon;

typedef struct Field {
    uint32_t first[COLUMNS * ROWS + 1], mark[PADDED];
    float x[PADDED], y[PADDED], key[PADDED], limit[PADDED];
    Beam beam;
    Polygon polygons[POLYGONS];
} Field;

static double between(RandomStream *r, double lo, double hi) { return lo + (hi - lo) * random_next_unit(r); }

static void lay(Field *f, RandomStream *r, bool perspective, bool light) {
    f->beam = (Beam){.perspective = perspective, .light = light, .nearest = perspective ? NEAREST : 8, .farthest = 100, .exact_to = 1};
    f->beam.samples = (BeamSamples){COLUMNS, ROWS, f->first, f->x, f->y, f->key, f->limit, f->mark};
    for (int bin = 0, i = 0; bin < COLUMNS * ROWS; bin++) {
        f->first[bin] = (uint32_t)i;
        for (int k = 0; k < PER_BIN; k++, i++) {
            f->x[i] = (float)(bin % COLUMNS + between(r, 0.001, 0.999));
            f->y[i] = (float)(bin / COLUMNS + between(r, 0.001, 0.999));
            f->key[i] = light ? (float)between(r, 0.1, 2) : perspective ? 0 : -1e30f;
            f->limit[i] = -1e30f;
            f->mark[i] = 0;
        }
    }
    f->first[COLUMNS * ROWS] = SAMPLES;
    for (int i = SAMPLES; i < PADDED; i++) f->key[i] = INFINITY;
}

/* A convex polygon: corners in order on an ellipse of a random plane; some reach behind the eye. */
static Polygon random_polygon(RandomStream *r, bool perspective) {
    Polygon p = {.count = 3 + (int)(random_next_unit(r) * (MOST_SIDES - 2))};
    double size = pow(10, between(r, -1.5, 1)), turn = between(r, 0, 6);
    double cx = between(r, -2, COLUMNS + 2), cy = between(r, -2, ROWS + 2), cz = between(r, 0.6, 6), scale = perspective ? cz : 1;
    double ux = between(r, -1, 1), uy = between(r, -1, 1), uz = between(r, -1, 1), vx = between(r, -1, 1), vy = between(r, -1, 1), vz = between(r, -1, 1);
    for (int i = 0; i < p.count; i++) {
        double c = size * cos(turn + 2 * VTS_PI * i / p.count), s = size * sin(turn + 2 * VTS_PI * i / p.count);
        p.corner[i] = vec3f((float)(scale * cx + c * ux + s * vx), (float)(scale * cy + c * uy + s * vy), (float)(cz + c * uz + s * vz));
    }
    return p;
}

/* The key at which the line of (x, y) passes the polygon's plane; *in tells whether within it: 1, 0, or -1 when that is hard to say. */
static double pass(const Polygon *p, double x, double y, bool perspective, double nearest, int *in) {
    Vec3 a = vec3_from_f(p->corner[0]), n = vec3_cross(vec3_sub(vec3_from_f(p->corner[1]), a), vec3_sub(vec3_from_f(p->corner[2]), a));
    Vec3 line = perspective ? vec3(x, y, 1) : vec3(0, 0, 1), from = perspective ? vec3(0, 0, 0) : vec3(x, y, 0);
    double t = vec3_dot(vec3_sub(a, from), n) / vec3_dot(line, n), slack = VTS_INFINITY;
    Vec3 q = vec3_madd(from, line, t);
    double across = vec3_dot(vec3_normalize(n), vec3_normalize(line));
    for (int i = 0; i < p->count; i++) {
        Vec3 e0 = vec3_from_f(p->corner[i]), e1 = vec3_from_f(p->corner[(i + 1) % p->count]);
        Vec3 inward = vec3_normalize(vec3_cross(n, vec3_sub(e1, e0)));
        slack = fmin(slack, vec3_dot(vec3_sub(q, e0), inward));
    }
    double depth = perspective ? t - nearest : nearest - t;
    slack = fmin(slack, depth);
    *in = !(fabs(across) > 1e-3) || fabs(slack) < NEAR_EDGE * (1 + fabs(t)) / fabs(across) ? -1 : slack > 0;
    return perspective ? 1 / t : t;
}

/* Compares a sample; returns whether it could be told. */
static bool compare_sample(const Field *f, const float *keys, int i) {
    double best = f->beam.light ? (double)keys[i] : -1e30, second = -1e30;
    uint32_t wanted = 0;
    bool hidden = false;
    for (int k = 0; k < POLYGONS; k++) {
        int in;
        double key = pass(&f->polygons[k], (double)f->x[i], (double)f->y[i], f->beam.perspective, f->beam.nearest, &in);
        if (in < 0) return false;
        if (!in) continue;
        if (f->beam.light) {
            if (fabs(key - best) < 1e-3) return false;
            hidden |= key > best;
        } else if (key > best) {
            second = best, best = key, wanted = (uint32_t)k + 1;
        } else {
            second = fmax(second, key);
        }
    }
    if (f->beam.light) {
        assert_int_equal(f->mark[i] != 0, hidden);
        return true;
    }
    if (wanted && best - second < 1e-3 * (1 + fabs(best))) return false;
    assert_int_equal(f->mark[i], wanted);
    if (wanted) assert_true(fabs((double)f->key[i] - best) < 1e-3 * (1 + fabs(best)));
    return true;
}

static void check_kind(bool perspective, bool light, uint64_t seed) {
    enum { ROUNDS = 60 };
    static Field f;
    float keys[SAMPLES];
    int told = 0, seen = 0;
    RandomStream r = {seed};
    for (int round = 0; round < ROUNDS; round++) {
        lay(&f, &r, perspective, light);
        memcpy(keys, f.key, sizeof keys);
        for (int k = 0; k < POLYGONS; k++) {
            f.polygons[k] = random_polygon(&r, perspective);
            beam_draw(&f.beam, f.polygons[k].corner, f.polygons[k].count, (uint32_t)k + 1);
        }
        for (int i = 0; i < SAMPLES; i++) told += compare_sample(&f, keys, i), seen += f.mark[i] != 0;
    }
    print_message("%s%s: %d of %d samples told, %d see something\n", perspective ? "perspective" : "parallel", light ? " light" : "", told,
                  ROUNDS * SAMPLES, seen);
    assert_true(told > ROUNDS * SAMPLES * 3 / 4 && seen > ROUNDS * SAMPLES / 5 && seen < ROUNDS * SAMPLES);
}

static void eye_in_perspective(void **state) { (void)state, check_kind(true, false, 1); }
static void eye_in_parallel(void **state) { (void)state, check_kind(false, false, 2); }
static void light_in_perspective(void **state) { (void)state, check_kind(true, true, 3); }
static void light_in_parallel(void **state) { (void)state, check_kind(false, true, 4); }

/* A mesh is seen as its triangles are one by one, to the bit; before too many samples nothing is done. */
static void meshes_are_their_triangles(void **state) {
    (void)state;
    enum { ROUNDS = 600, CORNERS = 24 };
    static Field f, other;
    int drawn = 0, refused = 0, met = 0;
    RandomStream r = {12};
    for (int round = 0; round < ROUNDS; round++) {
        const bool perspective = round & 1, light = round & 2;
        float x[CORNERS], y[CORNERS], key[CORNERS];
        uint8_t triangles[BEAM_MESH][3];
        BeamMesh mesh = {.x = x, .y = y, .key = key, .triangles = (const uint8_t(*)[3])triangles};
        lay(&f, &r, perspective, light);
        const double size = pow(10, between(&r, -1, 0.6)), left = between(&r, -size, COLUMNS), top = between(&r, -size, ROWS);
        for (int i = 0; i < CORNERS; i++)
            x[i] = (float)(left + between(&r, 0, size)), y[i] = (float)(top + between(&r, 0, size)), key[i] = (float)between(&r, 0.1, 2);
        for (int i = 0; i < BEAM_MESH; i++) {
            for (int k = 0; k < 3; k++) triangles[i][k] = (uint8_t)between(&r, 0, CORNERS);
            if (round % 3 == 0 || random_next_unit(&r) < 0.7) mesh.which[mesh.count++] = (uint8_t)i;
        }
        for (int i = 0; i < CORNERS; i++) triangles[i][0] = (uint8_t)i; /* so that all of them have all corners */
        mesh.corners = round % 3 == 0 ? CORNERS : 0;
        other = f;
        other.beam.samples = (BeamSamples){COLUMNS, ROWS, other.first, other.x, other.y, other.key, other.limit, other.mark};
        BeamSeen seen[BEAM_FEW_SAMPLES];
        const int count = beam_draw_mesh(&f.beam, &mesh, seen);
        for (int i = 0; i < count; i++) f.mark[seen[i].sample] = seen[i].triangle + 1u;
        drawn += count >= 0, refused += count < 0;
        for (int i = 0; count >= 0 && i < mesh.count; i++) {
            const uint8_t *v = triangles[mesh.which[i]];
            beam_draw_seen(&other.beam, vec3f(x[v[0]], y[v[0]], key[v[0]]), vec3f(x[v[1]], y[v[1]], key[v[1]]), vec3f(x[v[2]], y[v[2]], key[v[2]]), mesh.which[i] + 1u);
        }
        for (int i = 0; i < SAMPLES; i++) {
            assert_true(f.key[i] == other.key[i]);
            assert_int_equal(light ? f.mark[i] != 0 : f.mark[i], light ? other.mark[i] != 0 : other.mark[i]);
            met += f.mark[i] != 0;
        }
    }
    print_message("%d meshes drawn, %d before too many samples, %d samples met\n", drawn, refused, met);
    assert_true(drawn > ROUNDS / 4 && refused > ROUNDS / 50 && met > ROUNDS);
}

/* Nothing that is no triangle is seen, or harms. */
static void nonsense_is_not_seen(void **state) {
    (void)state;
    static Field f;
    RandomStream r = {9};
    lay(&f, &r, true, false);
    const float bad[] = {0, NAN, INFINITY, -INFINITY, 1e30f, -1e30f};
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++) {
            Vec3f p[3] = {{1, 1, 2}, {bad[a], 3, 2}, {2, bad[b], 2}}, line[3] = {{bad[a], 1, 1}, {bad[a], 1, 1}, {3, bad[b], 1}};
            beam_draw(&f.beam, line, 3, 1);
            if (isfinite(bad[a]) && isfinite(bad[b])) continue;
            beam_draw(&f.beam, p, 3, 1);
        }
    for (int i = 0; i < SAMPLES; i++) assert_true(isfinite(f.key[i]));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(eye_in_perspective), cmocka_unit_test(eye_in_parallel), cmocka_unit_test(light_in_perspective),
                                       cmocka_unit_test(light_in_parallel), cmocka_unit_test(meshes_are_their_triangles),
                                       cmocka_unit_test(nonsense_is_not_seen)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
