#include "render/volume_light.h"

#include "render/integrate.h"
#include "render/volume_published.h"
#include "render/volume_shoot.h"

/* ---- spherical harmonics ---- */

void volume_harmonics(Vec3 d, int count, double out[VOLUME_HARMONICS]) {
    out[0] = 0.28209479177387814;
    if (count == 1) return;
    static const double first = 0.48860251190291992, mixed = 1.0925484305920792;
    out[1] = first * d.x, out[2] = first * d.y, out[3] = first * d.z;
    out[4] = mixed * d.x * d.y, out[5] = mixed * d.y * d.z, out[6] = mixed * d.x * d.z;
    out[7] = 0.31539156525252001 * (3 * d.z * d.z - 1);
    out[8] = 0.54627421529603959 * (d.x * d.x - d.y * d.y);
}

/* ---- lamps ---- */

enum { LEAST_LAMP_CELLS = 40, MOST_LAMP_CELLS = 160, MOST_FINER_LAMP_CELLS = 128, LAMP_PLACES = 3 };
/* Thicker than this nothing is told apart. */
static const double MOST_DEPTH = 80;

/* The eight nodes, or bins, around a place, and their weights. */
typedef struct Corners {
    size_t at[8];
    double weight[8];
} Corners;

/* Nodes of a lattice of `cells` over the unit cube. */
static Corners corners_of(const int cells[3], Vec3 unit) {
    Corners out;
    int first[3];
    double t[3];
    for (int k = 0; k < 3; k++) {
        double x = double_clamp(vec3_get(unit, k), 0, 1) * cells[k];
        first[k] = double_to_int(x, 0, cells[k] - 1);
        t[k] = x - first[k];
    }
    for (int corner = 0; corner < 8; corner++) {
        size_t index = 0;
        out.weight[corner] = 1;
        for (int k = 2; k >= 0; k--) {
            int far = corner >> k & 1;
            index = index * (size_t)(cells[k] + 1) + (size_t)(first[k] + far);
            out.weight[corner] *= far ? t[k] : 1 - t[k];
        }
        out.at[corner] = index;
    }
    return out;
}

/* Then depths are asked for as fast as nodes are, without their error: where borders are round, depths between nodes are too small. */
static bool is_even(const CompiledVolume *v) { return v->body && v->lattice.size[0] * v->lattice.size[1] * v->lattice.size[2] == 1; }

Vec3f volume_lamp(const CompiledVolume *v, SurfaceTracer *tracer, size_t l, const LightRay *way, Vec3 unit,
                  Vec3 point) {
    const VolumeLight *light = v->light;
    const Corners c = corners_of(light->cells, unit);
    const uint8_t *states = light->states + l * light->nodes;
    const float(*depths)[3] = (const float(*)[3])light->depths + l * light->nodes;
    const Light *lamp = &tracer->compiled->scene->lights[l];
    uint8_t state = states[c.at[0]];
    double depth[3] = {0, 0, 0};
    for (int i = 0; i < 8; i++) {
        if (states[c.at[i]] != state) state = LIGHT_PARTLY;
        for (int k = 0; k < 3; k++) depth[k] += c.weight[i] * (double)depths[c.at[i]][k];
    }
    if (state == LIGHT_HIDDEN) return vec3f(0, 0, 0);
    Vec3f through = vec3f((float)exp(-depth[0]), (float)exp(-depth[1]), (float)exp(-depth[2]));
    if (is_even(v) && !light_is_area(lamp) && !lamp->shadowless) through = volumes_passing_thinned(tracer->compiled->volumes, &(Ray){point, way->direction}, way->distance);
    if (state == LIGHT_SEEN) return through;
    Leg leg;
    surface_leg(&(Cone){point, way->direction, 0, 0}, &leg);
    SurfaceTracer past = *tracer;
    past.no_volumes = true;
    return vec3f_mul(through, surface_shadow(&past, lamp, way, &leg, point, 0, random_hash(l, 0x6c, 0, 0)));
}

typedef struct LampFill {
    CompiledScene *compiled;
    CompiledVolume *volume;
    Tracer **tracers;
    size_t light;
    float (*depths)[3]; /* at nodes */
} LampFill;

