#include "render/beam.h"

#include <string.h>

Vec3 beam_vector(const Beam *beam, Vec3 v) {
    return vec3(vec3_dot(beam->rows[0], v), vec3_dot(beam->rows[1], v), vec3_dot(beam->rows[2], v));
}

Vec3 beam_point(const Beam *beam, Vec3 p) { return vec3_add(beam_vector(beam, vec3_sub(p, beam->origin)), beam->shift); }

/* k·q.x + l·q.y + m·q.z + n >= 0, of points of the scene. */
static BeamPlane plane_of(const Beam *b, double k, double l, double m, double n) {
    Vec3 normal = vec3_madd(vec3_madd(vec3_scale(b->rows[0], k), b->rows[1], l), b->rows[2], m);
    double offset = k * b->shift.x + l * b->shift.y + m * b->shift.z + n - vec3_dot(normal, b->origin);
    return (BeamPlane){normal, offset};
}

void beam_close(Beam *b) {
    double width = b->samples.columns, height = b->samples.rows;
    bool p = b->perspective;
    b->planes[0] = plane_of(b, 1, 0, 0, 0);
    b->planes[1] = p ? plane_of(b, -1, 0, width, 0) : plane_of(b, -1, 0, 0, width);
    b->planes[2] = plane_of(b, 0, 1, 0, 0);
    b->planes[3] = p ? plane_of(b, 0, -1, height, 0) : plane_of(b, 0, -1, 0, height);
    b->planes[4] = plane_of(b, 0, 0, p ? 1 : -1, p ? -b->nearest : b->nearest);
    b->planes[5] = plane_of(b, 0, 0, p ? -1 : 1, p ? b->farthest : -b->farthest);
}

bool beam_meets_box(const Beam *beam, const Box3 *box) {
    Vec3 middle = vec3_scale(vec3_add(box->min, box->max), 0.5), half = vec3_scale(vec3_sub(box->max, box->min), 0.5);
    for (int i = 0; i < 6; i++) {
        const BeamPlane *plane = &beam->planes[i];
        double reach = fabs(plane->normal.x) * half.x + fabs(plane->normal.y) * half.y + fabs(plane->normal.z) * half.z;
        if (vec3_dot(plane->normal, middle) + plane->offset + reach < 0) return false;
    }
    return true;
}

/* ---- drawing ---- */

/* A triangle's barycentric coordinates and its key as functions of the way from its first corner: e1 = a1·dx + b1·dy, e2 likewise, e0 = 1 − e1 − e2.
 * From the origin of the samples they would lose the digits that a narrow blade's shadow on itself needs. */
typedef struct Triangle {
    float x, y, key; /* of the corner */
    float a1, b1, a2, b2;
    float key_x, key_y;
} Triangle;

static bool set_up(const Vec3f p[3], Triangle *t) {
    float x1 = p[1].x - p[0].x, y1 = p[1].y - p[0].y, x2 = p[2].x - p[0].x, y2 = p[2].y - p[0].y, area = x1 * y2 - x2 * y1;
    if (!(fabsf(area) > 1e-20f)) return false;
    float inverse = 1 / area, key1 = p[1].z - p[0].z, key2 = p[2].z - p[0].z;
    *t = (Triangle){.x = p[0].x, .y = p[0].y, .key = p[0].z, .a1 = y2 * inverse, .b1 = -x2 * inverse, .a2 = -y1 * inverse, .b2 = x1 * inverse};
    t->key_x = t->a1 * key1 + t->a2 * key2;
    t->key_y = t->b1 * key1 + t->b2 * key2;
    return true;
}

/* Slack of bins against rounding. */
static const float HAIR = 1e-3f;

static int bin_below(float x, int most) { return x > 0 ? x < (float)most ? (int)x : most : 0; }

typedef float Floats __attribute__((vector_size(4 * BEAM_LANES)));
typedef int32_t Masks __attribute__((vector_size(4 * BEAM_LANES)));
typedef int64_t Pairs __attribute__((vector_size(4 * BEAM_LANES)));

static Floats floats_at(const float *from) {
    Floats f;
    memcpy(&f, from, sizeof f);
    return f;
}

static bool any_of(Masks m) {
    Pairs p;
    memcpy(&p, &m, sizeof p);
    return p[0] | p[1];
}

/* Samples begin … end − 1 against the triangle, and some after them where they are not as many as go together: what is found for those does no harm. Hardly any triangle
 * that is seen from far away meets one, so that most is left out. Of a light's beam samples keep their own keys. */
