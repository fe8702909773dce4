/* The turtle against closed forms, frequencies of stochastic productions, and the tubes of branches. */
#include "grow/turtle.h"
#include "shape/tessellate.h"

#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

typedef struct Bench {
    Arena arena;
    DiagList diags;
    SourceSet sources;
} Bench;

static int set_up(void **state) {
    static Bench bench;
    memset(&bench, 0, sizeof bench);
    arena_init(&bench.arena, NULL, 0);
    diag_init(&bench.diags, &bench.arena, &bench.sources);
    *state = &bench;
    return 0;
}

static int tear_down(void **state) {
    arena_destroy(&((Bench *)*state)->arena);
    return 0;
}

enum { MOST_RULES = 8 };

/* Derives; `rules` end with NULL. */
static LSystemWord derive(Bench *bench, const char *axiom, const char *const *rules, int iterations, uint64_t seed) {
    LSystemSource *source = arena_new(&bench->arena, LSystemSource);
    LSystemText *texts = arena_new_array(&bench->arena, LSystemText, MOST_RULES);
    *source = (LSystemSource){.axiom = {.text = axiom}, .rules = texts, .iterations = iterations, .seed = seed, .most_segments = 10000000};
    for (; rules && rules[source->rule_count]; source->rule_count++) texts[source->rule_count] = (LSystemText){.text = rules[source->rule_count]};
    LSystem *system = lsystem_read(source, &bench->arena, &bench->diags);
    LSystemWord word;
    assert_non_null(system);
    assert_true(lsystem_derive(system, &bench->arena, &bench->diags, NULL, &word));
    return word;
}

static TurtleDrawing *draw(Bench *bench, const LSystemWord *word, const TurtleSettings *settings) {
    TurtleDrawing *drawing = arena_new(&bench->arena, TurtleDrawing);
    turtle_draw(word, settings, &bench->arena, drawing);
    return drawing;
}

static const TurtleSettings plain = {.angle = 90, .step = 1, .width = 0.1, .taper = 0.7};

/* The dragon curve of order n ends at (1 ± i)ⁿ times its first step. */
static void dragon_ends_where_it_should(void **state) {
    const char *const rules[] = {"X -> X+YF+", "Y -> -FX-Y", NULL};
    for (int n = 0; n <= 14; n++) {
        LSystemWord word = derive(*state, "FX", rules, n, 0);
        const TurtleDrawing *d = draw(*state, &word, &plain);
        const TurtleBranches *b = &d->branches[0];
        Vec3 end = {0, 1, 0};
        for (int k = 0; k < n; k++) end = vec3(end.x - end.y, end.y + end.x, 0); /* `+` turns left, from +y to −x: times i */
        assert_int_equal(d->segments, 1 << n);
        assert_int_equal(b->count, (1 << n) + 1);
        Vec3 last = b->items[b->count - 1].position;
        assert_true(vec3_length(vec3_sub(last, end)) < 1e-9);
    }
}

/* Hilbert's curve in space (ABOP p. 20) visits each cell of a cube once. */
static void hilbert_fills_a_cube(void **state) {
    const char *const rules[] = {"A -> B-F+CFC+F-D&F^D-F+&&CFC+F+B//", "B -> A&F^CFB^F^D^^-F-D^|F^B|FC^F^A//",
                                 "C -> |D^|F^B-F+C^F^A&&FA&F^C+F+B^F^D//", "D -> |CFB-F+B|FA&F^A&&FB-F+B|FC//", NULL};
    enum { ORDER = 3, SIDE = 1 << ORDER, CELLS = SIDE * SIDE * SIDE };
    LSystemWord word = derive(*state, "A", rules, ORDER, 0);
    const TurtleBranches *b = &draw(*state, &word, &plain)->branches[0];
    Vec3 low = b->items[0].position, high = low;
    static bool seen[CELLS];
    memset(seen, 0, sizeof seen);
    assert_int_equal(b->count, CELLS);
    for (size_t i = 0; i < b->count; i++) low = vec3_min(low, b->items[i].position), high = vec3_max(high, b->items[i].position);
    assert_true(vec3_length(vec3_sub(vec3_sub(high, low), vec3_splat(SIDE - 1))) < 1e-9);
    for (size_t i = 0; i < b->count; i++) {
        Vec3 p = vec3_sub(b->items[i].position, low);
        int cell = ((int)lround(p.x) * SIDE + (int)lround(p.y)) * SIDE + (int)lround(p.z);
        assert_false(seen[cell]);
        seen[cell] = true;
    }
}