static void fill_node(const LampFill *f, SurfaceTracer *tracer, Vec3 point, float depth[3], uint8_t *state) {
    const CompiledScene *compiled = f->compiled;
    const Light *lamp = &compiled->scene->lights[f->light];
    int across = light_is_area(lamp) ? LAMP_PLACES : 1;
    double through[3] = {0, 0, 0}, hidden = 0, whole = 0;
    SurfaceTracer past = *tracer;
    past.no_volumes = true;
    for (int i = 0; i < across * across; i++) {
        LightRay way = across > 1 ? light_ray_from(lamp, point,
                                                   light_place(lamp, point, (i % across + 0.5) / across,
                                                               (i / across + 0.5) / across))
                                  : light_ray(lamp, point);
        const Ray ray = {point, way.direction};
        Leg leg;
        surface_leg(&(Cone){point, way.direction, 0, 0}, &leg);
        Vec3f share = surface_shadow_way(&past, lamp, &way, &leg, point, 0);
        Vec3f passed = lamp->shadowless
                           ? vec3f(1, 1, 1)
                           : volumes_passing(compiled->volumes, &ray, 0, way.distance, RAY_MIRRORS);
        hidden += share.x <= 0 && share.y <= 0 && share.z <= 0;
        whole += share.x == 1 && share.y == 1 && share.z == 1;
        through[0] += (double)passed.x, through[1] += (double)passed.y, through[2] += (double)passed.z;
    }
    int places = across * across;
    *state = hidden == places ? LIGHT_HIDDEN : whole == places ? LIGHT_SEEN : LIGHT_PARTLY;
    for (int c = 0; c < 3; c++) depth[c] = (float)double_clamp(-log(through[c] / places), 0, MOST_DEPTH);
}

Vec3 volume_point(const CompiledVolume *v, Vec3 unit) {
    const int *n = v->lattice.size;
    Vec3 cells = vec3(unit.x * n[0] + 0.5, unit.y * n[1] + 0.5, unit.z * n[2] + 0.5);
    return mat3_apply(&v->from_cells, vec3_sub(cells, v->to_cells.offset));
}

static void fill_lamp_row(void *context, size_t row, int worker) {
    const LampFill *f = context;
    const VolumeLight *light = f->volume->light;
    const int *n = light->cells;
    size_t base = f->light * light->nodes + row * (size_t)(n[0] + 1);
    SurfaceTracer tracer = tracer_of_surfaces(f->tracers[worker]);
    int y = (int)(row % (size_t)(n[1] + 1)), z = (int)(row / (size_t)(n[1] + 1));
    for (int x = 0; x <= n[0]; x++) {
        Vec3 point = volume_point(f->volume, vec3((double)x / n[0], (double)y / n[1], (double)z / n[2]));
        fill_node(f, &tracer, point, f->depths[row * (size_t)(n[0] + 1) + (size_t)x], &light->states[base + (size_t)x]);
    }
}

/* Depths begin as parabolas where light enters: linear between nodes they would be too large on the mean, by a twelfth of second differences, and clouds of fine cells too dark by 1 %.
 * What is kept is less by that. */
static void level_row(void *context, size_t row, int worker) {
    const LampFill *f = context;
    const VolumeLight *light = f->volume->light;
    const int *n = light->cells;
    const size_t width = (size_t)(n[0] + 1), strides[3] = {1, width, width * (size_t)(n[1] + 1)};
    const int at[3] = {0, (int)(row % (size_t)(n[1] + 1)), (int)(row / (size_t)(n[1] + 1))};
    (void)worker;
    for (int x = 0; x <= n[0]; x++) {
        const size_t i = row * width + (size_t)x;
        for (int c = 0; c < 3; c++) {
            const float here = f->depths[i][c];
            float bend = 0;
            for (int k = 0; k < 3; k++) {
                const int along = k ? at[k] : x;
                if (along > 0 && along < n[k]) bend += f->depths[i - strides[k]][c] - 2 * here + f->depths[i + strides[k]][c];
            }
            light->depths[f->light * light->nodes + i][c] = float_max(0, here - bend / 12);
        }
    }
}

/* ---- making ready ---- */

enum { LEAST_ACROSS = 6, MOST_ACROSS = 64 };

/* Cells as cubic as may be, `longest` of them along the longest side; but across what is flat as many as its optical depth asks for, and `fineness` times as many. */
static void divide(const CompiledVolume *v, int longest, double fineness, int out[3]) {
    double sides[3],
        most = 0,
        extinction = double_max(v->extinction[0], double_max(v->extinction[1], v->extinction[2])) *
                     lattice_mean(&v->lattice);
    for (int k = 0; k < 3; k++) {
        sides[k] = vec3_length(v->from_cells.c[k]) * v->lattice.size[k];
        most = double_max(most, sides[k]);
    }
    for (int k = 0; k < 3; k++) {
        int least = (int)double_clamp(4 * fineness * extinction * sides[k], LEAST_ACROSS, MOST_ACROSS);
        out[k] = int_clamp((int)ceil(longest * sides[k] / most - 1e-6), least, longest);
    }
}