static bool cover(const Beam *beam, const Triangle *t, uint32_t begin, uint32_t end, uint32_t mark) {
    const BeamSamples *s = &beam->samples;
    const Floats none = {0};
    const float most = beam->perspective ? INFINITY : (float)beam->nearest, exact_to = beam->exact_to;
    bool any = false;
    for (uint32_t i = begin; i < end; i += BEAM_LANES) {
        Floats dx = floats_at(s->x + i) - t->x, dy = floats_at(s->y + i) - t->y;
        Floats e1 = t->a1 * dx + t->b1 * dy, e2 = t->a2 * dx + t->b2 * dy;
        Masks in = (e1 >= 0) & (e2 >= 0) & (e1 + e2 <= 1);
        if (!any_of(in)) continue;
        Floats k = t->key + (t->key_x * dx + t->key_y * dy), key = floats_at(s->key + i);
        in &= (k > key) & (k <= most) & ((beam->light ? none + exact_to : k * exact_to) >= floats_at(s->limit + i));
        if (!any_of(in)) continue;
        any = true;
        Masks marks;
        memcpy(&marks, s->mark + i, sizeof marks);
        marks = (marks & ~in) | ((int32_t)mark & in);
        memcpy(s->mark + i, &marks, sizeof marks);
        if (beam->light) continue;
        Masks keys = ((Masks)key & ~in) | ((Masks)k & in);
        memcpy(s->key + i, &keys, sizeof keys);
    }
    return any;
}

/* The range of x that the triangle has between two heights. */
static void narrow(const Vec3f p[3], float top, float bottom, float *left, float *right) {
    *left = INFINITY, *right = -INFINITY;
    for (int i = 0; i < 3; i++) {
        Vec3f a = p[i], b = p[(i + 1) % 3];
        if (a.y > b.y) a = p[(i + 1) % 3], b = p[i];
        if (b.y < top || a.y > bottom) continue;
        float slope = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0;
        float x0 = a.y < top ? a.x + (top - a.y) * slope : a.x, x1 = b.y > bottom ? a.x + (bottom - a.y) * slope : b.x;
        *left = float_min(*left, float_min(x0, x1));
        *right = float_max(*right, float_max(x0, x1));
    }
}

static bool holds_samples(const BeamSamples *s, int x0, int x1, int y0, int y1) {
    for (int row = y0; row <= y1; row++)
        if (s->first[row * s->columns + x1 + 1] > s->first[row * s->columns + x0]) return true;
    return false;
}

bool beam_draw_seen(Beam *beam, Vec3f a, Vec3f b, Vec3f c, uint32_t mark) {
    enum { FEW_BINS = 3 }; /* in a row: narrowing it takes longer than looking at all that is in them */
    const BeamSamples *s = &beam->samples;
    float left = float_min(a.x, float_min(b.x, c.x)), right = float_max(a.x, float_max(b.x, c.x));
    float top = float_min(a.y, float_min(b.y, c.y)), bottom = float_max(a.y, float_max(b.y, c.y));
    if (!(right >= 0 && left <= (float)s->columns && bottom >= 0 && top <= (float)s->rows)) return false;
    int x0 = bin_below(left, s->columns - 1), x1 = bin_below(right, s->columns - 1);
    int y0 = bin_below(top, s->rows - 1), y1 = bin_below(bottom, s->rows - 1);
    Triangle t;
    Vec3f corners[3] = {a, b, c};
    if (!holds_samples(s, x0, x1, y0, y1) || !set_up(corners, &t)) return false;
    const bool large = y1 > y0 && x1 - x0 >= FEW_BINS;
    bool any = false;
    for (int row = y0; row <= y1; row++) {
        const uint32_t *first = s->first + row * s->columns;
        if (large) {
            narrow(corners, (float)row - HAIR, (float)(row + 1) + HAIR, &left, &right);
            if (!(right + HAIR >= 0 && left - HAIR <= (float)s->columns)) continue;
            x0 = bin_below(left - HAIR, s->columns - 1), x1 = bin_below(right + HAIR, s->columns - 1);
        }
        any |= cover(beam, &t, first[x0], first[x1 + 1], mark);
    }
    return any;
}

/* ---- meshes before few samples ---- */

/* Beyond corners and keys, as rounding may put what is computed from them. */
static const float CORNER_SLACK = 2e-5f, KEY_SLACK = 4e-6f;

/* Rectangles around a mesh's triangles, and their greatest keys. The last few hold nothing. */
typedef struct Outlines {
    float left[BEAM_MESH], right[BEAM_MESH], top[BEAM_MESH], bottom[BEAM_MESH], key[BEAM_MESH];
} Outlines;

