#include "render/guess.h"

#include "base/random.h"

/* Squares of this size are tried first; WIDE ones where something else may be seen within, or the details of light may be fine, as of mirrors and
 * glass, of which the NARROW ones are asked less. */
enum { WIDEST = 8, WIDE = 4, NARROW = 2 };
/* What is seen between corners is as smooth a part of the same surface. */
static const float SAME_NORMAL = 0.98f;
/* One guess of so many is tried; of those where anything may be seen. */
enum { TRIED = 32, TRIED_BLINDLY = 16 };
/* Guesses are told apart by how much the light at the corners differs, in powers of four; what is known of all of them counts in each kind
 * as much as so many. */
enum { KINDS = 6 };
static const double PRIOR = 2;

typedef enum Known {
    UNKNOWN,
    FOUND,
    LOOKED = 2, /* and those after it, plus the kind: its light is guessed */
    GUESSED = LOOKED + KINDS /* the same, and nobody looked what is there */
} Known;

typedef struct Tile {
    const GuessSight *sight;
    Middle *middles;
    int columns, rows;
    uint8_t known[FILM_TILE * FILM_TILE];
    struct Kind {
        double wrong; /* sum of squared errors of the guesses tried, */
        int tried;    /* so many */
        int guessed;
    } kinds[KINDS];
} Tile;

static int place(int x, int y) { return y * FILM_TILE + x; }

static Vec3f shown(const Middle *m) {
    Vec3f c = m->seen.color;
    return vec3f(float_clamp(c.x, 0, 1), float_clamp(c.y, 0, 1), float_clamp(c.z, 0, 1));
}

/* Whether b, of which the light need not be known, is what a is. Less is asked of a surface of which little is seen. */
static bool same_surface(const Middle *a, const Middle *b) {
    if (a->single || a->object != b->object || a->tint.texture != b->tint.texture) return false;
    return a->object == 0 || (1 - vec3f_dot(a->normal, b->normal)) * (1 - a->hidden) < 1 - SAME_NORMAL;
}

/* By what the others differ from the first: where all are the same nothing is lost to rounding. */
static void take_mean(const Guess *guess, Middle *here) {
    const Middle *first = guess->corners[0];
    const bool tinted = here->tint.texture && !guess->even;
    const Vec3f light = tinted ? middle_as(first->seen.color, &first->tint, &here->tint) : first->seen.color;
    here->seen = (Radiance){light, first->seen.alpha};
    here->tint.lit = first->tint.lit;
    for (int k = 1; k < 4; k++) {
        const Middle *other = guess->corners[k];
        const float weight = guess->weights[k];
        const Vec3f as_here = tinted ? middle_as(other->seen.color, &other->tint, &here->tint) : other->seen.color;
        here->seen.color = vec3f_madd(here->seen.color, vec3f_sub(as_here, light), weight);
        here->seen.alpha += (other->seen.alpha - first->seen.alpha) * weight;
        here->tint.lit = vec3f_madd(here->tint.lit, vec3f_sub(other->tint.lit, first->tint.lit), weight);
    }
}

static bool is_finite(Vec3f c) { return isfinite(c.x) && isfinite(c.y) && isfinite(c.z); }

static bool has_finite_light(const Middle *m) {
    return is_finite(m->seen.color) && (!m->tint.texture || (is_finite(m->tint.lit) && is_finite(m->tint.color)));
}

bool guess_light(const Guess *guess, Middle *here) {
    for (int k = 0; k < 4; k++)
        if (!same_surface(guess->corners[k], here)) return false;
    take_mean(guess, here);
    return true;
}

static void find(Tile *t, int x, int y) {
    if (t->known[place(x, y)] == FOUND) return;
    t->sight->see(t->sight->context, x, y, NULL, &t->middles[place(x, y)]);
    t->known[place(x, y)] = FOUND;
}

/* ---- squares ---- */

typedef struct Square {
    int x0, y0, x1, y1; /* corners */
} Square;

