#include "grow/turtle.h"

#include <math.h>
#include <string.h>

typedef struct TurtleState {
    Vec3 position, heading, left, up;
    double width;
    int color;
    uint32_t last; /* node at `position` that this branch goes on from; BRANCH_FIRST: none */
} TurtleState;

typedef struct Polygon {
    size_t first; /* corner */
} Polygon;

typedef struct Turtle {
    const TurtleSettings *settings;
    Arena *arena;
    TurtleDrawing *out;
    TurtleState now;
    struct { TurtleState *items; size_t count, capacity; } stack;
    struct { Polygon *items; size_t count, capacity; } polygons;
    struct { Vec3 *items; size_t count, capacity; } corners; /* of open polygons, the outer ones first */
} Turtle;

bool turtle_knows(char letter) { return letter && strchr("FfG+-&^\\/|[]{}.!'$%", letter) != NULL; }

/* ---- turns ---- */

static void turn(Vec3 *from, Vec3 *to, double degrees) {
    double c, s;
    if (degrees == 90) c = 0, s = 1; /* curves of right angles close exactly */
    else if (degrees == -90) c = 0, s = -1;
    else if (fabs(degrees) == 180) c = -1, s = 0;
    else c = cos(degrees * VTS_RADIANS), s = sin(degrees * VTS_RADIANS);
    Vec3 a = *from, b = *to;
    *from = vec3_madd(vec3_scale(a, c), b, s);
    *to = vec3_madd(vec3_scale(b, c), a, -s);
}

/* Turns that add up leave a frame that is no longer one, in 10⁵ steps or so. */
static void straighten(TurtleState *t) {
    t->heading = vec3_normalize(t->heading);
    t->left = vec3_normalize(vec3_madd(t->left, t->heading, -vec3_dot(t->left, t->heading)));
    t->up = vec3_cross(t->heading, t->left);
}

/* `$` (ABOP p. 57): left becomes horizontal, up looks up. Heading straight up or down nothing tells which way. */
static void roll_level(TurtleState *t) {
    Vec3 left = vec3_cross(vec3(0, 1, 0), t->heading);
    if (vec3_length_squared(left) < 1e-20) return;
    t->left = vec3_normalize(left);
    t->up = vec3_cross(t->heading, t->left);
}

/* Tropism (ABOP p. 58): a torque heading × tropism, whose length is the angle. */
static void bend(Turtle *turtle) {
    TurtleState *t = &turtle->now;
    Vec3 torque = vec3_cross(t->heading, turtle->settings->tropism);
    double angle = vec3_length(torque);
    if (!(angle > 0)) return;
    Vec3 axis = vec3_scale(torque, 1 / angle);
    double c = cos(angle), s = sin(angle);
    Vec3 *arms[3] = {&t->heading, &t->left, &t->up};
    for (int i = 0; i < 3; i++) { /* Rodrigues */
        Vec3 v = *arms[i], across = vec3_cross(axis, v);
        *arms[i] = vec3_madd(vec3_madd(vec3_scale(v, c), across, s), axis, vec3_dot(axis, v) * (1 - c));
    }
    straighten(t);
}

/* ---- branches ---- */

static TurtleBranches *branches_of(Turtle *turtle) {
    turtle->out->colors = int_max(turtle->out->colors, turtle->now.color + 1);
    return &turtle->out->branches[turtle->now.color];
}

/* From one place to the next. Where a branch goes on, its radius runs from that of one segment to that of the next. */
static void draw_segment(Turtle *turtle, Vec3 to) {
    TurtleState *t = &turtle->now;
    TurtleBranches *list = branches_of(turtle);
    double radius = 0.5 * t->width;
    turtle->out->segments++;
    if (t->last == BRANCH_FIRST) {
        t->last = (uint32_t)list->count;
        *list_push(turtle->arena, list) = (BranchNode){t->position, radius, BRANCH_FIRST};
    }
    list->items[t->last].radius = radius;
    *list_push(turtle->arena, list) = (BranchNode){to, radius, t->last};
    t->last = (uint32_t)list->count - 1;
}