static int longest_of(const Lattice *lattice) {
    return int_max(lattice->size[0], int_max(lattice->size[1], lattice->size[2]));
}

static bool light_lamps(CompiledScene *compiled, CompiledVolume *v, Tracer **tracers) {
    VolumeLight *light = v->light;
    const double fineness = compiled->volumes->fineness;
    size_t lamps = compiled->scene->light_count;
    const int longest = int_clamp(longest_of(&v->lattice), LEAST_LAMP_CELLS, MOST_LAMP_CELLS);
    /* Many lamps share the room that one may take. */
    const double most = MOST_FINER_LAMP_CELLS / cbrt((double)(lamps > 0 ? lamps : 1));
    divide(v, int_max(longest, double_to_int(fmin(fineness * longest, most), 0, MOST_FINER_LAMP_CELLS)), fineness, light->cells);
    light->nodes =
        (size_t)(light->cells[0] + 1) * (size_t)(light->cells[1] + 1) * (size_t)(light->cells[2] + 1);
    light->depths = arena_push_array_(compiled->arena, lamps * light->nodes + 1, sizeof *light->depths);
    light->states = arena_new_array(compiled->arena, uint8_t, lamps * light->nodes + 1);
    ArenaMark mark = arena_mark(&compiled->scratch);
    float(*depths)[3] = arena_push_array_(&compiled->scratch, light->nodes, sizeof *depths);
    const size_t rows = (size_t)(light->cells[1] + 1) * (size_t)(light->cells[2] + 1);
    bool done = true;
    for (size_t l = 0; l < lamps && done; l++) {
        LampFill fill = {compiled, v, tracers, l, depths};
        done = pool_run(compiled->options->pool, rows, fill_lamp_row, &fill) && pool_run(compiled->options->pool, rows, level_row, &fill);
    }
    arena_reset_to(&compiled->scratch, mark);
    return done;
}

enum { LEAST_BINS = 24, MOST_BINS = 40, MOST_FINER_BINS = 64 };

static void make_bins(CompiledScene *compiled, CompiledVolume *v) {
    VolumeLight *light = v->light;
    bool even = fabs(v->moments[1]) < 1e-3 && fabs(v->moments[2]) < 1e-3;
    divide(v, double_to_int(compiled->volumes->fineness * int_clamp(longest_of(&v->lattice), LEAST_BINS, MOST_BINS), 0, MOST_FINER_BINS), compiled->volumes->fineness, light->bins);
    size_t bins = volume_bins(light);
    light->harmonics = even || v->volume->storage == VOLUME_STORAGE_ISOTROPIC ? 1 : VOLUME_HARMONICS;
    light->kept = arena_push_array_(compiled->arena, bins * (size_t)light->harmonics, sizeof *light->kept);
    light->source =
        arena_push_array_(&compiled->scratch, bins * (size_t)light->harmonics, sizeof *light->source);
    light->again = arena_push_array_(&compiled->scratch, bins * (size_t)light->harmonics, sizeof *light->again);
    light->density = arena_new_array(compiled->arena, float, bins);
}

static bool light_set(CompiledScene *compiled, VolumeSet *set) {
    int workers = pool_threads(compiled->options->pool);
    Tracer **tracers = arena_new_array(compiled->arena, Tracer *, (size_t)workers);
    for (int i = 0; i < workers; i++) {
        tracers[i] = arena_new(compiled->arena, Tracer);
        tracer_init(tracers[i], compiled, compiled->arena);
    }
    for (size_t i = 0; i < set->count; i++) {
        set->items[i].light = arena_new(compiled->arena, VolumeLight);
        if (!light_lamps(compiled, &set->items[i], tracers)) return false;
    }
    if (set->orders == 1 && !set->sky) return true;
    ArenaMark mark = arena_mark(&compiled->scratch);
    for (size_t i = 0; i < set->count; i++) make_bins(compiled, &set->items[i]);
    bool done = volumes_shoot(compiled, tracers) && volumes_look_around(compiled, tracers);
    arena_reset_to(&compiled->scratch, mark);
    return done;
}

/* Light that is kept in so few bins does not know finer cells than this, but would go through all of them: for the light pass great grids have fewer. */
enum { LIGHT_CELLS = 96 };

