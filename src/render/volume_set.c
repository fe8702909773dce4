#include "render/volume_set.h"

#include "base/random.h"
#include "render/media.h"
#include "render/volume_published.h"
#include "scene/scene_bounds.h"
#include "volume/field.h"

#include <string.h>

/* ---- along rays ---- */

static Vec3 to_cells(const CompiledVolume *v, Vec3 p) { return vec3_add(mat3_apply(&v->to_cells.linear, p), v->to_cells.offset); }

Ray volume_ray_in_cells(const CompiledVolume *v, const Ray *ray) {
    return (Ray){to_cells(v, ray->origin), mat3_apply(&v->to_cells.linear, ray->direction)};
}

static bool in_lattice(const CompiledVolume *v, const Ray *cells, double *t0, double *t1) {
    const int *n = v->lattice.size;
    Box3 box = {vec3_splat(0.5), vec3(n[0] + 0.5, n[1] + 0.5, n[2] + 0.5)};
    return box3_clip_ray(box, cells, t0, t1) && *t0 < *t1;
}

static int spans_of_body(const CompiledVolume *v, const Ray *ray, double t0, double t1, VolumeSpan *spans) {
    enum { MOST_PIECES = 256 };
    Ray own = {transform_point_back(&v->body_place, ray->origin), transform_vector_back(&v->body_place, ray->direction)};
    int count = 0;
    double from = t0, clear = 1e-9 * (fabs(t0) + fabs(t1));
    for (int i = 0; i < MOST_PIECES && from < t1; i++) {
        BodyHit hit;
        double to = body_meet(v->body, v->container, &own, from + clear, t1, &hit) ? hit.t : t1;
        bool inside = body_inside(v->body, vec3_madd(own.origin, own.direction, (from + to) / 2));
        if (inside && count && spans[count - 1].t1 >= from) spans[count - 1].t1 = to;
        else if (inside && count < VOLUME_MOST_SPANS) spans[count++] = (VolumeSpan){from, to};
        from = to;
    }
    return count;
}

int volume_spans(const CompiledVolume *v, const Ray *ray, double t0, double t1, VolumeSpan spans[VOLUME_MOST_SPANS]) {
    Ray cells = volume_ray_in_cells(v, ray);
    if (!in_lattice(v, &cells, &t0, &t1)) return 0;
    if (v->body) return spans_of_body(v, ray, t0, t1, spans);
    spans[0] = (VolumeSpan){t0, t1};
    return 1;
}

static double length_in(const CompiledVolume *v, const Lattice *lattice, const Ray *ray, double t0, double t1) {
    VolumeSpan spans[VOLUME_MOST_SPANS];
    int count = volume_spans(v, ray, t0, t1, spans);
    Ray cells = volume_ray_in_cells(v, ray);
    double sum = 0;
    for (int i = 0; i < count; i++) {
        LatticeWalk walk;
        LatticePiece piece;
        lattice_walk_begin(&walk, lattice, &cells, spans[i].t0, spans[i].t1);
        while (lattice_walk_next(&walk, &piece)) sum += piece.length;
    }
    return sum;
}

double volume_length(const CompiledVolume *v, const Ray *ray, double t0, double t1) { return length_in(v, &v->lattice, ray, t0, t1); }

double volume_whole_length(const CompiledVolume *v, const Ray *ray, double t0, double t1) { return length_in(v, v->dense ? v->dense : &v->lattice, ray, t0, t1); }

bool volume_reach(const CompiledVolume *v, const Ray *ray, double t0, double t1, double length, double *t) {
    VolumeSpan spans[VOLUME_MOST_SPANS];
    int count = volume_spans(v, ray, t0, t1, spans);
    Ray cells = volume_ray_in_cells(v, ray);
    for (int i = 0; i < count; i++) {
        LatticeWalk walk;
        LatticePiece piece;
        lattice_walk_begin(&walk, &v->lattice, &cells, spans[i].t0, spans[i].t1);
        while (lattice_walk_next(&walk, &piece)) {
            if (length < piece.length) {
                *t = lattice_piece_invert(&walk, &piece, length);
                return true;
            }
            length -= piece.length;
        }
    }
    return false;
}

