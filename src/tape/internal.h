/* The functions that POV-Ray's functions.inc names by number: function { internal(N) }. Pure; values are POV-Ray's 3.7. */
#ifndef VTS_TAPE_INTERNAL_H
#define VTS_TAPE_INTERNAL_H

#include "tape/noise.h"

/* p[0 … 2] are x, y, z, the rest the function's own parameters. Whatever they are, a number comes back (perhaps NaN). */
typedef double InternalEval(const double *p);

enum { INTERNAL_INPUTS = 13 }; /* the most that any takes */

typedef struct InternalFunction {
    int number;
    const char *name;
    int inputs;
    InternalEval *eval;
} InternalFunction;

/* NULL: there is no such number. */
const InternalFunction *internal_find(int number);
/* All of them, in order of their numbers; for tests and tables. */
const InternalFunction *internal_all(size_t *count);

/* ---- internal_algebraic.c: clamped polynomials; internal_profile.c: plane curves, swept round the y axis if asked ---- */
InternalEval internal_bicorn, internal_bifolia, internal_boy_surface, internal_crossed_trough, internal_cubic_saddle,
    internal_cushion, internal_devils_curve, internal_dupin_cyclid, internal_enneper, internal_folium_surface, internal_glob,
    internal_heart, internal_hunt_surface, internal_hyperbolic_torus, internal_kampyle_of_eudoxus, internal_klein_bottle,
    internal_kummer_surface_v1, internal_kummer_surface_v2, internal_lemniscate_of_gerono, internal_mitre,
    internal_nodal_cubic, internal_odd, internal_ovals_of_cassini, internal_paraboloid, internal_parabolic_torus,
    internal_pillow, internal_piriform, internal_quartic_paraboloid, internal_quartic_saddle, internal_quartic_cylinder,
    internal_steiners_roman, internal_strophoid, internal_torus2, internal_torus_gumdrop, internal_umbrella,
    internal_witch_of_agnesi;
InternalEval internal_algbr_cyl1, internal_algbr_cyl2, internal_algbr_cyl3, internal_algbr_cyl4, internal_devils_curve_2d,
    internal_folium_surface_2d, internal_kampyle_of_eudoxus_2d, internal_lemniscate_of_gerono_2d, internal_piriform_2d,
    internal_strophoid_2d, internal_witch_of_agnesi_2d;

/* ---- internal_shape.c ---- */
InternalEval internal_blob, internal_blob2, internal_comma, internal_cross_ellipsoids, internal_ellipsoid,
    internal_flange_cover, internal_helical_torus, internal_helix1, internal_helix2, internal_hex_x, internal_hex_y,
    internal_isect_ellipsoids, internal_mesh1, internal_ph, internal_poly4, internal_polytubes, internal_quantum, internal_r,
    internal_rounded_box, internal_sphere, internal_spikes, internal_spikes_2d, internal_spiral, internal_superellipsoid,
    internal_th, internal_torus;

/* ---- internal_noise.c: the last parameter is the noise generator, where there is one ---- */
InternalEval internal_hetero_mf, internal_ridge, internal_ridged_mf, internal_noise3d, internal_noise_generator;

#endif
