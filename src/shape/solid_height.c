/* height_field: two triangles between each four neighbouring heights, over the unit square of x and z. */
#include "image/image.h"
#include "image/palette.h"
#include "shape/box_tree.h"
#include "shape/solid.h"
#include "shape/solid_parts.h"

enum { BLOCK = 8 }; /* cells along a side of what the tree knows as one */

typedef struct Field {
    const float *heights;
    uint32_t columns, rows, block_columns; /* points; blocks */
    double water_level;
    bool smooth;
    const BoxTree *tree;
    Box3 bounds;
} Field;

static double height_at(const Field *f, uint32_t i, uint32_t j) {
    return (double)f->heights[(size_t)j * f->columns + i];
}

static Vec3 point_at(const Field *f, uint32_t i, uint32_t j) {
    return vec3((double)i / (f->columns - 1), height_at(f, i, j), (double)j / (f->rows - 1));
}

/* Heights are kept as POV-Ray keeps them, in 65536 steps. */
static float quantize(double height) { return (float)(floor(double_clamp(height, 0, 1) * 65535) / 65536); }

static bool copy_heights(const Solid *s, Arena *arena, Field *f) {
    f->columns = (uint32_t)s->as.field.columns;
    f->rows = (uint32_t)s->as.field.rows;
    float *heights = arena_new_array(arena, float, (size_t)f->columns * f->rows);
    for (size_t i = 0; i < (size_t)f->columns * f->rows; i++) heights[i] = quantize(s->as.field.heights[i]);
    f->heights = heights;
    return true;
}

/* In the picture's codes. */
static double code_at(const Image *image, bool potential, uint32_t i, uint32_t j) {
    const float *pixel = image_pixel(image, (int)i, (int)j);
    if (potential) return 256 * (double)pixel[0] + (double)image_pixel(image, (int)i + image->width / 2, (int)j)[0];
    if (image->channels < 3) return (double)pixel[0];
    return 0.297 * (double)pixel[0] + 0.589 * (double)pixel[1] + 0.114 * (double)pixel[2];
}

/* The picture's upper border lies at z = 1. */
static bool load_heights(const Solid *s, Arena *arena, Field *f) {
    Image image;
    StrBuf error = {0};
    bool ok = image_load(&image, s->as.field.path, IMAGE_AS_STORED, arena->budget, &error);
    strbuf_free(&error);
    if (!ok) return false;
    Palette palette;
    if (palette_read(s->as.field.path, &palette)) palette_index(&palette, &image);
    const bool potential = s->as.field.potential && image.stored_as == IMAGE_SAMPLE_U8;
    double most = potential ? 65535 : image.stored_as == IMAGE_SAMPLE_U8 ? 255 : image.stored_as == IMAGE_SAMPLE_U16 ? 65535 : 1;
    f->columns = (uint32_t)(potential ? image.width / 2 : image.width);
    f->rows = (uint32_t)image.height;
    if (f->columns >= 2 && f->rows >= 2) {
        float *heights = arena_new_array(arena, float, (size_t)f->columns * f->rows);
        for (uint32_t j = 0; j < f->rows; j++)
            for (uint32_t i = 0; i < f->columns; i++)
                heights[(size_t)(f->rows - 1 - j) * f->columns + i] = quantize(code_at(&image, potential, i, j) / most);
        f->heights = heights;
    }
    image_free(&image);
    return f->heights != NULL;
}

static Box3 block_box(const Field *f, uint32_t bi, uint32_t bj) {
    Box3 box = box3_empty();
    for (uint32_t j = bj * BLOCK; j <= bj * BLOCK + BLOCK && j < f->rows; j++)
        for (uint32_t i = bi * BLOCK; i <= bi * BLOCK + BLOCK && i < f->columns; i++)
            box = box3_add_point(box, point_at(f, i, j));
    return box;
}

static const void *prepare(const Object *object, Arena *arena) {
    const Solid *s = object->as.solid;
    Field *f = arena_new(arena, Field);
    f->water_level = s->as.field.water_level;
    f->smooth = s->as.field.smooth;
    if (!(s->as.field.path ? load_heights : copy_heights)(s, arena, f)) return NULL;
    f->block_columns = (f->columns - 2) / BLOCK + 1;
    uint32_t block_rows = (f->rows - 2) / BLOCK + 1;
    Box3 *boxes = arena_new_array(arena, Box3, (size_t)f->block_columns * block_rows);
    f->bounds = box3_empty();
    for (uint32_t j = 0; j < block_rows; j++)
        for (uint32_t i = 0; i < f->block_columns; i++) {
            Box3 box = block_box(f, i, j);
            if (box.max.y >= f->water_level)
                boxes[j * f->block_columns + i] = box;
            else
                boxes[j * f->block_columns + i] = box3_empty();
            f->bounds = box3_union(f->bounds, box);
        }
    f->bounds.min.y = double_max(f->bounds.min.y, f->water_level);
    f->tree = box_tree_build(boxes, (size_t)f->block_columns * block_rows, arena);
    return f;
}