static Vec3f share_passing(const VolumeSet *set, const Ray *ray, double t0, double t1, RayPurpose purpose, bool thinned) {
    double depth[3] = {0, 0, 0}, near = t0, far = t1;
    if (!box3_clip_ray(set->bounds, ray, &near, &far)) return vec3f(1, 1, 1);
    for (size_t i = 0; i < set->count; i++) {
        const CompiledVolume *v = &set->items[i];
        if (!volume_counts(v, purpose)) continue;
        double length = thinned ? volume_length(v, ray, t0, t1) : volume_whole_length(v, ray, t0, t1);
        for (int c = 0; c < 3; c++) depth[c] += length * (thinned ? v->thinned : v->extinction)[c];
    }
    return vec3f((float)exp(-depth[0]), (float)exp(-depth[1]), (float)exp(-depth[2]));
}

Vec3f volumes_passing(const VolumeSet *set, const Ray *ray, double t0, double t1, RayPurpose purpose) { return share_passing(set, ray, t0, t1, purpose, false); }

Vec3f volumes_passing_thinned(const VolumeSet *set, const Ray *ray, double t1) { return share_passing(set, ray, 0, t1, RAY_MIRRORS, true); }

/* ---- making ready ---- */

enum { AUTO_CELLS = 64 };
static const double MOST_CELLS = 16e6;

typedef struct VolumeBuild {
    CompiledScene *compiled;
    DiagList *diags;
    ShapeTracer *shapes;
    struct {
        CompiledVolume *items;
        size_t count, capacity;
    } list;
    const Object *object;
} VolumeBuild;

/* The unit cube → the box that is filled, in the volume's space. */
static Transform cube_to_box(Vec3 a, Vec3 b) {
    Vec3 low = vec3_min(a, b), size = vec3_sub(vec3_max(a, b), low);
    Transform scale = transform_scale(size), shift = transform_translate(low);
    return transform_then(&scale, &shift);
}

/* How many of a grid's cells a side of the volume's cube needs: where it is cut out of a greater grid, twice those that it goes through,
 * for they need not begin where the grid's do. */
static int cells_along(const DensityField *field, const Transform *local, int side) {
    const Pigment *p = field->pattern;
    const DensityGrid *grid = p->density;
    if (p->warp_count || vec3_length_squared(p->turbulence) > 0) return grid->size[side];
    Vec3 way = transform_vector_back(&p->transform, field->in_bounds ? vec3(side == 0, side == 1, side == 2) : local->linear.c[side]);
    double met = vec3_length(vec3(way.x * grid->size[0], way.y * grid->size[1], way.z * grid->size[2]));
    return 2 * met < grid->size[side] ? int_max(1, (int)ceil(2 * met)) : grid->size[side];
}

/* Sides in scene units. */
static void choose_cells(const Volume *volume, const Transform *cube, const Transform *local, int size[3]) {
    const DensityField *field = volume->density;
    double sides[3], longest = 0, total = 1;
    for (int k = 0; k < 3; k++) {
        sides[k] = vec3_length(cube->linear.c[k]);
        longest = double_max(longest, sides[k]);
    }
    double step = volume->step > 0 ? volume->step : longest / AUTO_CELLS;
    for (int k = 0; k < 3; k++) total *= double_max(1, sides[k] / step);
    if (total > MOST_CELLS) step *= cbrt(total / MOST_CELLS);
    for (int k = 0; k < 3; k++) {
        size[k] = int_clamp((int)ceil(double_min(sides[k] / step, 4096) - 1e-9), 1, 4096);
        if (field->pattern->density && volume->step <= 0) size[k] = int_max(size[k], int_min(cells_along(field, local, k), 512));
    }
}

