/* Masses joined by springs, followed through time: what cloth and the tips of height vectors are made of.
 *
 * Time goes in ticks of 1/NET_TICKS s, and each tick in steps of position-based dynamics with compliant springs (Macklin, Müller &
 * Chentanez 2016; Macklin et al. 2019, "Small steps"): implicit, hence stable for springs of any stiffness. What it does not
 * keep by itself is kept by a rule: the energy never passes that of the start and the work of the forces.
 *
 * The state at a time depends on nothing but the net and the time: ticks are counted from the start, whichever times are asked for. */
#ifndef VTS_GROW_SPRING_NET_H
#define VTS_GROW_SPRING_NET_H

#include "base/arena.h"
#include "base/hash.h"
#include "base/vec.h"

#include <stdatomic.h>

enum { NET_TICKS = 120 };

typedef struct NetSpring {
    uint32_t a, b;
    double rest, compliance;  /* inverse stiffness; 0: rigid; HUGE_VAL: none, the spring only bounds */
    double longest;           /* HUGE_VAL: no bound */
    double multiplier;        /* in a step: force · step² */
    double force, tick_force; /* in the last one, < 0: it pulls; at the last tick */
} NetSpring;

typedef struct NetMass {
    Vec3 place, speed, next;
    double mass, weight; /* weight: inverse mass; 0: it never moves */
    Vec3 blown;          /* force from outside in this tick */
} NetMass;

typedef struct SpringNet {
    NetMass *masses, *ahead; /* ahead: for parts of a tick */
    size_t mass_count;
    NetSpring *springs; /* relaxed in this order: what must hold comes last */
    size_t spring_count;
    bool bounded; /* some have a bound */
    Vec3 gravity;
    double damping; /* share of its speed that a mass loses, a second; >= 0 */
    int steps;      /* of a tick */
    uint64_t tick;
    double limit;   /* of the energy: set at the start */
    /* Sets what is blown at all masses that move; NULL: nothing ever is. `time` in seconds since the start. */
    void (*blow)(struct SpringNet *net, double time);
    const void *context; /* of blow */
} SpringNet;

/* Room for so many, all zero, in `arena`. */
void net_init(SpringNet *net, size_t mass_count, size_t most_springs, Arena *arena);

/* Goes on to the last tick before `time` (seconds; what lies before now is left), then writes the places of the first `count` masses at `time`
 * to `places`. False when *interrupted (may be NULL) became true. */
bool net_follow(SpringNet *net, double time, const atomic_bool *interrupted, size_t count, Vec3 *places);

/* The tick that net_follow() goes to for a time. */
uint64_t net_tick_of(double time);

/* What changes with time, as numbers: so many. A net made alike goes on from them as if it had come there itself. */
size_t net_state_count(const SpringNet *net);
void net_save_state(const SpringNet *net, double *state);
/* False, and nothing changes, when they cannot be a state of this net's: not finite, or at no tick. */
bool net_load_state(SpringNet *net, const double *state);

/* Of the masses as they are: kinetic, of their heights, and of the springs' forces. */
double net_energy(const SpringNet *net);

/* States of nets that were followed before, kept by whoever knows of frames. */
typedef struct NetStates {
    /* Puts the net into the latest kept state not after `tick`, if there is one after its own. */
    void (*find)(void *context, Hash128 key, uint64_t tick, SpringNet *net);
    /* Keeps its state. `asked`: it is at the time that was asked for, else passes it on its way. */
    void (*keep)(void *context, Hash128 key, const SpringNet *net, bool asked);
    void *context;
} NetStates;

/* net_follow() from the best state that is known for `key`, by those that are to be kept: one each second. `states` NULL: from where it is. */
bool net_follow_by_states(SpringNet *net, Hash128 key, const NetStates *states, double time, const atomic_bool *interrupted, size_t count,
                          Vec3 *places);

#endif