static void corners_of(const Tile *t, const Square *s, const Middle *corners[4]) {
    for (int k = 0; k < 4; k++) corners[k] = &t->middles[place(k & 1 ? s->x1 : s->x0, k & 2 ? s->y1 : s->y0)];
}

static Guess guess_of(const Tile *t, const Square *s) {
    Guess guess = {.even = false};
    corners_of(t, s, guess.corners);
    return guess;
}

static void weigh(Guess *guess, const Square *s, int x, int y) {
    const float u = (float)(x - s->x0) / (float)(s->x1 - s->x0), v = (float)(y - s->y0) / (float)(s->y1 - s->y0);
    guess->weights[0] = (1 - u) * (1 - v), guess->weights[1] = u * (1 - v);
    guess->weights[2] = (1 - u) * v, guess->weights[3] = u * v;
}

static Vec3f error_of(const Middle *guessed, const Middle *m) { return vec3f_sub(shown(guessed), shown(m)); }

static float most_of(Vec3f c) { return float_max(fabsf(c.x), float_max(fabsf(c.y), fabsf(c.z))); }

static bool corners_agree(const Tile *t, const Square *s) {
    const Middle *corners[4];
    corners_of(t, s, corners);
    for (int k = 0; k < 4; k++)
        if (!has_finite_light(corners[k]) || !same_surface(corners[k], corners[0])) return false;
    return true;
}

/* Whether a place of the square, which is found for this, sees the same surface as the corners, and its light there is what they tell: an edge that
 * parts them would show, and how much the light curves does. */
static bool agrees_at(Tile *t, const Square *s, int x, int y) {
    const Middle *found = &t->middles[place(x, y)];
    find(t, x, y);
    Guess guess = guess_of(t, s);
    weigh(&guess, s, x, y);
    Middle guessed = *found;
    return guess_light(&guess, &guessed) && (double)most_of(error_of(&guessed, found)) <= t->sight->tolerance;
}

/* In the middle, and where the light may have fine details in the middles of the sides. */
static bool agree(Tile *t, const Square *s, int mx, int my, bool fine) {
    if (!corners_agree(t, s) || !agrees_at(t, s, mx, my)) return false;
    return !fine || (agrees_at(t, s, mx, s->y0) && agrees_at(t, s, s->x0, my) && agrees_at(t, s, s->x1, my) && agrees_at(t, s, mx, s->y1));
}

static int kind_of(const Tile *t, const Square *s) {
    const Middle *corners[4];
    corners_of(t, s, corners);
    float most = 0;
    for (int k = 1; k < 4; k++) {
        const Middle other = {.seen.color = middle_as(corners[k]->seen.color, &corners[k]->tint, &corners[0]->tint)};
        Vec3f off = error_of(&other, corners[0]);
        most = float_max(most, vec3f_dot(off, off));
    }
    int kind = 0;
    for (float least = 0.1f; kind < KINDS - 1 && most < least; kind++) least /= 16;
    return kind;
}

/* Finds what could have been guessed, for all the others. Whether that would have been right. */
static bool try_guess(Tile *t, const Guess *guess, struct Kind *kind, int x, int y) {
    const Middle *m = &t->middles[place(x, y)];
    find(t, x, y);
    Middle guessed = *m;
    if (!guess_light(guess, &guessed)) return true;
    Vec3f off = error_of(&guessed, m);
    kind->wrong += (double)vec3f_dot(off, off) / 3;
    kind->tried++;
    return (double)most_of(off) <= t->sight->tolerance;
}

/* What is interpolated of middles. */
typedef struct Blend {
    Vec3f color, lit, normal;
    float alpha;
} Blend;

static Blend blend_of(const Middle *m) { return (Blend){m->seen.color, m->tint.lit, m->normal, m->seen.alpha}; }

/* Where both are the same nothing is lost to rounding. */
static Blend blend(const Blend *a, const Blend *b, float share) {
    return (Blend){vec3f_madd(a->color, vec3f_sub(b->color, a->color), share), vec3f_madd(a->lit, vec3f_sub(b->lit, a->lit), share),
                   vec3f_madd(a->normal, vec3f_sub(b->normal, a->normal), share), a->alpha + (b->alpha - a->alpha) * share};
}