static void fill_from_grid(const DensityField *field, const DensityGrid *grid, Lattice *lattice, Arena *arena) {
    const float *number = grid->values;
    lattice_init(lattice, grid->size, arena);
    for (int z = 0; z < grid->size[2]; z++)
        for (int y = 0; y < grid->size[1]; y++)
            for (int x = 0; x < grid->size[0]; x++) lattice_set(lattice, x, y, z, (float)field_of_number(field, (double)*number++));
}

/* Many numbers, rows of which are taken by workers. */
typedef struct FieldFill {
    const DensityField *field;
    const Transform *cube; /* unit cube → the space that the density stands in; NULL: it is that */
    Lattice *lattice;
} FieldFill;

static void fill_row(void *context, size_t row, int worker) {
    FieldFill *f = context;
    (void)worker;
    const int *n = f->lattice->size;
    int y = (int)(row % (size_t)n[1]), z = (int)(row / (size_t)n[1]);
    for (int x = 0; x < n[0]; x++) {
        Vec3 p = vec3((x + 0.5) / n[0], (y + 0.5) / n[1], (z + 0.5) / n[2]);
        double value = field_density(f->field, f->cube ? transform_point(f->cube, p) : p);
        lattice_set(f->lattice, x, y, z, value > 0 ? (float)double_min(value, 1e30) : 0);
    }
}

static void fill_from_field(VolumeBuild *b, const Volume *volume, const Transform *cube, const Transform *local, Lattice *lattice) {
    const DensityField *field = volume->density;
    int size[3];
    choose_cells(volume, cube, local, size);
    lattice_init(lattice, size, b->compiled->arena);
    FieldFill fill = {.field = field, .cube = field->in_bounds ? NULL : local, .lattice = lattice};
    pool_run(b->compiled->options->pool, (size_t)size[1] * (size_t)size[2], fill_row, &fill);
}

/* One number everywhere needs but one cell. */
static void simplify(Lattice *lattice, Arena *arena) {
    size_t count = (size_t)lattice->nodes[0] * (size_t)lattice->nodes[1] * (size_t)lattice->nodes[2];
    for (size_t i = 1; i < count; i++)
        if (lattice->values[i] != lattice->values[0]) return;
    float value = lattice->values[0];
    lattice_init(lattice, (int[3]){1, 1, 1}, arena);
    lattice_set(lattice, 0, 0, 0, value);
    lattice_finish(lattice);
}

static void fill(VolumeBuild *b, const Volume *volume, const Transform *cube, const Transform *local, Lattice *lattice) {
    const DensityGrid *grid = NULL;
    Arena *arena = b->compiled->arena;
    if (!volume->density) {
        lattice_init(lattice, (int[3]){1, 1, 1}, arena);
        lattice_set(lattice, 0, 0, 0, 1);
    } else if (field_is_grid(volume->density, &grid)) {
        fill_from_grid(volume->density, grid, lattice, arena);
    } else {
        fill_from_field(b, volume, cube, local, lattice);
    }
    lattice_finish(lattice);
    if (volume->method != VOLUME_PUBLISHED) simplify(lattice, arena); /* which stores light in the density's cells */
}

static void channels(Color c, double out[3]) { out[0] = c.red, out[1] = c.green, out[2] = c.blue; }

static bool is_empty(const CompiledVolume *v) { return !(v->lattice.most > 0) || v->extinction[0] + v->extinction[1] + v->extinction[2] <= 0; }