static void coarsen(CompiledVolume *v, Arena *arena) {
    const Lattice fine = v->lattice;
    int size[3];
    double widths[3];
    for (int k = 0; k < 3; k++) {
        int cells = int_max(1, fine.size[k] / LIGHT_CELLS);
        size[k] = (fine.size[k] + cells - 1) / cells;
        widths[k] = (double)fine.size[k] / size[k];
    }
    if (size[0] == fine.size[0] && size[1] == fine.size[1] && size[2] == fine.size[2]) return;
    lattice_coarsen(&v->lattice, &fine, size, arena);
    Transform shift = transform_translate(vec3_splat(-0.5)), scale = transform_scale(vec3(1 / widths[0], 1 / widths[1], 1 / widths[2])), back = transform_translate(vec3_splat(0.5));
    Transform all = transform_then(&shift, &scale);
    all = transform_then(&all, &back);
    v->to_cells.offset = transform_point(&all, v->to_cells.offset);
    for (int k = 0; k < 3; k++) {
        v->to_cells.linear.c[k] = transform_vector(&all, v->to_cells.linear.c[k]);
        v->from_cells.c[k] = vec3_scale(v->from_cells.c[k], widths[k]);
    }
}

bool volumes_light(CompiledScene *compiled) {
    VolumeSet *set = compiled->volumes;
    if (set->method == VOLUME_PATH) return true;
    if (set->method == VOLUME_PUBLISHED) return volumes_light_published(compiled);
    VolumeSet *smooth = volumes_without_peaks(set, compiled->arena);
    ArenaMark mark = arena_mark(&compiled->scratch);
    for (size_t i = 0; i < smooth->count; i++) coarsen(&smooth->items[i], &compiled->scratch);
    compiled->volumes = smooth;
    bool done = light_set(compiled, smooth);
    compiled->volumes = set;
    arena_reset_to(&compiled->scratch, mark);
    for (size_t i = 0; i < set->count; i++) set->items[i].light = smooth->items[i].light;
    return done;
}

/* ---- asking ---- */

/* The eight bins around a place. Bins have their light in their middles; beyond the outermost it goes on as it went, where the density there is even
 * enough for that. */
static Corners bins_around(const VolumeLight *light, Vec3 unit) {
    Corners out;
    int first[3];
    double t[3];
    for (int k = 0; k < 3; k++) {
        double x = double_clamp(vec3_get(unit, k), 0, 1) * light->bins[k] - 0.5;
        first[k] = double_to_int(x, 0, light->bins[k] - 2);
        t[k] = x - first[k];
    }
    float least = INFINITY, most = 0;
    for (int corner = 0; corner < 8; corner++) {
        size_t index = 0;
        for (int k = 2; k >= 0; k--)
            index = index * (size_t)light->bins[k] + (size_t)(first[k] + (corner >> k & 1));
        out.at[corner] = index;
        least = float_min(least, light->density[index]), most = float_max(most, light->density[index]);
    }
    bool even = least > 0.5f * most;
    for (int corner = 0; corner < 8; corner++) {
        out.weight[corner] = 1;
        for (int k = 0; k < 3; k++) {
            double far = even ? t[k] : double_clamp(t[k], 0, 1);
            out.weight[corner] *= corner >> k & 1 ? far : 1 - far;
        }
    }
    return out;
}

bool volume_bin_is_even(const VolumeLight *light, const int at[3]) {
    float least = INFINITY, most = 0;
    for (int i = 0; i < 27; i++) {
        const int step[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
        size_t index = 0;
        for (int k = 2; k >= 0; k--) index = index * (size_t)light->bins[k] + (size_t)int_clamp(at[k] + step[k], 0, light->bins[k] - 1);
        least = float_min(least, light->density[index]), most = float_max(most, light->density[index]);
    }
    return least > 0.5f * most;
}

Vec3f volume_kept(const CompiledVolume *v, Vec3 unit, const double shape[VOLUME_HARMONICS]) {
    const VolumeLight *light = v->light;
    double sum[3] = {0, 0, 0}, matter = 0;
    if (!light->kept) return vec3f(0, 0, 0);
    const Corners around = bins_around(light, unit);
    for (int corner = 0; corner < 8; corner++) {
        size_t index = around.at[corner];
        const float(*kept)[3] = (const float(*)[3])light->kept + index * (size_t)light->harmonics;
        double weight = around.weight[corner] * (double)light->density[index];
        matter += weight;
        for (int i = 0; i < light->harmonics; i++)
            for (int c = 0; c < 3; c++) sum[c] += weight * shape[i] * (double)kept[i][c];
    }
    if (!(matter > 0)) return vec3f(0, 0, 0);
    return vec3f((float)double_max(0, sum[0] / matter), (float)double_max(0, sum[1] / matter),
                 (float)double_max(0, sum[2] / matter));
}
