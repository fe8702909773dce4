#include "render/wang_border.h"

#include "texel/texel_content.h"
#include "texel/texel_field.h"

#include <string.h>

/* Cells along both sides of a section; those of densities, which are asked one by one; the walls of a triangle that are looked at. */
enum { SECTION = 128, SECTION_OF_FIELD = 32, MOST_WALLS = 64 };
/* Sections that differ by less agree: what lies at a cell's edge may be counted in the next. */
static const double AGREEING = 0.02;

typedef struct Section {
    uint8_t cell[SECTION][SECTION]; /* along the other cyclic axis; along y */
} Section;

/* ---- sections ---- */

typedef struct Wall {
    Section *section;
    int axis, other; /* 0 x, 2 z */
    float size, other_size, height;
} Wall;

static void mark(const Wall *wall, float other, float y) {
    int i = (int)floorf(other / wall->other_size * SECTION), k = (int)floorf(y / wall->height * SECTION);
    if (k < 0 || k >= SECTION) return;
    i %= SECTION;
    wall->section->cell[i < 0 ? i + SECTION : i][k] = 1;
}

static void mark_line(const Wall *wall, const float a[2], const float b[2]) {
    float along = fabsf(b[0] - a[0]) / wall->other_size, up = fabsf(b[1] - a[1]) / wall->height;
    float most = 2 * SECTION * float_max(along, up);
    if (!(most < 16 * SECTION)) return;
    int steps = 1 + (int)most;
    for (int i = 0; i <= steps; i++) {
        float t = (float)i / (float)steps;
        mark(wall, a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]));
    }
}

static float along_axis(Vec3f v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/* Where the triangle meets the plane: the two ends of a line. */
static bool cut(const Wall *wall, const Vec3f corner[3], float at, float ends[2][2]) {
    int count = 0;
    for (int i = 0; i < 3 && count < 2; i++) {
        Vec3f p = corner[i], q = corner[(i + 1) % 3];
        float from = along_axis(p, wall->axis) - at, to = along_axis(q, wall->axis) - at;
        if ((from < 0) == (to < 0)) continue;
        Vec3f m = vec3f_add(p, vec3f_scale(vec3f_sub(q, p), from / (from - to)));
        ends[count][0] = along_axis(m, wall->other), ends[count][1] = m.y;
        count++;
    }
    return count == 2;
}

static void add_mesh(const Wall *wall, const TexelMesh *mesh) {
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        Vec3f corner[3];
        float lo = INFINITY, hi = -INFINITY, ends[2][2];
        for (int k = 0; k < 3; k++) {
            corner[k] = mesh->vertices[mesh->triangles[i][k]];
            lo = float_min(lo, along_axis(corner[k], wall->axis)), hi = float_max(hi, along_axis(corner[k], wall->axis));
        }
        float first = ceilf(lo / wall->size), last = floorf(hi / wall->size);
        if (!(last - first < MOST_WALLS)) continue;
        for (float at = first; at <= last; at++)
            if (cut(wall, corner, at * wall->size, ends)) mark_line(wall, ends[0], ends[1]);
    }
}

static void add_field(const Wall *wall, const TexelField *field) {
    float thin = wall->size / SECTION, wide = wall->other_size / SECTION_OF_FIELD, high = wall->height / SECTION_OF_FIELD;
    enum { EACH = SECTION / SECTION_OF_FIELD };
    for (int i = 0; i < SECTION_OF_FIELD; i++)
        for (int k = 0; k < SECTION_OF_FIELD; k++) {
            float area = 0, normals[6] = {0}, other = (float)i * wide;
            Vec3f lo = wall->axis == 0 ? vec3f(0, (float)k * high, other) : vec3f(other, (float)k * high, 0);
            Vec3f sides = wall->axis == 0 ? vec3f(thin, high, wide) : vec3f(wide, high, thin);
            field->fill(field->context, lo, sides, &area, normals);
            for (int n = 0; n < EACH && area > 0; n++) memset(&wall->section->cell[i * EACH + n][k * EACH], 1, EACH);
        }
}

static void add_layer(const TexelDef *def, const TexelLayer *layer, Section sections[2], CompiledScene *compiled) {
    Vec3f e = texel_extent(def);
    ArenaMark scratch = arena_mark(&compiled->scratch);
    const TexelMeshOptions how = {1.0 / SECTION, compiled->options->interrupted, NULL, 0};
    const TexelField *field = layer->density ? texel_field_make(def, layer, &compiled->scratch) : NULL;
    TexelMesh mesh = {0};
    ShapeRefusal refusal;
    if (!field && !texel_layer_mesh(def, layer, &how, &compiled->scratch, &mesh, &refusal)) mesh = (TexelMesh){0}; /* building tells why */
    for (int axis = 0; axis < 3; axis += 2) {
        Wall wall = {&sections[axis / 2], axis, 2 - axis, axis ? e.z : e.x, axis ? e.x : e.z, e.y};
        if (!(def->cyclic >> axis & 1)) continue;
        if (field) add_field(&wall, field);
        else add_mesh(&wall, &mesh);
    }
    arena_reset_to(&compiled->scratch, scratch);
}

