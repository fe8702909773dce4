/* Values of the language: whatever #declare can name. */
#ifndef VTS_EVAL_VALUE_H
#define VTS_EVAL_VALUE_H

#include "base/intern.h"
#include "scene/scene.h"
#include "tape/tape.h"

typedef enum ValueKind {
    VALUE_ERROR, /* an error was reported where it came from: whoever meets it stays silent */
    VALUE_FLOAT,
    VALUE_VECTOR, /* 2 to 5 components */
    VALUE_COLOR,  /* 5 components: red, green, blue, filter, transmit */
    VALUE_STRING,
    VALUE_ARRAY,
    VALUE_DICTIONARY, /* as.array, with keys */
    VALUE_FUNCTION,
    VALUE_SPLINE,
    VALUE_TRANSFORM,
    VALUE_FILE,
    VALUE_MACRO,
    /* nodes of the scene graph */
    VALUE_OBJECT, VALUE_LIGHT, VALUE_CAMERA, VALUE_TEXTURE, VALUE_PIGMENT, VALUE_NORMAL, VALUE_FINISH, VALUE_INTERIOR,
    VALUE_MATERIAL, VALUE_COLOR_MAP, VALUE_FOG, VALUE_RAINBOW, VALUE_SKY_SPHERE, VALUE_TEXEL, VALUE_SURFACE, VALUE_SKIN, VALUE_WIND_FIELD,
    VALUE_BLOCK, /* a block without a builder of its own: its items, for the block around it (mapping { … } of a skin) */
} ValueKind;

typedef struct Array Array;
typedef struct Spline Spline;
typedef struct UserFunction UserFunction;
typedef struct Macro Macro;
typedef struct UserFile UserFile;
typedef struct EvalBlock EvalBlock;

typedef struct ColorMap {
    Span span;
    const ColorMapEntry *entries; /* sorted by position */
    size_t count;
} ColorMap;

typedef struct SkySphere {
    const Pigment *const *layers;
    size_t count;
    Color emission; /* times which they are bright */
} SkySphere;

typedef struct Value {
    ValueKind kind;
    uint8_t size; /* components of a vector or colour */
    union {
        double number;
        const double *components; /* VECTOR, COLOR: `size` doubles in the arena */
        struct { const char *text; size_t length; } string;
        Array *array;
        const UserFunction *function;
        const Spline *spline;
        const Transform *transform;
        UserFile *file;
        const Macro *macro;
        const Object *object;
        const Light *light;
        const Camera *camera;
        const Texture *texture;
        const Pigment *pigment;
        const Normal *normal;
        const Finish *finish;
        const Interior *interior;
        const ColorMap *color_map;
        const Fog *fog;
        const Rainbow *rainbow;
        const SkySphere *sky_sphere;
        const TexelDef *texel;
        const Surface *surface;
        const Skin *skin;
        const WindField *wind_field;
        const EvalBlock *block;
        const void *node;
    } as;
} Value;

/* function(x, y, …) { expr } as seen by builders. */
struct UserFunction {
    Span span;
    const Tape *tape; /* inputs: the parameters in order; outputs: 1, or 3 for a vector body */
    int parameter_count;
    const Name *parameters;
    int columns, rows; /* function 300, 300 { … }: of the picture that it stands for; else 0 */
};

/* Arrays as seen by builders: rank 1 is a list; of a jagged array the extents of the first rows count. The element at `count`
 * indices, or NULL when it is out of range or was never set. */
int array_rank(const Array *array);
size_t array_extent(const Array *array, int dimension);
const Value *array_element(const Array *array, const size_t *indices, int count);

/* What a value is called in messages: "a float", "a vector", "a texel" … */
const char *value_kind_text(ValueKind kind);

#endif
