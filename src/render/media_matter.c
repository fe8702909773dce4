/* Media along a ray: where they are, how dense, and how far apart places may be that tell what is between them. */
#include "render/media.h"

#include "pattern/pattern.h"
#include "scene/medium.h"

/* ---- density ---- */

static Vec3 point_at(const Ray *ray, double t) { return vec3_madd(ray->origin, ray->direction, t); }
static Vec3 rgb(Color c) { return vec3(c.red, c.green, c.blue); }

static Vec3 pattern_density(const MediumDensity *density, Vec3 point) {
    Color c = pigment_color(density->pattern, transform_point_back(&density->place, point), vec3(0, 0, 0), 0);
    return vec3_is_finite(rgb(c)) ? rgb(c) : vec3(0, 0, 0);
}

Vec3 medium_density(const MediumSite *site, double t) {
    const Medium *m = site->medium;
    Vec3 product = {1, 1, 1};
    if (t < site->t0 || t > site->t1) return vec3(0, 0, 0);
    for (size_t i = 0; i < m->density_count; i++) product = vec3_mul(product, pattern_density(&m->densities[i], point_at(&site->ray, t)));
    return product;
}

Vec3 media_extinction(const MediaMatter *matter, double t) {
    Vec3 sum = {0, 0, 0};
    for (int i = 0; i < matter->count; i++) {
        const Medium *m = matter->sites[i].medium;
        Vec3 per = vec3_madd(rgb(m->absorption), rgb(m->scattering), m->loss);
        if (per.x == 0 && per.y == 0 && per.z == 0) continue;
        sum = vec3_add(sum, vec3_mul(per, medium_density(&matter->sites[i], t)));
    }
    return sum;
}

/* ---- where there is something ---- */

/* Patterns whose value is that of the far away but for a box of their space; turbulence carries places so far. */
static bool pattern_box(const Pigment *p, Box3 *box) {
    double far = VTS_INFINITY, turbulence = 0, grown;
    switch (p->kind) {
    case PATTERN_SPHERICAL: *box = (Box3){vec3_splat(-1), vec3_splat(1)}; break;
    case PATTERN_CYLINDRICAL: *box = (Box3){vec3(-1, -far, -1), vec3(1, far, 1)}; break;
    case PATTERN_BOXED: *box = (Box3){vec3_splat(-1), vec3_splat(1)}; break;
    case PATTERN_PLANAR: *box = (Box3){vec3(-far, -1, -far), vec3(far, 1, far)}; break;
    case PATTERN_DENSITY: *box = (Box3){vec3_splat(0), vec3_splat(1)}; break;
    default: return false;
    }
    if (p->warp_count) return false;
    turbulence = double_max(fabs(p->turbulence.x), double_max(fabs(p->turbulence.y), fabs(p->turbulence.z)));
    grown = turbulence * double_min(p->octaves, fabs(p->omega) < 0.9 ? 1 / (1 - fabs(p->omega)) : 10);
    *box = (Box3){vec3_sub(box->min, vec3_splat(grown)), vec3_add(box->max, vec3_splat(grown))};
    return true;
}

/* The ray in the pattern's space. */
static Ray ray_in_pattern(const MediumDensity *density, const Ray *ray) {
    const Transform all = transform_then(&density->pattern->transform, &density->place);
    return (Ray){transform_point_back(&all, ray->origin), transform_vector_back(&all, ray->direction)};
}

/* A place that no box of a pattern holds, unless it has no end there. */
static bool is_nothing_far_away(const MediumDensity *density) {
    const Transform *own = &density->pattern->transform;
    Vec3 far = transform_point(own, vec3(1e7, 1.1e7, 1.2e7)), here = pattern_density(density, transform_point(&density->place, far));
    return here.x == 0 && here.y == 0 && here.z == 0;
}

static void clip_to_pattern(const MediumDensity *density, MediumSite *site) {
    Box3 box;
    if (!pattern_box(density->pattern, &box) || !is_nothing_far_away(density)) return;
    const Ray ray = ray_in_pattern(density, &site->ray);
    if (!box3_clip_ray(box, &ray, &site->t0, &site->t1)) site->t1 = site->t0;
}

/* ---- how it changes ---- */

/* The length in a pattern's own space over which it is told by a few places. */
static double pattern_feature(const Pigment *p) {
    double feature = 0.5;
    if (p->kind == PATTERN_SOLID) return VTS_INFINITY;
    if (p->kind == PATTERN_DENSITY && p->density) {
        const int *n = p->density->size;
        feature = 2.0 / double_max(1, int_max(n[0], int_max(n[1], n[2])));
    }
    if (p->kind == PATTERN_GRANITE || p->kind == PATTERN_FUNCTION) feature = 0.25;
    if (vec3_length_squared(p->turbulence) > 0 || p->warp_count) feature /= 2;
    return feature / double_max(1, fabs(p->frequency));
}

