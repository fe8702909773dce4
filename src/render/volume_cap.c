/* In what is so dense that no light comes through, nearly all of it turns back within a few free paths of the surface, wherever that is: of a semi-infinite medium how much does not
 * depend on its density (Chandrasekhar 1950, sec. 38). Bins that are many free paths wide do not see that layer, and paths would take millions of turns to come out again. */
#include "render/volume_set.h"

/* A volume that is so many free paths across passes hardly anything: 4/(3 depth + 4) of what comes to a slab. With bins as fine as they become, what they cannot tell of the layer below
 * the surface makes up for that 1 %. */
static const double OPAQUE_DEPTH = 96;
/* Of colours that are taken out very differently no one may become transparent. */
static const double MOST_RATIO = 8;

static double extinction_of(const CompiledVolume *v) {
    double least = VTS_INFINITY, most = 0;
    for (int c = 0; c < 3; c++) {
        most = double_max(most, v->extinction[c]);
        if (v->extinction[c] > 0) least = double_min(least, v->extinction[c]);
    }
    return double_max(least, most / MOST_RATIO);
}

/* The density beyond which there is no difference: what makes the whole so deep that it is opaque; more where it is less dense on the mean, for then thin places lie between dense ones. */
static double density_cap(const CompiledVolume *v) {
    double side = VTS_INFINITY;
    for (int k = 0; k < 3; k++) side = double_min(side, vec3_length(v->from_cells.c[k]) * v->lattice.size[k]);
    double depth = extinction_of(v) * side * lattice_mean(&v->lattice), thin = double_max(1, OPAQUE_DEPTH / depth);
    return OPAQUE_DEPTH / (extinction_of(v) * side) * thin * thin;
}

static void cap(CompiledVolume *v, Arena *arena) {
    const double most = density_cap(v);
    if (!((double)v->lattice.most > most)) return;
    const Lattice *whole = arena_copy(arena, &v->lattice, sizeof *whole);
    lattice_clamp(&v->lattice, whole, (float)most, arena);
    v->dense = whole;
}

void volumes_cap(VolumeSet *set, Arena *arena) {
    for (size_t i = 0; i < set->count; i++) cap(&set->items[i], arena);
}
