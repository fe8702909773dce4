/* The knobs of accuracy that choose between methods by name, for global_settings, --set and charts. */
#ifndef VTS_SCENE_KNOBS_H
#define VTS_SCENE_KNOBS_H

#include "scene/scene.h"

enum { KNOB_MOST_VALUES = 5 };

typedef struct NamedKnob {
    const char *name;
    size_t offset;                        /* of a const char * in GlobalSettings: one of the values, or NULL for the default */
    const char *values[KNOB_MOST_VALUES]; /* the default first; ended by NULL */
} NamedKnob;

enum { NAMED_KNOB_COUNT = 5 };
extern const NamedKnob named_knobs[NAMED_KNOB_COUNT];

/* NULL when there is none of this name. */
const NamedKnob *named_knob_find(const char *name);
/* The knob's own text for a value, or NULL. */
const char *named_knob_value(const NamedKnob *knob, const char *value);
/* The value that is set, the default if none is. */
const char *named_knob_get(const NamedKnob *knob, const GlobalSettings *settings);
/* `value` as named_knob_value() gave it. */
void named_knob_set(const NamedKnob *knob, GlobalSettings *settings, const char *value);

#endif