static void add_volume(VolumeBuild *b, const Object *object, const Transform *to_scene) {
    const Volume *volume = object->as.volume;
    const Object *container = volume->container;
    Transform own = object_transform(container), body_place = transform_then(&own, to_scene), cube, local;
    CompiledVolume v = {.volume = volume, .container = container, .body_place = body_place, .casts = !object->no_shadow, .seen = !object->no_image};
    if (volume->density && volume->density->unmodelled) return;
    if (container->kind == OBJECT_BOX && !container->rest && !container->inverse) {
        local = cube_to_box(container->as.box.corner1, container->as.box.corner2);
        local = transform_then(&local, &own);
    } else {
        v.body = body_of(b->shapes, container);
        Box3 box = v.body ? box3_transform(&own, body_bounds(v.body)) : box3_empty();
        if (box3_is_empty(box) || !vec3_is_finite(box.min) || !vec3_is_finite(box.max)) {
            diag_error(b->diags, volume->span, "what this volume fills has no bounds");
            return;
        }
        local = cube_to_box(box.min, box.max);
    }
    cube = transform_then(&local, to_scene);
    if (transform_is_singular(&cube)) return; /* flat: there is nothing in it */
    fill(b, volume, &cube, &local, &v.lattice);
    channels(volume->scattering, v.scattering);
    channels(volume->absorption, v.absorption);
    for (int c = 0; c < 3; c++) v.extinction[c] = v.scattering[c] + v.absorption[c];
    if (is_empty(&v)) return;
    v.phase = volume->phase;
    phase_moments(&v.phase, v.moments);
    const int *n = v.lattice.size;
    Transform scale = transform_scale(vec3(n[0], n[1], n[2])), shift = transform_translate(vec3_splat(0.5)), back = transform_inverse(&cube);
    Transform cells = transform_then(&back, &scale);
    cells = transform_then(&cells, &shift);
    v.to_cells = (Affine){cells.linear, cells.offset};
    v.from_cells = cells.inverse_linear;
    v.bounds = box3_transform(&cube, (Box3){vec3_splat(0), vec3_splat(1)});
    *list_push(b->compiled->arena, &b->list) = v;
}

static void find_volumes(VolumeBuild *b, const Object *object, const Transform *parent) {
    if (object_has_group(object) && object->as.group->plain) return;
    Transform own = object_transform(object), to_scene = transform_then(&own, parent);
    if (object->kind == OBJECT_VOLUME) add_volume(b, object, &to_scene);
    if (object->kind == OBJECT_UNION || object->kind == OBJECT_MERGE)
        for (size_t i = 0; i < object->as.group->count; i++) find_volumes(b, object->as.group->items[i], &to_scene);
}

static VolumeMethod method_of(const VolumeSet *set) {
    VolumeMethod method = VOLUME_TWO_PASS;
    for (size_t i = 0; i < set->count; i++)
        if (set->items[i].volume->method > method) method = set->items[i].volume->method;
    return method;
}

static int orders_of(const VolumeSet *set) {
    int most = 1;
    for (size_t i = 0; i < set->count; i++) {
        if (set->items[i].volume->orders == 0) return 0;
        most = int_max(most, set->items[i].volume->orders);
    }
    return most;
}

/* What harmonics of low degrees cannot have, and delta-M passes over only forwards, and only where turns are not counted: paths can. */
static const double MOST_COUNTED_PEAK = 0.2, MOST_BACKWARD_PEAK = 0.3;

static bool needs_paths(const VolumeSet *set) {
    if (set->orders == 1 && !set->sky) return false;
    for (size_t i = 0; i < set->count; i++) {
        const CompiledVolume *v = &set->items[i];
        if (v->moments[3] < -MOST_BACKWARD_PEAK || (set->orders && v->moments[3] > MOST_COUNTED_PEAK)) return true;
    }
    return false;
}

/* What is left of a volume without the peak. Where orders are counted, none is passed over. */
static CompiledVolume without_peak(const CompiledVolume *v, bool counted) {
    CompiledVolume out = *v;
    out.dense = NULL;
    double peak = counted ? 0 : phase_without_peak(&v->phase, &out.phase);
    for (int c = 0; c < 3; c++) {
        out.scattering[c] -= peak * v->scattering[c];
        out.thinned[c] = out.extinction[c] = out.scattering[c] + v->absorption[c];
    }
    phase_moments(&out.phase, out.moments);
    double thinned = out.thinned[0] + out.thinned[1] + out.thinned[2];
    out.peak_share = thinned > 0 ? peak * (v->scattering[0] + v->scattering[1] + v->scattering[2]) / thinned : 0;
    return out;
}