/* Each turn by itself: where the heading, left and up go. */
static void turns_are_those_of_a_pilot(void **state) {
    static const struct {
        const char *word;
        Vec3 heading, left, up;
    } cases[] = {
        {"S", {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},      {"+S", {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}, {"-S", {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
        {"&S", {0, 0, -1}, {-1, 0, 0}, {0, 1, 0}},    {"^S", {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}}, {"\\S", {0, 1, 0}, {0, 0, -1}, {-1, 0, 0}},
        {"/S", {0, 1, 0}, {0, 0, 1}, {1, 0, 0}},      {"|S", {0, -1, 0}, {1, 0, 0}, {0, 0, 1}},  {"^/(30)$S", {0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
        {"+(360)S", {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}, {"[+&S]S", {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
    };
    TurtleSettings settings = plain;
    settings.symbols = "S";
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        LSystemWord word = derive(*state, cases[i].word, NULL, 0, 0);
        const TurtleDrawing *d = draw(*state, &word, &settings);
        const TurtlePlace *p = &d->places.items[d->places.count - 1];
        assert_true(vec3_length(vec3_sub(p->heading, cases[i].heading)) < 1e-12);
        assert_true(vec3_length(vec3_sub(p->left, cases[i].left)) < 1e-12);
        assert_true(vec3_length(vec3_sub(p->up, cases[i].up)) < 1e-12);
    }
}

/* ABOP p. 58: after each segment the heading turns by e·sin of its angle to the tropism. */
static void tropism_bends_step_by_step(void **state) {
    TurtleSettings settings = plain;
    const double e = 0.22;
    settings.tropism = vec3(0, -e, 0);
    LSystemWord word = derive(*state, "-(10)FFFFFFFFFFFFFFFFFFFF", NULL, 0, 0);
    const TurtleBranches *b = &draw(*state, &word, &settings)->branches[0];
    double angle = 10 * VTS_RADIANS, x = 0, y = 0; /* from straight up */
    for (size_t i = 1; i < b->count; i++) {
        x += sin(angle), y += cos(angle);
        assert_true(hypot(b->items[i].position.x - x, b->items[i].position.y - y) < 1e-12);
        angle += e * sin(angle);
    }
    assert_int_equal(b->count, 21);
}

static void widths_taper_and_chains_go_on_past_branches(void **state) {
    LSystemWord word = derive(*state, "!(2)F[+!F]!(1)F'F", NULL, 0, 0);
    const TurtleDrawing *d = draw(*state, &word, &plain);
    const BranchNode *n = d->branches[0].items;
    assert_int_equal(d->colors, 2);
    assert_int_equal(d->branches[0].count, 5);
    assert_true(n[0].radius == 1 && n[0].previous == BRANCH_FIRST && n[1].previous == 0);
    assert_true(fabs(n[2].radius - 0.7) < 1e-12 && n[2].previous == BRANCH_FIRST && n[3].previous == 2); /* the branch */
    assert_true(n[1].radius == 0.5 && n[4].radius == 0.5 && n[4].previous == 1); /* the stem, which is thinner from there on */
    assert_int_equal(d->branches[1].count, 2);
    word = derive(*state, "F[F%F[F]F]F", NULL, 0, 0);
    assert_int_equal(draw(*state, &word, &plain)->segments, 3);
}

static double leaf_area(const TurtleLeaves *l) {
    double sum = 0;
    for (size_t t = 0; t < l->triangles.count; t++) {
        const uint32_t *v = l->triangles.items[t];
        Vec3 a = l->corners.items[v[0]], b = l->corners.items[v[1]], c = l->corners.items[v[2]];
        sum += vec3_length(vec3_cross(vec3_sub(b, a), vec3_sub(c, a))) / 2;
    }
    return sum;
}

static void polygons_have_their_area(void **state) {
    static const struct {
        const char *word;
        double area;
    } cases[] = {
        {"{f+(60)f+(60)f+(60)f+(60)f+(60)f}", 2.5980762113533160},
        {"{.G.+G.+G.}", 1},
        {"{F+F+F-F+F+F+(0)F(1)+F}", 3},                /* an L: not convex */
        {"[{.][+f.][f.]}", 0.5},                          /* corners from branches */
        {"{f(3)+f(3)+f(3)+f(3)+&{f+f+f+f}}", 10},         /* one within another */
        {"{f(3)+f(3)+f(3)+f(3)+(135)f(1.4142135623730951)+(45)f-f-f-f+(45)f(1.4142135623730951)}", 8}, /* a hole, and a cut to it */
        {"{f}{f f f}", 0},                                /* none: too few corners, and a line */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        LSystemWord word = derive(*state, cases[i].word, NULL, 0, 0);
        assert_true(fabs(leaf_area(&draw(*state, &word, &plain)->leaves[0]) - cases[i].area) < 1e-9);
    }
}

/* χ² of a choice among three, weights 1 : 2 : 5, over 100,000 letters: below the 99.9 % point of two degrees of freedom. */
static void weights_are_frequencies(void **state) {
    const char *const double_it[] = {"A -> AAAAAAAAAA", NULL}, *const choose[] = {"A -> (1) P", "A -> (2) Q", "A -> (5) R", NULL};
    LSystemWord many = derive(*state, "A", double_it, 5, 0);
    char *axiom = arena_copy(&((Bench *)*state)->arena, many.letters, many.count + 1);
    axiom[many.count] = '\0';
    for (uint64_t seed = 1; seed <= 3; seed++) {
        LSystemWord word = derive(*state, axiom, choose, 1, seed);
        const double all = (double)many.count, expected[3] = {all / 8, all / 4, all * 5 / 8};
        double chi = 0;
        for (int k = 0; k < 3; k++) {
            double found = (double)lsystem_count(&word, (char)('P' + k));
            chi += (found - expected[k]) * (found - expected[k]) / expected[k];
        }
        assert_true(chi < 13.8);
    }
}

/* A bent and tapering branch: the tubes' walls against frusta, however coarse; volume and closedness in the limit. */
static void tubes_have_the_area_of_frusta(void **state) {
    LSystemWord word = derive(*state, "!(0.2)F(2)!(0.1)F(2)!(0.05)F(1)", NULL, 0, 0);
    const TurtleBranches *b = &draw(*state, &word, &plain)->branches[0];
    const Object object = {.kind = OBJECT_BRANCHES, .depth = 1, .as.branches = {b->items, b->count}};
    const double radii[4] = {0.1, 0.05, 0.025, 0.025}, lengths[3] = {2, 2, 1};
    double area = VTS_PI * (0.1 * 0.1 + 0.025 * 0.025), volume = 0;
    for (int i = 0; i < 3; i++) {
        double r = radii[i], s = radii[i + 1];
        area += VTS_PI * (r + s) * hypot(lengths[i], r - s);
        volume += VTS_PI * lengths[i] * (r * r + r * s + s * s) / 3;
    }
    for (int k = 0; k < 3; k++) {
        const double tolerances[] = {0.03, 0.003, 0.00003};
        TriangleSoup soup = {0};
        TessellateOptions options = {.tolerance = tolerances[k]};
        assert_true(tessellate(&object, NULL, &options, &((Bench *)*state)->arena, &soup, NULL));
        double soup_area = 0, soup_volume = 0;
        for (size_t t = 0; t < soup.triangles.count; t++) {
            const SoupTriangle *q = &soup.triangles.items[t];
            Vec3 p[3];
            for (int c = 0; c < 3; c++) p[c] = soup.vertices.items[q->vertex[c]].position;
            Vec3 n = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
            soup_area += vec3_length(n) / 2;
            soup_volume += vec3_dot(p[0], n) / 6;
            assert_true(q->solid);
        }
        assert_true(fabs(soup_area / area - 1) < (k == 0 ? 0.04 : 0.01));
        assert_true(soup_volume > 0);
        if (k == 2) assert_true(fabs(soup_volume / volume - 1) < 0.002);
    }
}

/* A mitred bend is as thick as what it joins: the area of a square ring of tube is that of its four sides. */
static void bends_are_mitred(void **state) {
    LSystemWord word = derive(*state, "!(0.2)F+F", NULL, 0, 0);
    const TurtleBranches *b = &draw(*state, &word, &plain)->branches[0];
    const Object object = {.kind = OBJECT_BRANCHES, .depth = 1, .as.branches = {b->items, b->count}};
    TriangleSoup soup = {0};
    TessellateOptions options = {.tolerance = 1e-5};
    assert_true(tessellate(&object, NULL, &options, &((Bench *)*state)->arena, &soup, NULL));
    for (size_t i = 0; i < soup.vertices.count; i++) { /* all on one of two cylinders, or on the ends */
        Vec3 p = soup.vertices.items[i].position;
        double first = hypot(p.x, p.z), second = hypot(p.y - 1, p.z);
        bool end = p.y == 0 || fabs(p.x + 1) < 1e-9;
        assert_true(end || fabs(first - 0.1) < 1e-4 || fabs(second - 0.1) < 1e-4);
    }
}

/* A tree like the 1998 paper's, and what is grown again with another seed. */
static void a_stochastic_plant_depends_on_its_seed_alone(void **state) {
    const char *const rules[] = {"F -> (0.33) F[+F]F[-F]F", "F -> (0.33) F[+F]F", "F -> (0.34) F[-F]F", NULL};
    LSystemWord a = derive(*state, "F", rules, 5, 1), b = derive(*state, "F", rules, 5, 1), c = derive(*state, "F", rules, 5, 2);
    assert_int_equal(a.count, b.count);
    assert_memory_equal(a.letters, b.letters, a.count);
    assert_true(a.count != c.count || memcmp(a.letters, c.letters, a.count) != 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(dragon_ends_where_it_should, set_up, tear_down),
        cmocka_unit_test_setup_teardown(hilbert_fills_a_cube, set_up, tear_down),
        cmocka_unit_test_setup_teardown(turns_are_those_of_a_pilot, set_up, tear_down),
        cmocka_unit_test_setup_teardown(tropism_bends_step_by_step, set_up, tear_down),
        cmocka_unit_test_setup_teardown(widths_taper_and_chains_go_on_past_branches, set_up, tear_down),
        cmocka_unit_test_setup_teardown(polygons_have_their_area, set_up, tear_down),
        cmocka_unit_test_setup_teardown(weights_are_frequencies, set_up, tear_down),
        cmocka_unit_test_setup_teardown(tubes_have_the_area_of_frusta, set_up, tear_down),
        cmocka_unit_test_setup_teardown(bends_are_mitred, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_stochastic_plant_depends_on_its_seed_alone, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
