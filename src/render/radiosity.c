#include "render/radiosity.h"

#include "base/random.h"

#include <float.h>

/* ---- gathering ---- */

/* Light changes within a part of the mean distance of what is met (the harmonic mean); of the whole hemisphere or of little of it, that by this
 * power matters less. (Ward's own measure, the mean over all directions, is power 1: it misses what stands aside before an open sky.) */
static const double FEW_MET = 0.15;

typedef struct Hemisphere {
    Vec3 up, across, along;
    RadiosityNet net;
    Vec3f light[RADIOSITY_MOST_ROWS][RADIOSITY_MOST_COLUMNS];
    double near[RADIOSITY_MOST_ROWS][RADIOSITY_MOST_COLUMNS]; /* 1 through the distance */
} Hemisphere;

static Vec3 around(const Hemisphere *h, double turn) {
    return vec3_add(vec3_scale(h->across, cos(turn)), vec3_scale(h->along, sin(turn)));
}

static Vec3f softened(const Radiosity *settings, Vec3f c) {
    float most = float_max(c.x, float_max(c.y, c.z));
    if (settings->max_sample > 0 && (double)most > settings->max_sample)
        return vec3f_scale(c, (float)settings->max_sample / most);
    return c;
}

/* Light from one direction, and one through how far away that is. */
static Vec3f light_from(SurfaceTracer *tracer, const RadiosityPlace *place, Vec3 direction, double spread,
                        double *near) {
    const CompiledScene *compiled = tracer->compiled;
    SurfaceTracer asker = {
        .compiled = compiled, .counters = tracer->counters, .seed = tracer->seed, .asks = tracer->asks};
    const Cone cone = {place->point, direction, 0, spread};
    const Ray ray = {place->point, direction};
    Leg leg;
    SurfaceHit hit;
    *near = 0;
    if (!hierarchy_meet_wide(compiled->hierarchy, RAY_GATHERS, &ray, cone_width(&cone), place->clear,
                             VTS_INFINITY, false, &hit))
        return softened(&compiled->scene->settings.radiosity,
                        sky_radiance(compiled->scene, direction, spread));
    *near = 1 / fmax(hit.t, 1e-12);
    surface_eye_leg(compiled, &cone, &leg);
    leg.purpose = RAY_GATHERS;
    leg.gathers = place->gathers + 1;
    leg.weight = 0.25f; /* one of many */
    tracer->counters->camera_rays++;
    return softened(&compiled->scene->settings.radiosity, surface_radiance(&asker, &leg, &hit));
}

/* Light from a field of the net, one of parts × parts of it, and one through how far away that is. */
static Vec3f light_in(SurfaceTracer *tracer, const RadiosityPlace *place, const Hemisphere *h, int row, int column, int parts, int part,
                      uint64_t seed, double *near) {
    const RadiosityNet net = h->net;
    uint64_t own = random_mix(seed + (uint64_t)(row * net.columns + column) + ((uint64_t)part << 32));
    double area = (row + (part / parts + random_unit(own)) / parts) / net.rows,
           turn = 2 * VTS_PI * (column + (part % parts + random_unit(random_mix(own))) / parts) / net.columns;
    Vec3 d = vec3_madd(vec3_scale(around(h, turn), sqrt(area)), h->up, sqrt(1 - area));
    *near = 0;
    if (!(vec3_dot(d, place->flat) > 0)) return vec3f(0, 0, 0);
    tracer->seed = own;
    return light_from(tracer, place, d, sqrt(2 * VTS_PI / (net.rows * net.columns)) / parts, near);
}

/* The largest difference between the light of fields around one. Not that of its own: what was met by chance would then be looked at again, and
 * what was missed by chance would not, so that small lights were too dark. */
static float contrast_around(const Hemisphere *h, int row, int column) {
    const int columns = h->net.columns;
    Vec3f least = {FLT_MAX, FLT_MAX, FLT_MAX}, most = {0, 0, 0};
    for (int down = -1; down <= 1; down++)
        for (int right = -1; right <= 1; right++) {
            const int j = row + down, k = (column + right + columns) % columns;
            if ((!down && !right) || j < 0 || j >= h->net.rows) continue;
            const Vec3f c = h->light[j][k];
            least = vec3f(float_min(least.x, c.x), float_min(least.y, c.y), float_min(least.z, c.z));
            most = vec3f(float_max(most.x, c.x), float_max(most.y, c.y), float_max(most.z, c.z));
        }
    return float_max(most.x - least.x, float_max(most.y - least.y, most.z - least.z));
}

