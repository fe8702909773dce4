#include "render/guess.h"

#include "base/random.h"

/* Squares of this size are tried first. */
enum { WIDEST = 4 };
/* What is seen between corners is as smooth a part of the same surface. */
static const float SAME_NORMAL = 0.98f;
/* One guess of so many is tried. */
enum { TRIED = 16 };

typedef enum Known { UNKNOWN, GUESSED, FOUND } Known;

typedef struct Tile {
    const GuessSight *sight;
    Middle *middles;
    uint8_t known[FILM_TILE * FILM_TILE];
    double wrong; /* sum of squared errors of the guesses tried, */
    int tried;    /* so many */
} Tile;

static int place(int x, int y) { return y * FILM_TILE + x; }

static Vec3f shown(const Middle *m) {
    Vec3f c = m->seen.color;
    return vec3f(float_clamp(c.x, 0, 1), float_clamp(c.y, 0, 1), float_clamp(c.z, 0, 1));
}

static bool same_surface(const Middle *m, uint32_t object, Vec3f normal) {
    return m->object == object && (object == 0 || vec3f_dot(m->normal, normal) > SAME_NORMAL);
}

static Radiance mean_light(const Guess *guess) {
    Radiance out = {{0, 0, 0}, 0};
    for (int k = 0; k < 4; k++) {
        out.color = vec3f_madd(out.color, guess->corners[k]->seen.color, guess->weights[k]);
        out.alpha += guess->corners[k]->seen.alpha * guess->weights[k];
    }
    return out;
}

bool guess_light(const Guess *guess, uint32_t object, Vec3f normal, Radiance *out) {
    for (int k = 0; k < 4; k++)
        if (!same_surface(guess->corners[k], object, normal)) return false;
    *out = mean_light(guess);
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

static Guess guess_at(const Tile *t, const Square *s, int x, int y) {
    float u = (float)(x - s->x0) / (float)(s->x1 - s->x0), v = (float)(y - s->y0) / (float)(s->y1 - s->y0);
    Guess guess = {.weights = {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}};
    corners_of(t, s, guess.corners);
    return guess;
}

static Vec3f error_of(const Radiance *guessed, const Middle *m) {
    return vec3f_sub(shown(&(Middle){.seen = *guessed}), shown(m));
}

/* Whether the corners and the middle, which is found for this, see the same surface, and its light there is what they tell: an edge that
 * parts them would show, and how much the light curves does. */
static bool agree(Tile *t, const Square *s, int mx, int my) {
    const Middle *corners[4], *middle = &t->middles[place(mx, my)];
    Radiance guessed;
    corners_of(t, s, corners);
    for (int k = 1; k < 4; k++)
        if (!same_surface(corners[k], corners[0]->object, corners[0]->normal)) return false;
    find(t, mx, my);
    const Guess guess = guess_at(t, s, mx, my);
    if (!guess_light(&guess, middle->object, middle->normal, &guessed)) return false;
    Vec3f off = error_of(&guessed, middle);
    return (double)float_max(fabsf(off.x), float_max(fabsf(off.y), fabsf(off.z))) <= t->sight->tolerance;
}

/* Finds what could have been guessed, for all the others. */
static void try_guess(Tile *t, const Guess *guess, int x, int y) {
    Middle *m = &t->middles[place(x, y)];
    Radiance guessed;
    find(t, x, y);
    if (!guess_light(guess, m->object, m->normal, &guessed)) return;
    Vec3f off = error_of(&guessed, m);
    t->wrong += (double)vec3f_dot(off, off) / 3;
    t->tried++;
}

/* Of what the corners see, in their light. */
static void put_guess(Tile *t, const Guess *guess, int x, int y) {
    Middle *m = &t->middles[place(x, y)];
    *m = *guess->corners[0];
    Vec3f normal = {0, 0, 0};
    m->seen = mean_light(guess);
    for (int k = 0; k < 4; k++) normal = vec3f_madd(normal, guess->corners[k]->normal, guess->weights[k]);
    float length = vec3f_length(normal);
    if (length > 0) m->normal = vec3f_scale(normal, 1 / length);
}

static void fill(Tile *t, const Square *s) {
    const GuessSight *sight = t->sight;
    bool even = sight->even && sight->even(sight->context, s->x0, s->y0, s->x1, s->y1,
                                           t->middles[place(s->x0, s->y0)].object);
    for (int y = s->y0; y <= s->y1; y++)
        for (int x = s->x0; x <= s->x1; x++) {
            if (t->known[place(x, y)] != UNKNOWN) continue;
            const Guess guess = guess_at(t, s, x, y);
            if (random_hash((uint64_t)x, (uint64_t)y, 0, 0) % TRIED == 0) {
                try_guess(t, &guess, x, y);
                continue;
            }
            if (even)
                put_guess(t, &guess, x, y);
            else
                sight->see(sight->context, x, y, &guess, &t->middles[place(x, y)]);
            t->known[place(x, y)] = GUESSED;
        }
}

static void find_all(Tile *t, const Square *s) {
    for (int y = s->y0; y <= s->y1; y++)
        for (int x = s->x0; x <= s->x1; x++) find(t, x, y);
}

/* The square's corners are found. */
static void divide(Tile *t, const Square *s) {
    int width = s->x1 - s->x0, height = s->y1 - s->y0, mx = s->x0 + width / 2, my = s->y0 + height / 2;
    if (width <= 1 || height <= 1) {
        find_all(t, s);
        return;
    }
    if (agree(t, s, mx, my)) {
        fill(t, s);
        return;
    }
    for (int k = 0; k < 9; k++)
        find(t, k % 3 == 0 ? s->x0 : k % 3 == 1 ? mx : s->x1, k / 3 == 0 ? s->y0 : k / 3 == 1 ? my : s->y1);
    divide(t, &(Square){s->x0, s->y0, mx, my});
    divide(t, &(Square){mx, s->y0, s->x1, my});
    divide(t, &(Square){s->x0, my, mx, s->y1});
    divide(t, &(Square){mx, my, s->x1, s->y1});
}

/* ---- the tile ---- */

static void find_lattice(Tile *t, int columns, int rows) {
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++)
            if (x == 0 || y == 0 || x == columns - 1 || y == rows - 1 || (x % WIDEST == 0 && y % WIDEST == 0))
                find(t, x, y);
}

void guess_tile(const GuessSight *sight, int columns, int rows, Middle *out) {
    Tile t = {.sight = sight, .middles = out};
    if (!(sight->tolerance > 0)) {
        find_all(&t, &(Square){0, 0, columns - 1, rows - 1});
        return;
    }
    find_lattice(&t, columns, rows);
    for (int y = 0; y < rows - 1; y += WIDEST)
        for (int x = 0; x < columns - 1; x += WIDEST)
            divide(&t, &(Square){x, y, int_min(x + WIDEST, columns - 1), int_min(y + WIDEST, rows - 1)});
    double doubt = t.tried ? t.wrong / t.tried : 0;
    for (int y = 0; y < rows; y++)
        for (int x = 0; x < columns; x++) {
            if (t.known[place(x, y)] != GUESSED) continue;
            if (doubt > sight->accepted)
                find(&t, x, y);
            else
                out[place(x, y)].doubt = (float)doubt;
        }
}