/* ---- how far two are apart ---- */

static bool marked_near(const Section *s, int i, int k) {
    for (int a = -1; a <= 1; a++)
        for (int b = -1; b <= 1; b++)
            if (k + b >= 0 && k + b < SECTION && s->cell[(i + a + SECTION) % SECTION][k + b]) return true;
    return false;
}

static void compare(const Section *a, const Section *b, size_t *all, size_t *alone) {
    for (int i = 0; i < SECTION; i++)
        for (int k = 0; k < SECTION; k++) {
            if (!a->cell[i][k]) continue;
            ++*all;
            *alone += !marked_near(b, i, k);
        }
}

/* The share of what is in both sections that is in one of them alone. */
static double unlike(const Section *a, const Section *b) {
    size_t all = 0, alone = 0;
    compare(a, b, &all, &alone);
    compare(b, a, &all, &alone);
    return all ? (double)alone / (double)all : 0;
}

/* ---- classes ---- */

typedef struct Least {
    double share;
    size_t a, b;
} Least;

static uint32_t *classes_along(const Section (*sections)[2], size_t count, int axis, Arena *arena, uint32_t *class_count, Least *least) {
    uint32_t *class = arena_new_array(arena, uint32_t, count);
    *class_count = 0;
    for (size_t i = 0; i < count; i++) {
        class[i] = UINT32_MAX;
        for (size_t k = 0; k < i; k++) {
            double share = unlike(&sections[i][axis], &sections[k][axis]);
            if (share > least->share) *least = (Least){share, k, i};
            if (share <= AGREEING && class[i] == UINT32_MAX) class[i] = class[k];
        }
        if (class[i] == UINT32_MAX) class[i] = (*class_count)++;
    }
    return class;
}

/* Whether there is a member for any class of a row and any of a column. */
static bool all_pairs(const WangBorders *borders, uint32_t rows, uint32_t columns, size_t count) {
    size_t found = 0;
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t column = 0; column < columns; column++)
            for (size_t i = 0; i < count; i++)
                if (borders->class_x[i] == row && borders->class_z[i] == column) {
                    found++;
                    break;
                }
    return found == (size_t)rows * columns;
}

static bool same_layers(const TexelDef *a, const TexelDef *b) {
    if (a->layer_count != b->layer_count || a->file || b->file) return false;
    for (size_t i = 0; i < a->layer_count; i++)
        if (!hash_equal(a->layers[i].hash, b->layers[i].hash)) return false;
    return true;
}

static bool all_the_same(const TexelDef *const *defs, size_t count, size_t all) {
    for (size_t i = 1; i < count; i++)
        if (!same_layers(defs[0], defs[i])) return false;
    return count == all;
}

/* Members that are compared; of more than that, nobody waits for the warning. */
enum { MOST_MEMBERS = 32 };

const WangBorders *wang_borders(const TexelDef *const *defs, size_t count, size_t all, const Skin *skin, CompiledScene *compiled, DiagList *diags) {
    if (all > MOST_MEMBERS || all_the_same(defs, count, all)) return NULL;
    Section(*sections)[2] = arena_push_array_(compiled->arena, all, sizeof *sections);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < defs[i]->layer_count && !defs[i]->file; k++) add_layer(defs[i], &defs[i]->layers[k], sections[i], compiled);
    Least least = {0};
    WangBorders *borders = arena_new(compiled->arena, WangBorders);
    uint32_t rows, columns;
    borders->class_x = classes_along((const Section(*)[2])sections, all, 0, compiled->arena, &rows, &least);
    borders->class_z = classes_along((const Section(*)[2])sections, all, 1, compiled->arena, &columns, &least);
    if (rows == 1 && columns == 1) return NULL;
    if (all_pairs(borders, rows, columns, all)) return borders;
    const TexelDef *a = defs[size_min(least.a, count - 1)], *b = defs[size_min(least.b, count - 1)];
    Diagnostic *d = diag_warning(diags, skin->span, "'tiling wang' cuts %.0f %% of what crosses the border between '%s' and '%s', the family's numbers %zu and %zu: it is too large to be moved whole, and differs there",
                                 100 * least.share, a->name, b->name, least.a + 1, least.b + 1);
    if (d) diag_hint(diags, d, "let what crosses the border be the same in all of the family, or consist of objects smaller than half a tile");
    return NULL;
}