VolumeSet *volumes_without_peaks(const VolumeSet *set, Arena *arena) {
    VolumeSet *out = arena_copy(arena, set, sizeof *set);
    out->items = arena_copy(arena, set->items, set->count * sizeof *set->items);
    for (size_t i = 0; i < set->count; i++) out->items[i] = without_peak(&set->items[i], set->orders != 0);
    return out;
}

static void see_peak(CompiledVolume *v, bool counted, Arena *arena) {
    const CompiledVolume rest = without_peak(v, counted);
    Phase unused;
    memcpy(v->thinned, rest.thinned, sizeof v->thinned);
    v->peak_share = rest.peak_share;
    v->spread = v->peak_share > 0 ? phase_spread_make(&v->phase, &rest.phase, phase_without_peak(&v->phase, &unused), arena) : NULL;
}

/* Bins, nodes and steps that do for the error of a picture that is looked at are what is left of it however many rays there are: where less is asked for they are finer. */
static const double PLAIN_ERROR = 1.0 / 255, MOST_FINENESS = 3;

static double fineness_of(double max_error) { return double_clamp(sqrt(PLAIN_ERROR / max_error), 1, MOST_FINENESS); }

bool volumes_compile(CompiledScene *compiled, DiagList *diags) {
    VolumeBuild b = {.compiled = compiled, .diags = diags, .shapes = shape_tracer_create(compiled->arena)};
    size_t errors = diags->error_count;
    Transform identity = transform_identity();
    for (size_t i = 0; i < compiled->scene->object_count; i++) find_volumes(&b, compiled->scene->objects[i], &identity);
    if (diags->error_count > errors) return false;
    if (!b.list.count) return true;
    VolumeSet *set = arena_new(compiled->arena, VolumeSet);
    *set = (VolumeSet){.items = b.list.items, .count = b.list.count, .bounds = box3_empty(), .sky = compiled->scene->settings.sky_light};
    for (size_t i = 0; i < set->count; i++) set->bounds = box3_union(set->bounds, set->items[i].bounds);
    set->method = compiled->options->exact ? VOLUME_PATH : method_of(set);
    set->orders = orders_of(set);
    set->fineness = fineness_of(compiled->max_error);
    set->rays_are_paths = set->method == VOLUME_PATH;
    if (set->method == VOLUME_TWO_PASS && needs_paths(set)) set->method = VOLUME_PATH;
    if (set->method == VOLUME_TWO_PASS) volumes_cap(set, compiled->arena);
    if (set->method == VOLUME_PUBLISHED) volumes_publish(set);
    else
        for (size_t i = 0; i < set->count; i++) see_peak(&set->items[i], set->orders != 0, compiled->arena);
    compiled->volumes = set;
    return true;
}

/* ---- as air ---- */

/* In the place of two passes there are more: what is dim must not look even because no path met anything. */
enum { PATHS_AUTO = 8, PATHS_INSTEAD = 32, MOST_PATHS = 4096 };

static double rays_of(const VolumeSet *set) {
    double rays = 0;
    for (size_t i = 0; i < set->count; i++) rays = double_max(rays, set->items[i].volume->rays);
    return rays;
}

static Air path_air(SurfaceTracer *tracer, const Cone *cone, double t_max, double *mean_t) {
    const CompiledScene *compiled = tracer->compiled;
    const VolumeSet *set = compiled->volumes;
    const Ray ray = {cone->origin, cone->direction};
    double wanted = set->rays_are_paths ? rays_of(set) : PATHS_INSTEAD, near = 0, far = t_max;
    int paths = compiled->exact_paths ? 1 : wanted > 0 ? (int)double_clamp(wanted, 1, MOST_PATHS) : PATHS_AUTO;
    Air air = {volumes_passing(set, &ray, 0, t_max, RAY_SEES), {0, 0, 0}, 0};
    box3_clip_ray(set->bounds, &ray, &near, &far);
    *mean_t = isfinite(far) ? (near + far) / 2 : near;
    for (int i = 0; i < paths; i++)
        air.add = vec3f_madd(air.add, volumes_path(tracer, &ray, t_max, random_hash(tracer->seed, (uint64_t)i, 0x766f, 0)), 1 / (float)paths);
    return air;
}