/* The finest of a pattern and the maps in it. */
static double stride_in(const Pigment *p, double scale, int depth) {
    double stride = pattern_feature(p) * scale;
    for (size_t i = 0; i < p->entry_count && depth > 0; i++)
        if (p->entries[i].pigment) {
            const Transform *t = &p->entries[i].pigment->transform;
            double longest = double_max(vec3_length(t->linear.c[0]), double_max(vec3_length(t->linear.c[1]), vec3_length(t->linear.c[2])));
            stride = double_min(stride, stride_in(p->entries[i].pigment, scale * longest, depth - 1));
        }
    return stride;
}

static double density_stride(const MediumDensity *density, const Ray *ray) {
    enum { DEEP_ENOUGH = 4 };
    double speed = vec3_length(ray_in_pattern(density, ray).direction);
    double stride = stride_in(density->pattern, 1, DEEP_ENOUGH);
    return speed > 0 && isfinite(speed) ? stride / speed : VTS_INFINITY;
}

/* ---- all media of a ray ---- */

void media_matter_begin(MediaMatter *matter, double t0, double t1) {
    matter->count = 0;
    matter->t0 = t0;
    matter->t1 = t1;
}

static bool is_black(Color c) { return c.red == 0 && c.green == 0 && c.blue == 0; }

void media_matter_add(MediaMatter *matter, const MediaList *media, const Affine *to_space, const Ray *ray) {
    for (size_t i = 0; i < media->count && matter->count < MEDIA_MOST_SITES; i++) {
        const Medium *m = &media->items[i];
        if (is_black(m->absorption) && is_black(m->emission) && is_black(m->scattering)) continue;
        MediumSite site = {.medium = m, .ray = *ray, .t0 = matter->t0, .t1 = matter->t1, .stride = VTS_INFINITY};
        if (to_space)
            site.ray = (Ray){vec3_add(mat3_apply(&to_space->linear, ray->origin), to_space->offset), mat3_apply(&to_space->linear, ray->direction)};
        for (size_t k = 0; k < m->density_count && site.t0 < site.t1; k++) {
            clip_to_pattern(&m->densities[k], &site);
            site.stride = double_min(site.stride, density_stride(&m->densities[k], &site.ray));
        }
        if (site.t0 < site.t1) matter->sites[matter->count++] = site;
    }
}

/* ---- stops ---- */

static int put(double *stops, int count, double t) {
    if (count >= MEDIA_MOST_STOPS) return count;
    int i = count;
    for (; i > 0 && stops[i - 1] > t; i--) stops[i] = stops[i - 1];
    stops[i] = t;
    return count + 1;
}

/* The finest of the media that are there. */
static double stride_at(const MediaMatter *matter, double t) {
    double stride = VTS_INFINITY;
    for (int i = 0; i < matter->count; i++)
        if (t >= matter->sites[i].t0 && t < matter->sites[i].t1) stride = double_min(stride, matter->sites[i].stride);
    return stride;
}

/* Far away steps grow with the distance, so that a way without end has few. */
enum { FIXED_STOPS = 2 * MEDIA_MOST_SITES + 64 };
static const double GROWTH = 0.08;

int media_stops(const MediaMatter *matter, const double *extra, int extra_count, double stops[MEDIA_MOST_STOPS]) {
    double fixed[FIXED_STOPS];
    int fixed_count = 0, count = 0;
    double begin = VTS_INFINITY, end = -VTS_INFINITY;
    for (int i = 0; i < matter->count; i++) begin = double_min(begin, matter->sites[i].t0), end = double_max(end, matter->sites[i].t1);
    if (!(begin < end)) return 0;
    for (int i = 0; i < matter->count && fixed_count + 2 <= FIXED_STOPS; i++)
        fixed[fixed_count++] = matter->sites[i].t0, fixed[fixed_count++] = matter->sites[i].t1;
    for (int i = 0; i < extra_count && fixed_count < FIXED_STOPS; i++)
        if (extra[i] > begin && extra[i] < end) fixed[fixed_count++] = extra[i];
    for (int i = 0; i < fixed_count; i++) count = put(stops, count, fixed[i]);
    if (count < 2) return 0;
    double sorted[FIXED_STOPS];
    for (int i = 0; i < count; i++) sorted[i] = stops[i];
    int pieces = count - 1;
    count = 0;
    stops[count++] = sorted[0];
    for (int i = 0; i < pieces; i++) {
        double t0 = sorted[i], t1 = sorted[i + 1], stride = stride_at(matter, (t0 + t1) / 2);
        if (!(t1 - t0 > 1e-12 * (1 + fabs(t1)))) continue;
        double least = (t1 - t0) / 256; /* of one piece there are no more */
        for (double t = t0; t < t1 && count < MEDIA_MOST_STOPS - 1;) {
            double step = double_max(double_max(stride, least), GROWTH * (t - matter->t0));
            double left = t1 - t;
            int steps = (int)double_clamp(ceil(left / step - 1e-9), 1, 1e6);
            t = steps == 1 ? t1 : t + left / steps;
            stops[count++] = t;
        }
        if (count >= MEDIA_MOST_STOPS - 1) break;
    }
    stops[count - 1] = double_max(stops[count - 1], end);
    return count;
}