/* Fields at the border of something bright, a window, are asked in so many parts each way, where one ray for all of a field would be seen to be
 * wrong by more than this part of the error that is accepted. */
enum { PARTS = 3 };
static const double SEEN_TO_BE_WRONG = 0.5;

static void look_closer(SurfaceTracer *tracer, const RadiosityPlace *place, uint64_t seed, Hemisphere *h) {
    const double each = (double)place->worth / (h->net.rows * h->net.columns), accepted = SEEN_TO_BE_WRONG * tracer->compiled->max_error;
    bool split[RADIOSITY_MOST_ROWS][RADIOSITY_MOST_COLUMNS];
    for (int j = 0; j < h->net.rows; j++)
        for (int k = 0; k < h->net.columns; k++) split[j][k] = (double)contrast_around(h, j, k) * each > accepted;
    for (int j = 0; j < h->net.rows; j++)
        for (int k = 0; k < h->net.columns; k++) {
            if (!split[j][k]) continue;
            Vec3f light = {0, 0, 0};
            double sum = 0, near;
            for (int part = 0; part < PARTS * PARTS; part++) {
                light = vec3f_add(light, light_in(tracer, place, h, j, k, PARTS, part, random_mix(seed), &near));
                sum += near;
            }
            h->light[j][k] = vec3f_scale(light, 1.0f / (PARTS * PARTS));
            h->near[j][k] = sum / (PARTS * PARTS);
        }
}

static void look_around(SurfaceTracer *tracer, const RadiosityPlace *place, uint64_t seed, Hemisphere *h) {
    for (int j = 0; j < h->net.rows; j++)
        for (int k = 0; k < h->net.columns; k++) h->light[j][k] = light_in(tracer, place, h, j, k, 1, 0, seed, &h->near[j][k]);
    look_closer(tracer, place, seed, h);
}

static float channel(Vec3f c, int i) { return i == 0 ? c.x : i == 1 ? c.y : c.z; }

/* Ward & Heckbert 1992, for light through pi. */
static void gradients(const Hemisphere *h, int c, RadiosityEntry *entry) {
    int rows = h->net.rows, columns = h->net.columns;
    Vec3 turning = vec3_splat(0), moving = vec3_splat(0);
    for (int k = 0; k < columns; k++) {
        int before = (k + columns - 1) % columns;
        double turn = 2 * VTS_PI * (k + 0.5) / columns, across = 0, outward = 0, sideways = 0;
        for (int j = 0; j < rows; j++) {
            double value = (double)channel(h->light[j][k], c), low = sqrt((double)j / rows),
                   high = sqrt((j + 1.0) / rows), middle = (j + 0.5) / rows;
            across -= sqrt(middle / (1 - middle)) * value;
            sideways += (high - low) * fmax(h->near[j][k], h->near[j][before]) *
                        (value - (double)channel(h->light[j][before], c));
            if (j > 0)
                outward += low * (1 - low * low) * fmax(h->near[j][k], h->near[j - 1][k]) *
                           (value - (double)channel(h->light[j - 1][k], c));
        }
        turning = vec3_madd(turning, around(h, turn + VTS_PI / 2), across / (rows * columns));
        moving = vec3_madd(moving, around(h, turn), outward * 2 / columns);
        moving = vec3_madd(moving, around(h, turn - VTS_PI / columns + VTS_PI / 2), sideways / VTS_PI);
    }
    entry->turning[c] = turning;
    entry->moving[c] = moving;
}

void radiosity_gather(SurfaceTracer *tracer, const RadiosityPlace *place, RadiosityNet net, uint64_t seed,
                      RadiosityEntry *entry) {
    const Radiosity *settings = &tracer->compiled->scene->settings.radiosity;
    Hemisphere h;
    uint64_t own = tracer->seed;
    h.up = place->normal, h.net = net;
    vec3_frame(h.up, &h.across, &h.along);
    look_around(tracer, place, seed, &h);
    tracer->seed = own;
    Vec3f sum = {0, 0, 0};
    double near = 0, met = 0;
    for (int j = 0; j < net.rows; j++)
        for (int k = 0; k < net.columns; k++) sum = vec3f_add(sum, h.light[j][k]), near += h.near[j][k], met += h.near[j][k] > 0;
    float each = 1 / (float)(net.rows * net.columns), bright = (float)settings->brightness,
          grey = (float)settings->gray_threshold;
    float mean = grey * (0.297f * sum.x + 0.589f * sum.y + 0.114f * sum.z);
    *entry = (RadiosityEntry){.point = place->point,
                              .normal = place->normal,
                              .radius = met > 0 ? met / near * pow((double)each * met, -FEW_MET) : VTS_INFINITY};
    for (int c = 0; c < 3; c++) {
        entry->light[c] = bright * each * ((1 - grey) * channel(sum, c) + mean);
        gradients(&h, c, entry);
        double kept = settings->brightness * (1 - settings->gray_threshold);
        entry->turning[c] = vec3_scale(entry->turning[c], kept);
        entry->moving[c] = vec3_scale(entry->moving[c], kept);
    }
}