static void outline(const BeamMesh *mesh, Outlines *o) {
    for (int i = 0; i < mesh->count; i++) {
        const uint8_t *corner = mesh->triangles[mesh->which[i]];
        const int a = corner[0], b = corner[1], c = corner[2];
        o->left[i] = float_min(mesh->x[a], float_min(mesh->x[b], mesh->x[c])) - CORNER_SLACK;
        o->right[i] = float_max(mesh->x[a], float_max(mesh->x[b], mesh->x[c])) + CORNER_SLACK;
        o->top[i] = float_min(mesh->y[a], float_min(mesh->y[b], mesh->y[c])) - CORNER_SLACK;
        o->bottom[i] = float_max(mesh->y[a], float_max(mesh->y[b], mesh->y[c])) + CORNER_SLACK;
        o->key[i] = float_max(mesh->key[a], float_max(mesh->key[b], mesh->key[c]));
        o->key[i] += KEY_SLACK * (fabsf(mesh->key[a]) + fabsf(mesh->key[b]) + fabsf(mesh->key[c]));
    }
    for (int i = mesh->count; i % BEAM_LANES; i++) o->left[i] = INFINITY, o->right[i] = o->top[i] = o->bottom[i] = o->key[i] = -INFINITY;
}

/* A rectangle around all of them, and the greatest key. */
typedef struct Extent {
    float left, right, top, bottom, key;
} Extent;

static Floats lesser(Floats a, Floats b) {
    const Masks less = a < b;
    return (Floats)(((Masks)a & less) | ((Masks)b & ~less));
}

static float least_of(Floats f) { return float_min(float_min(f[0], f[1]), float_min(f[2], f[3])); }

static const Extent NOWHERE = {INFINITY, -INFINITY, INFINITY, -INFINITY, -INFINITY};

static Extent extent_of_some(const BeamMesh *mesh, float *least_key) {
    Extent e = NOWHERE;
    *least_key = INFINITY;
    for (int i = 0; i < mesh->count; i++)
        for (int k = 0; k < 3; k++) {
            const int at = mesh->triangles[mesh->which[i]][k];
            e.left = float_min(e.left, mesh->x[at]), e.right = float_max(e.right, mesh->x[at]);
            e.top = float_min(e.top, mesh->y[at]), e.bottom = float_max(e.bottom, mesh->y[at]);
            e.key = float_max(e.key, mesh->key[at]), *least_key = float_min(*least_key, mesh->key[at]);
        }
    return e;
}

/* The same of all corners: the greatest of each as the least of its negative. */
static Extent extent_of_all(const BeamMesh *mesh, float *least_key) {
    const float end = INFINITY;
    Floats left = {end, end, end, end}, right = left, top = left, bottom = left, key = left, least = left;
    for (int i = 0; i < mesh->corners; i += BEAM_LANES) {
        const int from = int_min(i, mesh->corners - BEAM_LANES);
        const Floats x = floats_at(mesh->x + from), y = floats_at(mesh->y + from), k = floats_at(mesh->key + from);
        left = lesser(left, x), right = lesser(right, -x), top = lesser(top, y), bottom = lesser(bottom, -y), key = lesser(key, -k), least = lesser(least, k);
    }
    *least_key = least_of(least);
    return (Extent){least_of(left), -least_of(right), least_of(top), -least_of(bottom), -least_of(key)};
}

static Extent extent_of(const BeamMesh *mesh) {
    float least_key;
    const Extent e = mesh->corners >= BEAM_LANES ? extent_of_all(mesh, &least_key) : extent_of_some(mesh, &least_key);
    return (Extent){e.left - CORNER_SLACK, e.right + CORNER_SLACK, e.top - CORNER_SLACK, e.bottom + CORNER_SLACK,
                    e.key + 3 * KEY_SLACK * float_max(fabsf(e.key), fabsf(least_key))};
}

/* The key at which the sample sees the triangle before what it has seen; false where it does not. */
static bool passes(const Beam *beam, const BeamMesh *mesh, int triangle, uint32_t sample, float *key) {
    const BeamSamples *s = &beam->samples;
    const uint8_t *at = mesh->triangles[triangle];
    Vec3f corners[3];
    Triangle t;
    for (int k = 0; k < 3; k++) corners[k] = vec3f(mesh->x[at[k]], mesh->y[at[k]], mesh->key[at[k]]);
    if (!set_up(corners, &t)) return false;
    const float dx = s->x[sample] - t.x, dy = s->y[sample] - t.y, e1 = t.a1 * dx + t.b1 * dy, e2 = t.a2 * dx + t.b2 * dy;
    if (!(e1 >= 0 && e2 >= 0 && e1 + e2 <= 1)) return false;
    const float k = t.key + (t.key_x * dx + t.key_y * dy), most = beam->perspective ? INFINITY : (float)beam->nearest;
    if (!(k > *key && k <= most && (beam->light ? beam->exact_to : k * beam->exact_to) >= s->limit[sample])) return false;
    *key = k;
    return true;
}

