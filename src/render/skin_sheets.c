#include "render/skin_sheets.h"

#include "render/skin_fold.h"

/* Pieces known ahead, and sheets that are followed at the same place: what is more is met a little later than its place. */
enum { PIECES_AHEAD = 48, MOST_LANES = 8 };

typedef struct Lane {
    SkinMarch march;
    SkinSegment segment;
    bool busy, used; /* has a segment; it was handed out */
} Lane;

struct SkinSheets {
    const SkinMarch *whole;
    SkinPiece pieces[PIECES_AHEAD]; /* those that begin before `until`, which ends them */
    int count, next, current;
    double until;
    Lane lanes[MOST_LANES];
};

SkinSheets *skin_sheets_new(const CompiledSkin *skin, Arena *arena) {
    SkinSheets *sheets = arena_new(arena, SkinSheets);
    for (int i = 0; i < MOST_LANES; i++) skin_march_init_confined(&sheets->lanes[i].march, skin, arena);
    return sheets;
}

static void look_ahead(SkinSheets *s, double from) {
    const SkinMarch *m = s->whole;
    Ray ray = {m->cone->origin, m->cone->direction};
    s->next = 0;
    s->until = m->t_max;
    s->count = skin_first_pieces(m->skin, &ray, from, m->t_max, s->pieces, PIECES_AHEAD);
    if (s->count < PIECES_AHEAD || !(s->pieces[s->count - 1].t0 > from)) return;
    s->until = s->pieces[--s->count].t0;
    for (int i = 0; i < s->count; i++) s->pieces[i].t1 = double_min(s->pieces[i].t1, s->until);
}

void skin_sheets_begin(SkinSheets *s, const SkinMarch *march) {
    s->whole = march;
    s->current = 0;
    for (int i = 0; i < MOST_LANES; i++) s->lanes[i].busy = s->lanes[i].used = false;
    look_ahead(s, march->t);
}

/* The place at t on the sheet of the middle. */
static bool place_at(const SkinSheets *s, const SkinPiece *piece, double t, SkinPoint *place) {
    const SkinCell *cell = &s->whole->skin->cells[piece->middle.cell];
    TexturePlace middle = skin_texture_place(cell, &piece->middle);
    Vec3 way = vec3_scale(s->whole->cone->direction, t - (piece->t0 + piece->t1) / 2);
    *place = piece->middle;
    place->a += vec3_dot(middle.grad_a, way), place->b += vec3_dot(middle.grad_b, way), place->w += vec3_dot(middle.grad_layer, way);
    double size = vec3_length(vec3_sub(cell->bounds.max, cell->bounds.min));
    return skin_cell_invert(cell, cone_point(s->whole->cone, t), 1e-6 * size, place) && fabs(place->a - 0.5) < 0.51 &&
           fabs(place->b - 0.5) < 0.51 && fabs(place->w - 0.5) < 0.51;
}

/* From near the piece's ends, where a fold may be and no inverse is, inwards until places are found. */
static SkinStretch stretch_of(const SkinSheets *s, const SkinPiece *piece) {
    SkinStretch out = {piece->t0, piece->t1, piece->middle, piece->middle, NO_FACE};
    double half = (piece->t1 - piece->t0) / 2, middle = piece->t0 + half;
    static const double share[] = {1, 0.999, 0.99, 0.9, 0.5};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(share); i++) {
        out.t0 = middle - share[i] * half;
        if (place_at(s, piece, out.t0, &out.start)) break;
    }
    for (size_t i = 0; i < VTS_ARRAY_COUNT(share); i++) {
        out.t1 = middle + share[i] * half;
        if (place_at(s, piece, out.t1, &out.end)) break;
    }
    return out;
}

static void fill(Lane *lane) {
    lane->used = false;
    lane->busy = skin_march_next(&lane->march, &lane->segment);
}

static int nearest_lane(const SkinSheets *s) {
    int nearest = -1;
    for (int i = 0; i < MOST_LANES; i++)
        if (s->lanes[i].busy && (nearest < 0 || s->lanes[i].segment.t0 < s->lanes[nearest].segment.t0)) nearest = i;
    return nearest;
}

static Lane *free_lane(SkinSheets *s) {
    for (int i = 0; i < MOST_LANES; i++)
        if (!s->lanes[i].busy) return &s->lanes[i];
    return NULL;
}

/* Pieces that begin before the nearest segment may hold a nearer one. */
static int follow_pieces(SkinSheets *s) {
    int nearest = nearest_lane(s);
    while (s->next < s->count && (nearest < 0 || s->pieces[s->next].t0 < s->lanes[nearest].segment.t0)) {
        Lane *lane = free_lane(s);
        if (!lane) break;
        SkinStretch stretch = stretch_of(s, &s->pieces[s->next++]);
        if (!(stretch.t1 > stretch.t0)) continue;
        skin_march_begin_stretch(&lane->march, s->whole, &stretch);
        fill(lane);
        nearest = nearest_lane(s);
    }
    return nearest;
}

bool skin_sheets_next(SkinSheets *s, SkinSegment *segment) {
    Lane *last = &s->lanes[s->current];
    if (last->used) fill(last);
    int nearest = follow_pieces(s);
    while (nearest < 0 && s->until < s->whole->t_max) {
        look_ahead(s, s->until);
        nearest = follow_pieces(s);
    }
    if (nearest < 0) return false;
    s->current = nearest;
    s->lanes[nearest].used = true;
    *segment = s->lanes[nearest].segment;
    return true;
}

SkinPoint skin_sheets_guess(const SkinSheets *s, double t) { return skin_march_guess(&s->lanes[s->current].march, t); }