static void add_corner(Turtle *turtle) {
    if (turtle->polygons.count) *list_push(turtle->arena, &turtle->corners) = turtle->now.position;
}

static bool polygon_is_empty(const Turtle *turtle) {
    return turtle->polygons.count && turtle->corners.count == turtle->polygons.items[turtle->polygons.count - 1].first;
}

static void forward(Turtle *turtle, char letter, double length) {
    Vec3 to = vec3_madd(turtle->now.position, turtle->now.heading, length);
    if (!vec3_is_finite(to)) return;
    bool corner = turtle->polygons.count && letter != 'G';
    if (corner && polygon_is_empty(turtle)) add_corner(turtle);
    if (letter == 'G' || (letter == 'F' && !turtle->polygons.count)) draw_segment(turtle, to);
    else turtle->now.last = BRANCH_FIRST;
    turtle->now.position = to;
    if (corner) add_corner(turtle);
    if (letter != 'f') bend(turtle);
}

/* ---- polygons ---- */

static Vec3 newell_normal(const Vec3 *p, size_t count) {
    Vec3 n = {0, 0, 0};
    for (size_t i = 0, j = count - 1; i < count; j = i++) n = vec3_add(n, vec3_cross(p[j], p[i]));
    return n;
}

static double turn_at(const Vec3 *p, Vec3 normal, uint32_t a, uint32_t b, uint32_t c) {
    return vec3_dot(normal, vec3_cross(vec3_sub(p[b], p[a]), vec3_sub(p[c], p[b])));
}

static bool in_ear(const Vec3 *p, Vec3 n, uint32_t a, uint32_t b, uint32_t c, uint32_t q) {
    return turn_at(p, n, a, b, q) > 0 && turn_at(p, n, b, c, q) > 0 && turn_at(p, n, c, a, q) > 0;
}

/* Cuts off ears, as seen along the mean normal; where none is left (an outline that crosses itself) any corner. */
static void fill(Turtle *turtle, const Vec3 *p, uint32_t count) {
    TurtleLeaves *leaves = &turtle->out->leaves[turtle->now.color];
    uint32_t base = (uint32_t)leaves->corners.count, left = count, i = 0, tried = 0;
    uint32_t *ring = arena_new_array(turtle->arena, uint32_t, count);
    Vec3 normal = newell_normal(p, count);
    turtle->out->colors = int_max(turtle->out->colors, turtle->now.color + 1);
    for (uint32_t k = 0; k < count; k++) {
        ring[k] = k;
        *list_push(turtle->arena, &leaves->corners) = p[k];
    }
    while (left >= 3) {
        uint32_t a = ring[i % left], b = ring[(i + 1) % left], c = ring[(i + 2) % left];
        bool ear = turn_at(p, normal, a, b, c) > 0;
        for (uint32_t k = 3; k < left && ear; k++) ear = !in_ear(p, normal, a, b, c, ring[(i + k) % left]);
        if (!ear && left > 3 && ++tried < left) {
            i++;
            continue;
        }
        uint32_t *triangle = *list_push(turtle->arena, &leaves->triangles);
        triangle[0] = base + a, triangle[1] = base + b, triangle[2] = base + c;
        uint32_t gone = (i + 1) % left;
        memmove(ring + gone, ring + gone + 1, (left - gone - 1) * sizeof *ring);
        left--;
        tried = 0;
        if (gone < i % (left + 1)) i--;
        i %= left;
    }
}

static void close_polygon(Turtle *turtle) {
    if (!turtle->polygons.count) return;
    size_t first = turtle->polygons.items[--turtle->polygons.count].first, count = turtle->corners.count - first;
    const Vec3 *corners = turtle->corners.items + first;
    while (count > 1 && vec3_length(vec3_sub(corners[count - 1], corners[0])) == 0) count--;
    if (count >= 3 && count < 65536) fill(turtle, corners, (uint32_t)count);
    turtle->corners.count = first;
}