/* An axis of the ray, in cells (of heights: as they are). Sections are wider than they should be by far more than rounding. */
typedef struct Along {
    double origin, direction, slack;
} Along;

typedef struct FieldVisit {
    const Field *field;
    const Ray *ray;
    SolidSink *sink;
    Along x, y, z;
} FieldVisit;

/* The triangle a, b, c by signed volumes; neighbours agree about their common edge. */
static void try_triangle(const FieldVisit *visit, const Vec3 corners[3], uint32_t cell, double half) {
    Vec3 a = vec3_sub(corners[0], visit->ray->origin), b = vec3_sub(corners[1], visit->ray->origin),
         c = vec3_sub(corners[2], visit->ray->origin);
    Vec3 d = visit->ray->direction;
    double bc = vec3_dot(d, vec3_cross(b, c)), ca = vec3_dot(d, vec3_cross(c, a)),
           ab = vec3_dot(d, vec3_cross(a, b));
    if ((bc < 0 || ca < 0 || ab < 0) && (bc > 0 || ca > 0 || ab > 0)) return;
    Vec3 normal = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
    double t = vec3_dot(normal, a) / vec3_dot(normal, d);
    if (bc + ca + ab == 0 || !isfinite(t) || visit->ray->origin.y + t * d.y < visit->field->water_level)
        return;
    solid_offer(visit->sink, t, (SolidTag){cell, half, 0});
}

static void try_cell(const FieldVisit *visit, uint32_t i, uint32_t j) {
    const Field *f = visit->field;
    Vec3 p00 = point_at(f, i, j), p10 = point_at(f, i + 1, j), p01 = point_at(f, i, j + 1), p11 = point_at(f, i + 1, j + 1);
    try_triangle(visit, (Vec3[]){p00, p10, p01}, j * f->columns + i, 0);
    try_triangle(visit, (Vec3[]){p11, p01, p10}, j * f->columns + i, 1);
}

static Along along(double origin, double direction, double cells) {
    return (Along){origin * cells, direction * cells, 1e-9 * (1 + fabs(origin * cells))};
}

typedef struct Section {
    double near, far;
} Section;

/* The part of the section where the ray is between lo and hi; empty where near > far. */
static Section section_between(const Along *a, double lo, double hi, Section s) {
    lo -= a->slack, hi += a->slack;
    if (a->direction == 0) return a->origin >= lo && a->origin <= hi ? s : (Section){1, 0};
    double t0 = (lo - a->origin) / a->direction, t1 = (hi - a->origin) / a->direction;
    return (Section){double_max(s.near, double_min(t0, t1)), double_min(s.far, double_max(t0, t1))};
}

/* What the ray passes of the axis on the section. */
static void passed_on(const Along *a, Section s, double *lo, double *hi) {
    double x0 = a->direction == 0 ? a->origin : a->origin + a->direction * s.near,
           x1 = a->direction == 0 ? a->origin : a->origin + a->direction * s.far;
    *lo = double_min(x0, x1) - a->slack, *hi = double_max(x0, x1) + a->slack;
}

static bool is_passed(const FieldVisit *visit, uint32_t i, uint32_t j, Section s) {
    double lo, hi;
    const float *a = visit->field->heights + (size_t)j * visit->field->columns + i, *b = a + visit->field->columns;
    passed_on(&visit->y, s, &lo, &hi);
    float least = float_min(float_min(a[0], a[1]), float_min(b[0], b[1])), most = float_max(float_max(a[0], a[1]), float_max(b[0], b[1]));
    return !(lo > (double)most || hi < (double)least);
}

