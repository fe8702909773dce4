/* Cloth: a sheet of masses and springs, after Provot ("Deformation constraints in a mass-spring model", 1995), in the wind.
 *
 * Masses stand at the corners of nu × nv cells. Springs join those beside each other (structural), across from each other in a
 * cell (shear) and two apart (bending); none of the first two kinds is ever stretched further than `elongation` allows.
 *
 * Time goes in ticks of 1/CLOTH_TICKS s, and each tick in 16 steps or more of position-based dynamics with compliant springs
 * (Macklin, Müller & Chentanez 2016; Macklin et al. 2019, "Small steps"): implicit, hence stable for springs of any stiffness.
 * What it does not keep by itself is kept by a rule: the energy never passes that of the start and the work of the wind.
 *
 * The state at a time depends on nothing but the sheet and the time: ticks are counted from the start, whichever times are
 * asked for. */
#ifndef VTS_GROW_CLOTH_H
#define VTS_GROW_CLOTH_H

#include "base/arena.h"
#include "scene/scene.h"

#include <stdatomic.h>

enum { CLOTH_TICKS = 120 };

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

typedef struct Cloth Cloth;

/* At rest in the plane z = 0, centred at the origin, at time 0. Lives in `arena`; the wind of `spec` must live as long. */
Cloth *cloth_create(const ClothSpec *spec, Arena *arena);

static inline size_t cloth_mass_count(const ClothSpec *spec) { return ((size_t)spec->nu + 1) * ((size_t)spec->nv + 1); }
/* Spring evaluations for one second: what following a cloth costs, about 15 ns each. */
double cloth_work(const ClothSpec *spec);

/* Goes on to the last tick before `time` (seconds; what lies before now is left), then writes the places at `time` to `places`
 * (cloth_mass_count(); index i·(nv + 1) + j, i along x, j along y). False when *interrupted (may be NULL) became true. */
bool cloth_follow(Cloth *cloth, double time, const atomic_bool *interrupted, Vec3 *places);

uint64_t cloth_tick(const Cloth *cloth);
/* The tick that cloth_follow() goes to for a time. */
uint64_t cloth_tick_of(double time);
/* All that the sheet's movement depends on. */
Hash128 cloth_spec_hash(const ClothSpec *spec);

/* What changes with time, as numbers: so many. A sheet of the same spec goes on from them as if it had come there itself. */
size_t cloth_state_count(const Cloth *cloth);
void cloth_save_state(const Cloth *cloth, double *state);
/* False, and nothing changes, when they cannot be a state of this sheet's: not finite, or at no tick. */
bool cloth_load_state(Cloth *cloth, const double *state);

/* Of the masses as they are: kinetic, of their heights (0 at rest), and of the springs' forces. */
double cloth_energy(const Cloth *cloth);
/* What the energy may be: that of the start and what the wind has done since. */
double cloth_energy_limit(const Cloth *cloth);
/* The longest structural or shear spring, relative to its rest. */
double cloth_longest(const Cloth *cloth);

#endif