static Air volumes_alone(SurfaceTracer *tracer, const Cone *cone, double t_max, double *mean_t) {
    const VolumeSet *set = tracer->compiled->volumes;
    const Ray ray = {cone->origin, cone->direction};
    double near = 0, far = t_max;
    Air air = air_clear();
    *mean_t = 0;
    if (!set || !box3_clip_ray(set->bounds, &ray, &near, &far)) return air;
    if (set->method == VOLUME_PATH) air = path_air(tracer, cone, t_max, mean_t);
    else if (set->method == VOLUME_PUBLISHED) air = volumes_gather_published(tracer, cone, t_max, mean_t);
    else air = volumes_gather(tracer, cone, t_max, mean_t);
    air.cover = 1 - (air.keep.x + air.keep.y + air.keep.z) / 3;
    return air;
}

Air volumes_air(SurfaceTracer *tracer, const Cone *cone, double t_max) {
    double mean_t;
    return volumes_alone(tracer, cone, t_max, &mean_t);
}

/* `over` before what lies farther. */
static Air air_laid(const Air *over, const Air *under) {
    return (Air){vec3f_mul(over->keep, under->keep), vec3f_add(over->add, vec3f_mul(over->keep, under->add)), 1 - (1 - over->cover) * (1 - under->cover)};
}

/* Fog before the volumes lies over their light too. */
static Air volumes_in_fog(SurfaceTracer *tracer, const Cone *cone, double t_max, bool fog) {
    const Scene *scene = tracer->compiled->scene;
    const Ray ray = {cone->origin, cone->direction};
    const Air nothing = air_clear();
    Air far = fog ? air_between(scene, &ray, t_max) : nothing;
    if (!tracer->compiled->volumes) return far;
    double mean_t;
    Air volumes = volumes_alone(tracer, cone, t_max, &mean_t);
    if (!(volumes.cover > 0) && !(volumes.add.x + volumes.add.y + volumes.add.z > 0)) return far;
    Air near = fog ? air_between(scene, &ray, mean_t) : nothing;
    Vec3f keep = volumes.keep, rest = vec3f_sub(vec3f(1, 1, 1), keep);
    Air out = {.keep = vec3f_mul(far.keep, keep), .add = vec3f_mul(far.add, keep), .cover = volumes.cover};
    out.add = vec3f_add(out.add, vec3f_add(vec3f_mul(volumes.add, near.keep), vec3f_mul(near.add, rest)));
    return out;
}

bool air_is_clear(const CompiledScene *compiled) {
    const Scene *scene = compiled->scene;
    return !compiled->volumes && !scene->has_media && scene->fog_count == 0 && scene->rainbow_count == 0;
}

/* As POV-Ray has it, fogs lie before media. */
Air air_along(SurfaceTracer *tracer, const Leg *leg, double t_max) {
    if (air_is_clear(tracer->compiled)) return air_clear();
    Air air = volumes_in_fog(tracer, &leg->cone, t_max, surface_in_air(leg->enclosures, leg->enclosure_count));
    if (!tracer->compiled->scene->has_media) return air;
    const Air media = media_air(tracer, leg, t_max);
    return air_laid(&air, &media);
}

Air air_from_eye(SurfaceTracer *tracer, const Cone *cone, double t_max) {
    if (air_is_clear(tracer->compiled)) return air_clear();
    Leg leg;
    surface_eye_leg(tracer->compiled, cone, &leg);
    return air_along(tracer, &leg, t_max);
}