/* Of the block's cells only those under and over which the ray goes, and which are as high. */
static void visit_block(void *context, uint32_t block) {
    const FieldVisit *visit = context;
    const Field *f = visit->field;
    uint32_t i0 = block % f->block_columns * BLOCK, j0 = block / f->block_columns * BLOCK;
    uint32_t i1 = i0 + BLOCK < f->columns - 1 ? i0 + BLOCK : f->columns - 1, j1 = j0 + BLOCK < f->rows - 1 ? j0 + BLOCK : f->rows - 1;
    Section whole = section_between(&visit->x, i0, i1, (Section){visit->sink->t_min, visit->sink->t_max});
    for (uint32_t j = j0; j < j1; j++) {
        Section row = section_between(&visit->z, j, j + 1, whole);
        double lo, hi;
        if (row.near > row.far) continue;
        passed_on(&visit->x, row, &lo, &hi);
        uint32_t first = lo > i0 ? lo < i1 ? (uint32_t)lo : i1 : i0, end = hi < i1 ? hi > i0 ? (uint32_t)hi + 1 : i0 : i1;
        for (uint32_t i = first; i < end; i++)
            if (is_passed(visit, i, j, section_between(&visit->x, i, i + 1, row))) try_cell(visit, i, j);
    }
}

static void cross(const void *data, const Ray *ray, SolidSink *sink) {
    const Field *f = data;
    FieldVisit visit = {.field = f, .ray = ray, .sink = sink, .x = along(ray->origin.x, ray->direction.x, f->columns - 1),
                        .y = along(ray->origin.y, ray->direction.y, 1), .z = along(ray->origin.z, ray->direction.z, f->rows - 1)};
    box_tree_ray(visit.field->tree, ray, sink->t_min, &sink->t_max, visit_block, &visit);
}

static Vec3 flat_normal(const Field *f, uint32_t i, uint32_t j, bool upper) {
    double x = (height_at(f, i + 1, j + upper) - height_at(f, i, j + upper)) * (f->columns - 1);
    double z = (height_at(f, i + upper, j + 1) - height_at(f, i + upper, j)) * (f->rows - 1);
    return vec3_normalize(vec3(-x, 1, -z));
}

/* The mean of the triangles around a point. */
static Vec3 smooth_normal(const Field *f, uint32_t i, uint32_t j) {
    Vec3 sum = vec3_splat(0);
    for (uint32_t dj = 0; dj < 2; dj++)
        for (uint32_t di = 0; di < 2; di++) {
            if (i < di || j < dj || i - di + 1 >= f->columns || j - dj + 1 >= f->rows) continue;
            if (di + dj < 2) sum = vec3_add(sum, flat_normal(f, i - di, j - dj, false));
            if (di + dj > 0) sum = vec3_add(sum, flat_normal(f, i - di, j - dj, true));
        }
    return vec3_normalize(sum);
}

Vec3 solid_height_normal(const void *data, uint32_t column, uint32_t row) { return smooth_normal(data, column, row); }

HeightGrid solid_height_grid(const void *data) {
    const Field *f = data;
    return (HeightGrid){f->heights, f->columns, f->rows, f->water_level, f->smooth};
}

static Vec3 normal(const void *data, Vec3 p, const SolidTag *tag) {
    const Field *f = data;
    uint32_t i = tag->part % f->columns, j = tag->part / f->columns;
    if (!f->smooth) return flat_normal(f, i, j, tag->u > 0);
    double x = double_clamp(p.x * (f->columns - 1) - i, 0, 1),
           z = double_clamp(p.z * (f->rows - 1) - j, 0, 1);
    Vec3 low = vec3_lerp(smooth_normal(f, i, j), smooth_normal(f, i + 1, j), x);
    Vec3 high = vec3_lerp(smooth_normal(f, i, j + 1), smooth_normal(f, i + 1, j + 1), x);
    return vec3_normalize(vec3_lerp(low, high, z));
}

static bool inside(const void *data, Vec3 p) {
    const Field *f = data;
    if (!(p.x >= 0 && p.x <= 1 && p.z >= 0 && p.z <= 1)) return false;
    uint32_t i = (uint32_t)double_min(p.x * (f->columns - 1), f->columns - 2),
             j = (uint32_t)double_min(p.z * (f->rows - 1), f->rows - 2);
    double x = p.x * (f->columns - 1) - i, z = p.z * (f->rows - 1) - j;
    double a = height_at(f, i, j), b = height_at(f, i + 1, j), c = height_at(f, i, j + 1),
           d = height_at(f, i + 1, j + 1);
    return p.y < (x + z <= 1 ? a + (b - a) * x + (c - a) * z : d + (c - d) * (1 - x) + (b - d) * (1 - z));
}

static Box3 bounds(const void *data) { return ((const Field *)data)->bounds; }

const SolidOps solid_height_ops = {
    .prepare = prepare, .cross = cross, .normal = normal, .inside = inside, .bounds = bounds};
