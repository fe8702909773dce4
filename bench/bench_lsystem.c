/* How fast L-systems grow: derivation, the turtle, the tubes of branches and the triangles of leaves, on one processor.
 * `bench/bench_lsystem [runs]`; the least time of all runs counts. */
#include "base/stopwatch.h"
#include "grow/turtle.h"
#include "shape/tessellate_branches.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct PlantCase {
    const char *name, *axiom, *rules[4]; /* rules end with NULL */
    int iterations;
    double tolerance;                    /* of the tubes */
} PlantCase;

/* The first is of the size of the tree that N98 draws (2154 branches, 6336 leaves); the second spends its time in many iterations
 * that change little, as trunks with a bud at the top do; the others are large: with parameters and random numbers, and plain. */
static const PlantCase cases[] = {
    {"tree: three branches a fork, random",
     "!(0.3)F(0.8)A(1,0.2)",
     {"A(l,w) : l > 0.08 -> !(w)F(l)[&(rand(25,45))A(l*0.67,w*0.7)][/(120)&(rand(25,45))A(l*0.67,w*0.7)]/(240)&(rand(25,45))A(l*0.67,w*0.7)",
      "A(l,w) -> !(w)F(l)[+(40)L][-(40)L]/(90)[+(40)L]", NULL},
     8, 0.002},
    {"trunk: 400 iterations, 400 branches",
     "!(0.3)T(0)",
     {"T(i) : i < 400 -> F(0.05)/(rand(110,160))[&(70)B(1-i/420)]T(i+1)", "B(l) : l > 0.1 -> !(0.01)F(0.1)^(rand(-9,9))[+(50)L][-(50)L]B(l-0.1)", NULL},
     420, 0.002},
    {"10^6 segments: parameters, random",
     "!(0.3)A(4,0.2)",
     {"A(l,w) -> !(w)F(l*0.3)^(rand(-9,9))F(l*0.2)^(rand(-9,9))F(l*0.3)^(rand(-9,9))F(l*0.2)"
      "[&(rand(25,45))A(l*0.7,w*0.7)][/(120)&(rand(25,45))A(l*0.7,w*0.7)]/(240)&(rand(25,45))A(l*0.7,w*0.7)", NULL},
     12, 10},
    {"10^6 segments: plain letters", "X", {"X -> F[+X]F[-X]+X", "F -> FF", NULL}, 12, 10},
};

typedef struct PlantTimes {
    double derive, turtle, mesh;
} PlantTimes;

typedef struct PlantSizes {
    size_t letters, segments, leaves, triangles;
} PlantSizes;

static void keep_least(double *least, double seconds) { *least = *least > 0 && *least < seconds ? *least : seconds; }

/* Two triangles for a leaf at each place, as the symbol of a scene would have. */
static void mesh_leaves(const TurtlePlaces *places, Arena *arena, TriangleSoup *soup) {
    for (size_t i = 0; i < places->count; i++) {
        const TurtlePlace *p = &places->items[i];
        Vec3 middle = vec3_madd(p->position, p->heading, 0.05 * p->size);
        uint32_t a = soup_vertex(arena, soup, p->position, p->up, 0, 0);
        uint32_t b = soup_vertex(arena, soup, vec3_madd(middle, p->left, 0.03), p->up, 0, 0);
        uint32_t c = soup_vertex(arena, soup, vec3_madd(middle, p->left, -0.03), p->up, 0, 0);
        uint32_t d = soup_vertex(arena, soup, vec3_madd(p->position, p->heading, 0.1), p->up, 0, 0);
        soup_triangle(arena, soup, a, b, d, false);
        soup_triangle(arena, soup, a, d, c, false);
    }
}

static bool grow(const PlantCase *plant, PlantTimes *times, PlantSizes *sizes) {
    static const TurtleSettings settings = {.angle = 25, .step = 0.05, .width = 0.02, .taper = 0.7, .tropism = {0, -0.03, 0}, .symbols = "L"};
    LSystemText rules[4];
    LSystemSource source = {.axiom = {.text = plant->axiom}, .rules = rules, .iterations = plant->iterations, .most_segments = 10000000};
    for (; plant->rules[source.rule_count]; source.rule_count++) rules[source.rule_count] = (LSystemText){.text = plant->rules[source.rule_count]};
    Arena arena;
    DiagList diags;
    SourceSet sources = {0};
    LSystemWord word;
    arena_init(&arena, NULL, 0);
    diag_init(&diags, &arena, &sources);
    double start = stopwatch_cpu();
    const LSystem *system = lsystem_read(&source, &arena, &diags);
    bool grown = system && lsystem_derive(system, &arena, &diags, NULL, &word);
    if (grown) {
        keep_least(&times->derive, stopwatch_cpu() - start);
        TurtleDrawing *drawing = arena_new(&arena, TurtleDrawing);
        start = stopwatch_cpu();
        turtle_draw(&word, &settings, &arena, drawing);
        keep_least(&times->turtle, stopwatch_cpu() - start);
        TriangleSoup soup = {0};
        const Object branches = {.kind = OBJECT_BRANCHES, .as.branches = {drawing->branches[0].items, drawing->branches[0].count}};
        start = stopwatch_cpu();
        tessellate_branches(&branches, plant->tolerance, &arena, &soup);
        mesh_leaves(&drawing->places, &arena, &soup);
        keep_least(&times->mesh, stopwatch_cpu() - start);
        *sizes = (PlantSizes){word.count, drawing->segments, drawing->places.count, soup.triangles.count};
    }
    arena_destroy(&arena);
    return grown;
}

int main(int argc, char **argv) {
    int runs = argc > 1 ? atoi(argv[1]) : 5;
    printf("%-38s %9s %9s %8s %9s   %8s %8s %8s %8s\n", "milliseconds", "letters", "segments", "leaves", "triangles", "derive", "turtle", "mesh", "all");
    for (size_t i = 0; i < VTS_ARRAY_COUNT(cases); i++) {
        PlantTimes t = {0};
        PlantSizes s = {0};
        for (int run = 0; run < runs; run++)
            if (!grow(&cases[i], &t, &s)) return EXIT_FAILURE;
        printf("%-38s %9zu %9zu %8zu %9zu   %8.1f %8.1f %8.1f %8.1f\n", cases[i].name, s.letters, s.segments, s.leaves, s.triangles, 1e3 * t.derive,
               1e3 * t.turtle, 1e3 * t.mesh, 1e3 * (t.derive + t.turtle + t.mesh));
    }
    return EXIT_SUCCESS;
}