/* The pixels beside one of a square, within it, that are known. */
static int known_beside(const Tile *t, const Square *s, int x, int y, const Middle *out[4]) {
    static const int beside[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    int count = 0;
    for (int k = 0; k < 4; k++) {
        int bx = x + beside[k][0], by = y + beside[k][1];
        if (bx < s->x0 || by < s->y0 || bx > s->x1 || by > s->y1 || t->known[place(bx, by)] == UNKNOWN) continue;
        out[count++] = &t->middles[place(bx, by)];
    }
    return count;
}

/* Where one of two pixels is looked at, like squares of a checkerboard, all beside this one see what the corners see. */
static bool is_among(const Tile *t, const Square *s, int x, int y) {
    const Middle *beside[4], *corner = &t->middles[place(s->x0, s->y0)];
    int count = known_beside(t, s, x, y, beside);
    for (int k = 0; k < count; k++)
        if (!same_surface(beside[k], corner)) return false;
    return count >= 2;
}

/* In the light of those beside it; false where these differ: a pattern has an edge there. */
static bool put_mean(Tile *t, const Square *s, int x, int y) {
    const Middle *beside[4];
    int count = known_beside(t, s, x, y, beside);
    Middle mean = *beside[0];
    for (int k = 1; k < count; k++) {
        const Middle *other = beside[k];
        if ((double)most_of(error_of(other, beside[0])) > t->sight->tolerance) return false;
        const float weight = 1 / (float)(k + 1);
        mean.seen.color = vec3f_madd(mean.seen.color, vec3f_sub(other->seen.color, mean.seen.color), weight);
        mean.seen.alpha += (other->seen.alpha - mean.seen.alpha) * weight;
        mean.tint.color = vec3f_madd(mean.tint.color, vec3f_sub(other->tint.color, mean.tint.color), weight);
        mean.tint.lit = vec3f_madd(mean.tint.lit, vec3f_sub(other->tint.lit, mean.tint.lit), weight);
    }
    t->middles[place(x, y)] = mean;
    return true;
}

/* What a square is filled by. */
typedef struct Fill {
    Square square;
    int kind;
    VistaView view;
    Guess guess;
    bool patterned; /* its light is that of a pattern's colours, which have to be looked at */
    bool flat;      /* the corners have one normal */
    Blend ends[2];  /* of the row, between the corners */
} Fill;

static bool is_at_border(const Tile *t, int x, int y) { return x == 0 || y == 0 || x == t->columns - 1 || y == t->rows - 1; }

/* Whether somebody has to look what is at a pixel: where a few things may be at one of four, of patterns at one of two, like squares of a
 * checkerboard. What is wide shows at a corner somewhere, but maybe in another tile, from which no edge is followed: it comes in through the border. */
static bool is_asked(const Tile *t, const Fill *f, int x, int y) {
    const int off_x = x - f->square.x0, off_y = y - f->square.y0;
    if (f->view == VISTA_WIDE && is_at_border(t, x, y)) return true;
    return f->view == VISTA_OPEN || (f->patterned && !((off_x + off_y) & 1)) || (f->view == VISTA_SOME && !((off_x | off_y) & 1));
}

static void look(Tile *t, Fill *f, int x, int y) {
    weigh(&f->guess, &f->square, x, y);
    const bool holds = t->sight->see(t->sight->context, x, y, &f->guess, &t->middles[place(x, y)]);
    t->known[place(x, y)] = (uint8_t)(holds ? LOOKED + f->kind : FOUND);
    t->kinds[f->kind].guessed += holds;
}

static void begin_row(Fill *f, int y) {
    const float share = (float)(y - f->square.y0) / (float)(f->square.y1 - f->square.y0);
    for (int k = 0; k < 2; k++) {
        const Blend above = blend_of(f->guess.corners[k]), below = blend_of(f->guess.corners[k + 2]);
        f->ends[k] = blend(&above, &below, share);
    }
}

/* Of what the corners see, in their light. */
static void put_blend(const Fill *f, int x, Middle *m) {
    const Blend between = blend(&f->ends[0], &f->ends[1], (float)(x - f->square.x0) / (float)(f->square.x1 - f->square.x0));
    *m = *f->guess.corners[0];
    m->seen = (Radiance){between.color, between.alpha};
    m->tint.lit = between.lit;
    if (!f->flat) m->normal = vec3f_normalize(between.normal);
}

static void put(Tile *t, Fill *f, int x, int y) {
    if (f->patterned && !(is_among(t, &f->square, x, y) && put_mean(t, &f->square, x, y))) {
        look(t, f, x, y);
        return;
    }
    if (!f->patterned) put_blend(f, x, &t->middles[place(x, y)]);
    t->known[place(x, y)] = (uint8_t)(GUESSED + f->kind);
    t->kinds[f->kind].guessed++;
}

static void corners_are(const Tile *t, const Square *s, bool *calm, bool *tinted) {
    const Middle *corners[4];
    corners_of(t, s, corners);
    *calm = *tinted = true;
    for (int k = 0; k < 4; k++) {
        *calm &= corners[k]->calm;
        *tinted &= corners[k]->tint.texture != NULL;
    }
}

/* A pattern averaged over a square's footprint has exactly the colour of its corners where that is all there is, as within a tile. */
static bool has_even_color(const Tile *t, const Square *s, int mx, int my) {
    const Middle *corners[4], *middle = &t->middles[place(mx, my)];
    const double width = 1.25 * int_max(s->x1 - s->x0, s->y1 - s->y0) + 2;
    const Vec3f c = middle->tint.color;
    corners_of(t, s, corners);
    for (int k = 0; k < 4; k++) {
        Vec3f other = corners[k]->tint.color;
        if (other.x != c.x || other.y != c.y || other.z != c.z) return false;
    }
    return t->sight->even && t->sight->even(t->sight->context, mx, my, width, middle);
}

static bool have_one_normal(const Middle *const corners[4]) {
    const Vec3f n = corners[0]->normal;
    bool one = true;
    for (int k = 1; k < 4; k++) one &= corners[k]->normal.x == n.x && corners[k]->normal.y == n.y && corners[k]->normal.z == n.z;
    return one;
}

/* Some guesses are tried first; false when one is wrong. */
static bool try_some(Tile *t, Fill *f) {
    const Square *s = &f->square;
    const int tried = f->view == VISTA_OPEN ? TRIED_BLINDLY : TRIED;
    bool right = true;
    for (int y = s->y0; y <= s->y1; y++)
        for (int x = s->x0; x <= s->x1; x++) {
            if (t->known[place(x, y)] != UNKNOWN || random_hash((uint64_t)x, (uint64_t)y, 0, 0) % (uint64_t)tried) continue;
            weigh(&f->guess, s, x, y);
            right &= try_guess(t, &f->guess, &t->kinds[f->kind], x, y);
        }
    return right;
}

/* Whether a pattern's colours change so evenly that light can be interpolated with them: one of five pixels is looked at, of each row and column. */
static bool colors_agree(Tile *t, Fill *f, int mx, int my) {
    const Square *s = &f->square;
    Guess even = f->guess;
    even.even = true;
    for (int k = -1, count = (s->x1 - s->x0 + 1) * (s->y1 - s->y0 + 1); k < count; k++) {
        const int x = k < 0 ? mx : s->x0 + k % (s->x1 - s->x0 + 1), y = k < 0 ? my : s->y0 + k / (s->x1 - s->x0 + 1);
        if (k >= 0 && (x + 3 * y) % 5) continue;
        if (t->known[place(x, y)] == UNKNOWN) look(t, f, x, y);
        const Middle *m = &t->middles[place(x, y)];
        Middle guessed = *m;
        weigh(&even, s, x, y);
        if (!guess_light(&even, &guessed) || (double)most_of(error_of(&guessed, m)) > t->sight->tolerance) return false;
    }
    return true;
}

static bool fill(Tile *t, const Square *s, VistaView view, bool even, bool patterned) {
    Fill f = {.square = *s, .kind = kind_of(t, s), .view = view, .guess = guess_of(t, s), .patterned = patterned};
    f.guess.even = even;
    f.flat = have_one_normal(f.guess.corners);
    if (!try_some(t, &f)) return false;
    if (patterned && view != VISTA_OPEN && colors_agree(t, &f, (s->x0 + s->x1) / 2, (s->y0 + s->y1) / 2)) f.patterned = false, f.guess.even = true;
    for (int asked = f.patterned || f.view != VISTA_EVEN; asked >= 0; asked--)
        for (int y = s->y0; y <= s->y1; y++) {
            if (!asked && !f.patterned) begin_row(&f, y);
            for (int x = s->x0; x <= s->x1; x++)
                if (t->known[place(x, y)] == UNKNOWN && is_asked(t, &f, x, y) == asked) (asked ? look : put)(t, &f, x, y);
        }
    return true;
}

static void find_all(Tile *t, const Square *s) {
    for (int y = s->y0; y <= s->y1; y++)
        for (int x = s->x0; x <= s->x1; x++) find(t, x, y);
}

/* Whether it is filled by guesses; its corners are found. */
static bool fill_square(Tile *t, const Square *s, int mx, int my) {
    const GuessSight *sight = t->sight;
    const int side = int_max(s->x1 - s->x0, s->y1 - s->y0);
    bool calm, tinted;
    corners_are(t, s, &calm, &tinted);
    const bool fine = side > NARROW && !calm && !tinted;
    if (side > WIDE && fine) return false;
    const VistaView view = sight->view ? sight->view(sight->context, s->x0, s->y0, s->x1, s->y1, t->middles[place(s->x0, s->y0)].object) : VISTA_OPEN;
    if ((side > WIDE && view < VISTA_WIDE) || !agree(t, s, mx, my, fine)) return false;
    const bool even = calm || (tinted && has_even_color(t, s, mx, my));
    return fill(t, s, view, even, tinted && !even);
}

static void divide(Tile *t, const Square *s) {
    int width = s->x1 - s->x0, height = s->y1 - s->y0, mx = s->x0 + width / 2, my = s->y0 + height / 2;
    if (width <= 1 || height <= 1) {
        find_all(t, s);
        return;
    }
    if (fill_square(t, s, mx, my)) return;
    for (int k = 0; k < 9; k++)
        find(t, k % 3 == 0 ? s->x0 : k % 3 == 1 ? mx : s->x1, k / 3 == 0 ? s->y0 : k / 3 == 1 ? my : s->y1);
    divide(t, &(Square){s->x0, s->y0, mx, my});
    divide(t, &(Square){mx, s->y0, s->x1, my});
    divide(t, &(Square){s->x0, my, mx, s->y1});
    divide(t, &(Square){mx, my, s->x1, s->y1});
}

/* ---- edges that squares missed ---- */

/* Looks whether what was guessed is there; false if not: its light is found then. */
static bool holds_there(Tile *t, int x, int y) {
    const Middle guessed = t->middles[place(x, y)];
    const Guess guess = {.corners = {&guessed, &guessed, &guessed, &guessed}, .weights = {1, 0, 0, 0}, .even = guessed.tint.texture != NULL};
    const int kind = t->known[place(x, y)] - GUESSED;
    const bool holds = t->sight->see(t->sight->context, x, y, &guess, &t->middles[place(x, y)]);
    t->known[place(x, y)] = (uint8_t)(holds ? LOOKED + kind : FOUND);
    t->kinds[kind].guessed -= !holds;
    return holds;
}

/* Pixels at which a guess did not hold. */
typedef struct Misses {
    uint16_t places[FILM_TILE * FILM_TILE];
    int count;
} Misses;

/* Beside a pixel that sees another surface guesses are looked at. */
static void question(Tile *t, int known, int guessed, Misses *misses) {
    if (t->known[guessed] < GUESSED || t->known[known] >= GUESSED || same_surface(&t->middles[known], &t->middles[guessed])) return;
    if (!holds_there(t, guessed % FILM_TILE, guessed / FILM_TILE)) misses->places[misses->count++] = (uint16_t)guessed;
}

/* Of two pixels beside each other one of which is a guess. */
static void question_pair(Tile *t, int a, int b, Misses *misses) {
    if ((t->known[a] < GUESSED) == (t->known[b] < GUESSED)) return;
    if (t->known[a] < GUESSED) question(t, a, b, misses);
    else question(t, b, a, misses);
}

/* An edge that goes from one square into another is followed there, where all corners may lie beside it. */
static void follow_edges(Tile *t, int columns, int rows) {
    Misses misses = {.count = 0};
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++) {
            if (x + 1 < columns) question_pair(t, place(x, y), place(x + 1, y), &misses);
            if (y + 1 < rows) question_pair(t, place(x, y), place(x, y + 1), &misses);
        }
    while (misses.count > 0) {
        const int here = misses.places[--misses.count], x0 = here % FILM_TILE, y0 = here / FILM_TILE;
        for (int y = int_max(y0 - 1, 0); y <= int_min(y0 + 1, rows - 1); y++)
            for (int x = int_max(x0 - 1, 0); x <= int_min(x0 + 1, columns - 1); x++) question(t, here, place(x, y), &misses);
    }
}