/* ---- letters ---- */

static void place_symbol(Turtle *turtle, char letter, double size) {
    const TurtleState *t = &turtle->now;
    *list_push(turtle->arena, &turtle->out->places) = (TurtlePlace){letter, size, t->position, t->heading, t->left, t->up};
}

/* The end of this branch: the next ']' that closes it, or the end of the word. */
static size_t skip_branch(const LSystemWord *word, size_t i) {
    int depth = 0;
    for (; i < word->count; i++) {
        if (word->letters[i] == '[') depth++;
        if (word->letters[i] == ']' && depth-- == 0) break;
    }
    return i;
}

static void push(Turtle *turtle) {
    *list_push(turtle->arena, &turtle->stack) = turtle->now;
    turtle->now.last = BRANCH_FIRST; /* a branch begins; what bears it goes on where it was */
}

static void pop(Turtle *turtle) {
    if (turtle->stack.count) turtle->now = turtle->stack.items[--turtle->stack.count];
}

static void set_color(Turtle *turtle, double color) {
    int wanted = (int)double_clamp(floor(color + 0.5), 0, TURTLE_MOST_COLORS - 1);
    if (wanted != turtle->now.color) turtle->now.last = BRANCH_FIRST;
    turtle->now.color = wanted;
}

static void set_width(Turtle *turtle, double width) { turtle->now.width = isfinite(width) ? fabs(width) : turtle->now.width; }

/* One letter; `parameter` NULL: it has none. */
static void obey(Turtle *turtle, char letter, const double *parameter) {
    const TurtleSettings *s = turtle->settings;
    TurtleState *t = &turtle->now;
    double angle = parameter ? *parameter : s->angle;
    switch (letter) {
    case 'F':
    case 'G':
    case 'f': forward(turtle, letter, parameter ? *parameter : s->step); break;
    case '+': turn(&t->heading, &t->left, angle); break;
    case '-': turn(&t->heading, &t->left, -angle); break;
    case '&': turn(&t->heading, &t->up, -angle); break;
    case '^': turn(&t->heading, &t->up, angle); break;
    case '\\': turn(&t->up, &t->left, angle); break;
    case '/': turn(&t->up, &t->left, -angle); break;
    case '|': turn(&t->heading, &t->left, 180); break;
    case '$': roll_level(t); break;
    case '!': set_width(turtle, parameter ? *parameter : t->width * s->taper); break;
    case '\'': set_color(turtle, parameter ? *parameter : t->color + 1); break;
    case '[': push(turtle); break;
    case ']': pop(turtle); break;
    case '{': *list_push(turtle->arena, &turtle->polygons) = (Polygon){turtle->corners.count}; break;
    case '.': add_corner(turtle); break;
    case '}': close_polygon(turtle); break;
    default:
        if (s->symbols && (!parameter || *parameter != 0) && strchr(s->symbols, letter)) place_symbol(turtle, letter, parameter ? *parameter : 1);
    }
}

void turtle_draw(const LSystemWord *word, const TurtleSettings *settings, Arena *arena, TurtleDrawing *out) {
    Turtle turtle = {.settings = settings, .arena = arena, .out = out};
    turtle.now = (TurtleState){.heading = vec3(0, 1, 0), .left = vec3(-1, 0, 0), .up = vec3(0, 0, 1), .width = settings->width,
                               .last = BRANCH_FIRST};
    memset(out, 0, sizeof *out);
    for (size_t i = 0; i < word->count; i++) {
        if (word->letters[i] == '%') {
            i = skip_branch(word, i);
            if (i == word->count) break;
        }
        const double *parameter = word->first[i + 1] > word->first[i] ? &word->parameters[word->first[i]] : NULL;
        obey(&turtle, word->letters[i], parameter);
    }
}