/* ---- blending ---- */

typedef struct Blend {
    const RadiosityEntries *entries;
    Vec3 point, normal;
    double most, weight;
    double light[3];
} Blend;

static bool add_entry(void *context, uint32_t item) {
    Blend *b = context;
    const RadiosityEntry *e = &b->entries->items[item];
    Vec3 from = vec3_sub(b->point, e->point);
    double together = vec3_dot(b->normal, e->normal);
    double wrong = vec3_length(from) / e->radius + 2 * sqrt(fmax(0, 1 - together));
    if (!(wrong < b->most)) return false;
    if (vec3_dot(from, vec3_add(b->normal, e->normal)) < -0.1 * e->radius)
        return false; /* the place lies behind it */
    double weight = 1 / fmax(wrong, 1e-4) - 1 / b->most;
    Vec3 turned = vec3_cross(e->normal, b->normal);
    for (int c = 0; c < 3; c++) {
        double change = vec3_dot(turned, e->turning[c]) + vec3_dot(from, e->moving[c]),
               light = (double)e->light[c];
        b->light[c] +=
            weight * (light + double_clamp(change, -0.5 * light,
                                           0.5 * light)); /* what would change more is not known so far */
    }
    b->weight += weight;
    return false;
}

double radiosity_blend(const RadiosityEntries *entries, Vec3 point, Vec3 normal, double part, Vec3f *light) {
    Blend b = {.entries = entries, .point = point, .normal = normal, .most = part * entries->reach};
    *light = vec3f(0, 0, 0);
    if (!entries->tree) return 0;
    box_tree_point(entries->tree, point, add_entry, &b);
    if (b.weight > 0)
        *light = vec3f((float)(b.light[0] / b.weight), (float)(b.light[1] / b.weight),
                       (float)(b.light[2] / b.weight));
    return b.weight;
}

/* ---- light at a place ---- */

/* Where nothing was gathered near to a place that the eye sees, and to one that is seen from others. */
static const RadiosityNet SEEN_NET = {5, 14}, OTHERS_NET = {2, 5};
/* What lies in balls counts; where there is none, what is near to some. */
static const double NEAR = 1 / RADIOSITY_REACH;

static Vec3f gathered_here(SurfaceTracer *tracer, const RadiosityPlace *place, RadiosityNet net,
                           uint64_t seed) {
    RadiosityEntry entry;
    radiosity_gather(tracer, place, net, seed, &entry);
    return vec3f(entry.light[0], entry.light[1], entry.light[2]);
}

Vec3f radiosity_light(SurfaceTracer *tracer, const RadiosityPlace *place, uint64_t seed) {
    const RadiosityKept *kept = tracer->compiled->radiosity;
    int bounces = tracer->compiled->scene->settings.radiosity.bounces;
    Vec3f light = {0, 0, 0};
    if (tracer->asks) {
        if (tracer->asks->count < tracer->asks->most) tracer->asks->places[tracer->asks->count++] = *place;
        return light;
    }
    if (place->gathers >= bounces) return light;
    bool seen = place->gathers == 0;
    if (seen && radiosity_blend(&kept->seen, place->point, place->normal, NEAR, &light) > 0) return light;
    if (radiosity_blend(seen ? &kept->seen : &kept->others, place->point, place->normal, 1, &light) > 0)
        return light;
    if (!seen && !kept->others_known) return light;
    RadiosityPlace last = *place;
    if (!seen) last.gathers = bounces - 1; /* of what comes there it sees the first bounce alone */
    return gathered_here(tracer, &last, seen ? SEEN_NET : OTHERS_NET, random_mix(seed + 0x7261));
}