/* ---- the tile ---- */

static bool is_corner(int at, int count) { return at % WIDEST == 0 || at == count - 1; }

static void find_lattice(Tile *t, int columns, int rows) {
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++)
            if (is_corner(x, columns) && is_corner(y, rows)) find(t, x, y);
}

/* Guesses of the kinds that are most wrong are found instead, until what is left may be. */
static void settle(Tile *t, int columns, int rows) {
    struct Kind all = {.guessed = 0};
    double doubts[KINDS], sum = 0;
    for (int k = 0; k < KINDS; k++) all.wrong += t->kinds[k].wrong, all.tried += t->kinds[k].tried;
    for (int k = 0; k < KINDS; k++) {
        const struct Kind *kind = &t->kinds[k];
        doubts[k] = (kind->wrong + PRIOR * (all.tried ? all.wrong / all.tried : 0)) / (kind->tried + PRIOR);
        sum += doubts[k] * kind->guessed;
    }
    while (sum > t->sight->accepted * columns * rows) {
        int worst = 0;
        for (int k = 1; k < KINDS; k++)
            if (doubts[k] * t->kinds[k].guessed > doubts[worst] * t->kinds[worst].guessed) worst = k;
        if (t->kinds[worst].guessed == 0) break;
        sum -= doubts[worst] * t->kinds[worst].guessed;
        t->kinds[worst].guessed = 0;
    }
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++) {
            int kind = t->known[place(x, y)] - LOOKED;
            if (kind < 0) continue;
            kind %= KINDS;
            if (t->kinds[kind].guessed == 0)
                find(t, x, y);
            else
                t->middles[place(x, y)].doubt = (float)doubts[kind];
        }
}

void guess_tile(const GuessSight *sight, int columns, int rows, Middle *out) {
    Tile t = {.sight = sight, .middles = out, .columns = columns, .rows = rows};
    if (!(sight->tolerance > 0) || columns == 1 || rows == 1) {
        find_all(&t, &(Square){0, 0, columns - 1, rows - 1});
        return;
    }
    find_lattice(&t, columns, rows);
    for (int y = 0; y < rows - 1; y += WIDEST)
        for (int x = 0; x < columns - 1; x += WIDEST)
            divide(&t, &(Square){x, y, int_min(x + WIDEST, columns - 1), int_min(y + WIDEST, rows - 1)});
    if (sight->view) follow_edges(&t, columns, rows);
    settle(&t, columns, rows);
}