/* The nearest of the mesh's triangles that the sample sees, or just one that hides it from a light; -1: none. */
static int nearest_of(const Beam *beam, const BeamMesh *mesh, const Outlines *o, uint32_t sample) {
    const BeamSamples *s = &beam->samples;
    const float x = s->x[sample], y = s->y[sample];
    int nearest = -1;
    for (int i = 0; i < mesh->count; i += BEAM_LANES) {
        Masks in = (floats_at(o->left + i) <= x) & (floats_at(o->right + i) >= x) & (floats_at(o->top + i) <= y) & (floats_at(o->bottom + i) >= y) &
                   (floats_at(o->key + i) > s->key[sample]);
        if (!any_of(in)) continue;
        for (int k = 0; k < BEAM_LANES; k++) {
            float key = s->key[sample];
            if (!in[k] || !passes(beam, mesh, mesh->which[i + k], sample, &key)) continue;
            nearest = mesh->which[i + k];
            if (beam->light) return nearest;
            s->key[sample] = key;
        }
    }
    return nearest;
}

/* The samples that the mesh may be seen by; returns how many, -1 if there are more samples in the bins that it meets than few. */
static int samples_before(const Beam *beam, const BeamMesh *mesh, uint32_t at[BEAM_FEW_SAMPLES]) {
    const BeamSamples *s = &beam->samples;
    const Extent e = extent_of(mesh);
    if (!(e.right >= 0 && e.left <= (float)s->columns && e.bottom >= 0 && e.top <= (float)s->rows)) return 0;
    const int x0 = bin_below(e.left, s->columns - 1), x1 = bin_below(e.right, s->columns - 1);
    const int y0 = bin_below(e.top, s->rows - 1), y1 = bin_below(e.bottom, s->rows - 1);
    uint32_t all = 0;
    int count = 0;
    for (int row = y0; row <= y1; row++) all += s->first[row * s->columns + x1 + 1] - s->first[row * s->columns + x0];
    if (all > BEAM_FEW_SAMPLES) return -1;
    for (int row = y0; row <= y1; row++)
        for (uint32_t i = s->first[row * s->columns + x0], end = s->first[row * s->columns + x1 + 1]; i < end; i++)
            if (s->key[i] < e.key && s->x[i] >= e.left && s->x[i] <= e.right && s->y[i] >= e.top && s->y[i] <= e.bottom && !(beam->light && s->mark[i]))
                at[count++] = i;
    return count;
}

int beam_draw_mesh(Beam *beam, const BeamMesh *mesh, BeamSeen seen[BEAM_FEW_SAMPLES]) {
    uint32_t at[BEAM_FEW_SAMPLES];
    const int before = samples_before(beam, mesh, at);
    if (before <= 0) return before;
    Outlines o;
    outline(mesh, &o);
    int count = 0;
    for (int i = 0; i < before; i++) {
        const int triangle = nearest_of(beam, mesh, &o, at[i]);
        if (triangle < 0) continue;
        if (beam->light) beam->samples.mark[at[i]] = 1;
        else seen[count++] = (BeamSeen){at[i], (uint8_t)triangle};
    }
    return count;
}

/* The part with q.z >= nearest. */
static int clip_near(const Vec3f *in, int count, float nearest, Vec3f *out) {
    int kept = 0;
    for (int i = 0; i < count; i++) {
        Vec3f a = in[i], b = in[(i + 1) % count];
        if (a.z >= nearest) out[kept++] = a;
        if ((a.z >= nearest) != (b.z >= nearest)) {
            float t = (nearest - a.z) / (b.z - a.z);
            out[kept++] = vec3f(a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), nearest);
        }
    }
    return kept;
}

bool beam_draw(Beam *beam, const Vec3f *corners, int count, uint32_t mark) {
    Vec3f clipped[MOST_CORNERS + 1], seen[MOST_CORNERS + 1];
    if (beam->perspective) {
        float nearest = (float)beam->nearest;
        bool clip = false;
        for (int i = 0; i < count; i++) clip |= !(corners[i].z >= nearest);
        if (clip) {
            count = clip_near(corners, count, nearest, clipped);
            corners = clipped;
        }
        for (int i = 0; i < count; i++) {
            float key = 1 / corners[i].z;
            seen[i] = vec3f(corners[i].x * key, corners[i].y * key, key);
        }
        corners = seen;
    }
    bool any = false;
    for (int i = 2; i < count; i++) any |= beam_draw_seen(beam, corners[0], corners[i - 1], corners[i], mark);
    return any;
}
