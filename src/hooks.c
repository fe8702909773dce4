#include "hooks.h"

#include "pattern/pattern_function.h"

static bool pigment_function(void *context, Arena *arena, const Pigment *pigment, TapeExternal *out) {
    (void)context, (void)arena;
    *out = pigment_external(pigment);
    return true;
}

static bool pattern_function(void *context, Arena *arena, const Pigment *pattern, TapeExternal *out) {
    (void)context, (void)arena;
    *out = pattern_external(pattern);
    return true;
}

static const EvalGeometry geometry = {
    .pigment_function = pigment_function,
    .pattern_function = pattern_function,
};

const EvalGeometry *hooks_geometry(void) { return &geometry; }
