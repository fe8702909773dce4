/* Cloth: a sheet of masses and springs, after Provot ("Deformation constraints in a mass-spring model", 1995), in the wind.
 *
 * Masses stand at the corners of nu × nv cells. Springs join those beside each other (structural), across from each other in a
 * cell (shear) and two apart (bending); none of the first two kinds is ever stretched further than `elongation` allows.
 *
 * How it moves is told in spring_net.h, by 16 steps a tick or more. */
#ifndef VTS_GROW_CLOTH_H
#define VTS_GROW_CLOTH_H

#include "grow/spring_net.h"
#include "scene/scene.h"

enum {
    CLOTH_PIN_LEFT = 1,
    CLOTH_PIN_RIGHT = 2,
    CLOTH_PIN_TOP = 4,
    CLOTH_PIN_BOTTOM = 8,
    CLOTH_PIN_CORNERS = 16,
};

typedef struct ClothSpec {
    double width, height; /* along x and y; > 0 */
    int nu, nv;           /* cells along both; >= 1 */
    unsigned pins;        /* CLOTH_PIN_…: these masses never move */
    double mass;          /* of the whole sheet; > 0 */
    double stiffness;     /* force for each unit of width at which the sheet would be twice as long; >= 0 */
    double shear, bend;   /* shares of it that the other springs have */
    double damping;       /* share of its speed that a mass loses, a second; >= 0 */
    double elongation;    /* a spring may be so much longer, relative to its rest; >= 0 */
    Vec3 gravity;
    double unrest;        /* speed at the start out of the plane, random, so that it can fold; of the shorter side, a second */
    const WindField *wind; /* force for each unit of area; NULL */
} ClothSpec;

/* What `cloth { }` has without a word: 1 × 1, 16 × 16 cells, mass 0.2 … */
ClothSpec cloth_default(void);

/* At rest in the plane z = 0, centred at the origin, at time 0: cloth_mass_count() masses, index i·(nv + 1) + j, i along x, j along y. Lives in
 * `arena`; the wind of `spec` must live as long. */
SpringNet *cloth_create(const ClothSpec *spec, Arena *arena);

static inline size_t cloth_mass_count(const ClothSpec *spec) { return ((size_t)spec->nu + 1) * ((size_t)spec->nv + 1); }
/* Spring evaluations for one second: what following a cloth costs, about 15 ns each. */
double cloth_work(const ClothSpec *spec);
/* All that the sheet's movement depends on. */
Hash128 cloth_spec_hash(const ClothSpec *spec);
/* The longest structural or shear spring, relative to its rest. */
double cloth_longest(const SpringNet *cloth);

#endif
