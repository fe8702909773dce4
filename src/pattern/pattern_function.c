#include "pattern/pattern_function.h"

#include "pattern/pattern.h"

enum { KIND_COLOR = 0x636F6C6F, KIND_VALUE = 0x76616C75 };

static void eval_color(const void *data, const double *in, double *out) {
    Color c = pigment_color(data, vec3(in[0], in[1], in[2]), vec3_splat(0), 0);
    out[0] = c.red, out[1] = c.green, out[2] = c.blue, out[3] = c.filter, out[4] = c.transmit;
}

static void eval_value(const void *data, const double *in, double *out) {
    out[0] = pigment_value(data, vec3(in[0], in[1], in[2]), vec3_splat(0));
}

static TapeExternal external(const Pigment *pigment, const char *name, uint64_t kind, int outputs,
                             void (*eval)(const void *, const double *, double *)) {
    TapeExternal e = {.name = name, .input_count = 3, .output_count = outputs, .eval = eval, .data = pigment, .depth = pigment->depth, .work = pigment->work};
    e.hash = hash_begin(kind);
    hash_add_hash(&e.hash, pigment->hash);
    return e;
}

TapeExternal pigment_external(const Pigment *pigment) {
    return external(pigment, "pigment", KIND_COLOR, 5, eval_color);
}

TapeExternal pattern_external(const Pigment *pattern) {
    return external(pattern, "pattern", KIND_VALUE, 1, eval_value);
}
