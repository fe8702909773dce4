#include "render/skin_wind.h"

#include "grow/tips.h"
#include "grow/wind.h"

/* Springs that may be looked at for one skin: some ten minutes. */
static const double MOST_WORK = 5e10;

/* Each edge of the surface's cells once. */
static const TipsEdge *find_edges(const SurfaceMesh *mesh, Arena *arena, size_t *count) {
    TipsEdge *edges = arena_new_array(arena, TipsEdge, 4 * mesh->cell_count);
    *count = 0;
    for (size_t i = 0; i < mesh->cell_count; i++) {
        const SurfaceCell *cell = &mesh->cells[i];
        for (int e = 0; e < cell->corner_count; e++) {
            uint32_t a = cell->vertex[e], b = cell->vertex[(e + 1) % cell->corner_count];
            int32_t next = mesh->neighbours[i][e].cell;
            if (a == b || (next >= 0 && (size_t)next < i)) continue;
            edges[(*count)++] = (TipsEdge){a, b};
        }
    }
    return edges;
}

static bool swing(const Skin *skin, const SurfaceMesh *mesh, CompiledScene *compiled, DiagList *diags, const Vec3 *rest, Vec3 *heights) {
    const CompileOptions *options = compiled->options;
    TipsSpec spec = {.count = mesh->vertex_count, .feet = mesh->vertices, .heights = rest, .stiffness = skin->springs.stiffness,
                     .damping = skin->springs.damping, .wind = skin->wind};
    spec.edges = find_edges(mesh, &compiled->scratch, &spec.edge_count);
    double lead = tips_lead(&skin->springs, skin->wind), time = compiled->scene->time + lead;
    spec.begins = -lead;
    if (!(tips_work(&spec) * time < MOST_WORK)) {
        diag_error(diags, skin->span, "the springs of this skin would have to be followed for %g seconds: at most %.3g with its %zu height vectors",
                   time, MOST_WORK / tips_work(&spec), spec.count);
        return false;
    }
    Vec3 *tips = arena_new_array(&compiled->scratch, Vec3, spec.count);
    if (!net_follow_by_states(tips_create(&spec, &compiled->scratch), tips_hash(&spec), options->net_states, time, options->interrupted, spec.count, tips))
        return false;
    for (size_t i = 0; i < spec.count; i++) heights[i] = tips_height(mesh->vertices[i], rest[i], tips[i], heights[i]);
    return true;
}

bool skin_bend(const Skin *skin, const SurfaceMesh *mesh, CompiledScene *compiled, DiagList *diags, Vec3 *heights) {
    if (!skin->wind) return true;
    ArenaMark mark = arena_mark(&compiled->scratch);
    Vec3 *rest = arena_new_array(&compiled->scratch, Vec3, mesh->vertex_count);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        rest[i] = heights[i];
        heights[i] = wind_bend(rest[i], wind_force(skin->wind, mesh->vertices[i], compiled->scene->time), skin->wind->stiffness);
    }
    bool done = !skin->springs.present || swing(skin, mesh, compiled, diags, rest, heights);
    arena_reset_to(&compiled->scratch, mark);
    return done;
}
