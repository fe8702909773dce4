#include "render/skin_front.h"

/* Skins of one cell that are followed side by side; where more overlap, the farthest are put off. At most 64. */
enum { SHARED_MARCHES = 32 };

static bool shares(const CompiledSkin *skin) { return skin->cell_count == 1 && !skin->overlaps; }

void skin_marches_init(SkinMarches *m, const CompiledScene *compiled, int shared, Arena *arena) {
    *m = (SkinMarches){compiled, arena_new_array(arena, SkinMarch *, compiled->skin_count + 1), arena_new_array(arena, SkinMarch, (size_t)shared), shared};
    SkinRoom room = {1, 1};
    for (size_t i = 0; i < compiled->skin_count; i++) {
        const CompiledSkin *skin = &compiled->skins[i];
        if (!shares(skin)) {
            m->own[i] = arena_new(arena, SkinMarch);
            skin_march_init(m->own[i], skin, arena);
            continue;
        }
        skin_march_ask_room(skin, &room);
    }
    for (int i = 0; i < shared; i++) skin_march_init_shared(&m->shared[i], &room, arena);
}

SkinMarch *skin_marches_get(const SkinMarches *m, uint32_t skin, int slot) {
    if (m->own[skin]) return m->own[skin];
    m->shared[slot].skin = &m->compiled->skins[skin];
    return &m->shared[slot];
}

void skin_front_init(SkinFront *f, const CompiledScene *compiled, TraceCounters *counters, Arena *arena) {
    size_t skins = compiled->skin_count + 1, own = 0;
    *f = (SkinFront){.counters = counters, .met = arena_new_array(arena, SkinMet, skins), .ahead = arena_new_array(arena, SkinAhead, skins)};
    skin_marches_init(&f->marches, compiled, SHARED_MARCHES, arena);
    for (size_t i = 0; i < compiled->skin_count; i++) own += f->marches.own[i] != NULL;
    f->open = arena_new_array(arena, SkinOpen, own + SHARED_MARCHES);
    f->segments = arena_new_array(arena, SkinSegment, own + SHARED_MARCHES);
}

void skin_front_begin(SkinFront *f, const Cone *cone, double t_max, double (*from)(const CompiledSkin *skin, const void *context), const void *context) {
    const CompiledScene *compiled = f->marches.compiled;
    const Ray axis = {cone->origin, cone->direction};
    size_t met = compiled_skins_met(compiled, &axis, t_max, f->met);
    f->cone = cone;
    f->t_max = t_max;
    f->coarser = 0;
    f->ahead_first = f->ahead_end = f->open_count = 0;
    f->free_slots = ((uint64_t)1 << SHARED_MARCHES) - 1;
    f->last = SIZE_MAX;
    for (size_t k = 0; k < met; k++) {
        double start = from(&compiled->skins[f->met[k].skin], context);
        if (start < t_max) f->ahead[f->ahead_end++] = (SkinAhead){f->met[k].skin, f->met[k].t, start};
    }
}

/* ---- open skins; their segments lie at the same numbers ---- */

static bool is_nearer(const SkinFront *f, size_t a, size_t b) {
    double ta = f->segments[a].t0, tb = f->segments[b].t0;
    return ta < tb || (ta == tb && f->open[a].skin < f->open[b].skin);
}

static void close_open(SkinFront *f, size_t at) {
    if (f->open[at].slot >= 0) f->free_slots |= (uint64_t)1 << f->open[at].slot;
    f->open_count--;
    if (at == f->open_count) return;
    f->open[at] = f->open[f->open_count];
    f->segments[at] = f->segments[f->open_count];
}

/* The farthest of those that share goes back to what lies ahead: its march begins again at its segment. */
static void put_off(SkinFront *f) {
    size_t farthest = SIZE_MAX;
    for (size_t i = 0; i < f->open_count; i++)
        if (f->open[i].slot >= 0 && (farthest == SIZE_MAX || is_nearer(f, farthest, i))) farthest = i;
    const SkinAhead again = {f->open[farthest].skin, f->segments[farthest].t0, f->segments[farthest].t0};
    size_t i = --f->ahead_first; /* there is room: all that are open came from there */
    for (; i + 1 < f->ahead_end && f->ahead[i + 1].t <= again.t; i++) f->ahead[i] = f->ahead[i + 1];
    f->ahead[i] = again;
    close_open(f, farthest);
}

static int free_slot(SkinFront *f) {
    int slot = 0;
    if (!f->free_slots) put_off(f);
    while (!(f->free_slots >> slot & 1)) slot++;
    return slot;
}

static void open_next(SkinFront *f) {
    SkinAhead ahead = f->ahead[f->ahead_first++];
    SkinOpen *open;
    int slot = f->marches.own[ahead.skin] ? -1 : free_slot(f);
    SkinMarch *march = skin_marches_get(&f->marches, ahead.skin, slot);
    skin_march_begin(march, f->cone, ahead.from, f->t_max, &f->marches.compiled->march, f->counters, true);
    skin_march_coarsen(march, f->coarser);
    if (!skin_march_next(march, &f->segments[f->open_count])) return;
    open = &f->open[f->open_count++];
    *open = (SkinOpen){ahead.skin, slot, march};
    if (slot >= 0) f->free_slots &= ~((uint64_t)1 << slot);
}

static size_t nearest_open(const SkinFront *f) {
    size_t nearest = SIZE_MAX;
    for (size_t i = 0; i < f->open_count; i++)
        if (nearest == SIZE_MAX || is_nearer(f, i, nearest)) nearest = i;
    return nearest;
}

/* Whether what lies ahead comes before what is open. Of those that begin together no more are opened than there is room for: each would put off another without end. */
static bool opens_next(const SkinFront *f, size_t nearest) {
    if (f->ahead_first == f->ahead_end) return false;
    if (nearest == SIZE_MAX) return true;
    double t = f->ahead[f->ahead_first].t, open = f->segments[nearest].t0;
    return t < open || (t == open && f->free_slots);
}

const SkinSegment *skin_front_next(SkinFront *f, uint32_t *skin, const SkinMarch **march) {
    if (f->last != SIZE_MAX && !skin_march_next(f->open[f->last].march, &f->segments[f->last])) close_open(f, f->last);
    size_t nearest = nearest_open(f);
    while (opens_next(f, nearest)) {
        open_next(f);
        nearest = nearest_open(f); /* one may have been put off */
    }
    f->last = nearest;
    if (nearest == SIZE_MAX) return NULL;
    *skin = f->open[nearest].skin;
    *march = f->open[nearest].march;
    return &f->segments[nearest];
}

void skin_front_coarsen(SkinFront *f, int levels) {
    f->coarser = levels;
    for (size_t i = 0; i < f->open_count; i++) skin_march_coarsen(f->open[i].march, levels);
}
