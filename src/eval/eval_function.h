/* Functions of the language: what the files that make them share. */
#ifndef VTS_EVAL_EVAL_FUNCTION_H
#define VTS_EVAL_EVAL_FUNCTION_H

#include "eval/eval_state.h"

enum { FUNCTION_INPUTS = 56 };

/* Functions that vts adds, by name: perlin, fbm … They are hidden by whatever a scene declares under their names. */
typedef struct KnownFunction {
    const char *name;
    size_t arguments;
    bool takes_noise; /* the first argument is the name of a noise */
    /* The value of the call for the compiled arguments; false after a report. NULL: not for functions. */
    bool (*compile)(Eval *ev, TapeBuilder *tape, const Node *call, const TapeRef *arguments, size_t count,
                    TapeRef *out);
    Value (*value)(Eval *ev, const Node *call); /* of those that are not for functions */
} KnownFunction;
const KnownFunction *known_function_find(Name name);
/* Whether the call has the right number of arguments (at most 8); reported. */
bool known_function_takes(Eval *ev, const Node *call, const KnownFunction *function);

/* lsystem_string(), lsystem_count() (eval_plant.c). */
Value eval_lsystem_string(Eval *ev, const Node *call);
Value eval_lsystem_count(Eval *ev, const Node *call);
/* wind_at() (build_wind.c). */
Value eval_wind_at(Eval *ev, const Node *call);
/* eval_geo.c */
Value eval_geo(Eval *ev, const Node *call);
Value eval_geo_inverse(Eval *ev, const Node *call);
Value eval_geodesic(Eval *ev, const Node *call);
Value eval_utm(Eval *ev, const Node *call);
Value eval_sun_direction(Eval *ev, const Node *call);
/* terrain_height() (eval_terrain.c). */
Value eval_terrain_height(Eval *ev, const Node *call);

/* A function that is nothing but one external. */
Value external_function(Eval *ev, const Node *node, const TapeExternal *external);
/* function { internal(id) }, function { spline { S } }, function { transform { T } } */
Value internal_function(Eval *ev, const Node *node, int id);
Value spline_function(Eval *ev, const Node *node, const Spline *spline);
Value transform_function(Eval *ev, const Node *node, const Transform *transform);

/* A function of so many parameters, without its tape. */
UserFunction *function_new(Eval *ev, const Node *node, int count);

#endif
