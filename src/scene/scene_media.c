#include "scene/medium.h"
#include "scene/scene_hash.h"

void media_hash(Hash128 *hash, const MediaList *media) {
    for (size_t i = 0; i < media->count; i++) {
        const Medium *m = &media->items[i];
        hash_add_color(hash, m->absorption);
        hash_add_color(hash, m->emission);
        hash_add_color(hash, m->scattering);
        hash_add_double(hash, m->loss);
        phase_hash(hash, &m->phase);
        hash_add_double(hash, m->gain);
        hash_add_double(hash, m->samples);
        for (size_t k = 0; k < m->density_count; k++) {
            hash_add_hash(hash, m->densities[k].pattern->hash);
            hash_add_transform(hash, &m->densities[k].place);
        }
        hash_add_u64(hash, m->density_count);
    }
}

static void print_color(StrBuf *out, const char *word, Color c) {
    if (c.red != 0 || c.green != 0 || c.blue != 0) strbuf_addf(out, " %s rgb <%g, %g, %g>", word, c.red, c.green, c.blue);
}

void medium_print(const Medium *m, StrBuf *out) {
    print_color(out, "absorption", m->absorption);
    print_color(out, "emission", m->emission);
    print_color(out, "scattering", m->scattering);
    if (m->scattering.red == 0 && m->scattering.green == 0 && m->scattering.blue == 0) return;
    if (m->loss != 1) strbuf_addf(out, " extinction %g", m->loss);
    phase_print(&m->phase, out);
}
