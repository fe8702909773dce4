#include "scene/scene_hash.h"
#include "scene/volumes.h"

void phase_hash(Hash128 *hash, const Phase *phase) {
    hash_add_double(hash, phase->count);
    for (int i = 0; i < phase->count; i++) {
        hash_add_u64(hash, phase->lobes[i].kind);
        hash_add_double(hash, phase->lobes[i].k);
        hash_add_double(hash, phase->lobes[i].weight);
    }
}

void volume_rehash(Volume *v) {
    const double numbers[] = {v->orders, v->rays, v->step, v->method, v->storage, v->density != NULL};
    Hash128 h = hash_begin(0x766f6c75);
    if (v->density) hash_add_hash(&h, v->density->hash);
    hash_add_hash(&h, object_geometry_hash(v->container));
    hash_add_color(&h, v->scattering);
    hash_add_color(&h, v->absorption);
    for (size_t i = 0; i < VTS_ARRAY_COUNT(numbers); i++) hash_add_double(&h, numbers[i]);
    phase_hash(&h, &v->phase);
    v->hash = h;
}

void phase_print(const Phase *phase, StrBuf *out) {
    static const char *const names[] = {"isotropic", "rayleigh", "power", "henyey_greenstein", "schlick"};
    strbuf_adds(out, " phase");
    for (int i = 0; i < phase->count; i++) {
        const PhaseLobe *lobe = &phase->lobes[i];
        strbuf_addf(out, " %g %s", lobe->weight, names[lobe->kind]);
        if (lobe->kind >= PHASE_POWER) strbuf_addf(out, " %g", lobe->k);
    }
}

void volume_print(const Volume *v, StrBuf *out) {
    static const char *const methods[] = {"two_pass", "published", "path"}, *const storages[] = {"auto", "isotropic", "directional"};
    strbuf_addf(out, " in %s density %s", object_word(v->container), v->density ? "" : "1");
    if (v->density) {
        const DensityGrid *grid = v->density->pattern->density;
        if (grid) strbuf_addf(out, "of %d x %d x %d cells", grid->size[0], grid->size[1], grid->size[2]);
        else strbuf_adds(out, v->density->pattern->kind == PATTERN_FUNCTION ? "function" : "pattern");
        if (v->density->has_threshold) strbuf_addf(out, " threshold %g, %g", v->density->low, v->density->high);
    }
    strbuf_addf(out, " scattering <%g, %g, %g> absorption <%g, %g, %g>", v->scattering.red, v->scattering.green, v->scattering.blue, v->absorption.red,
                v->absorption.green, v->absorption.blue);
    phase_print(&v->phase, out);
    if (v->orders) strbuf_addf(out, " orders %d", v->orders);
    if (v->rays > 0) strbuf_addf(out, " rays %g", v->rays);
    if (v->step > 0) strbuf_addf(out, " step %g", v->step);
    strbuf_addf(out, " method %s storage %s", methods[v->method], storages[v->storage]);
}
