#include "scene/knobs.h"

#include <string.h>

const NamedKnob named_knobs[NAMED_KNOB_COUNT] = {
    {"opacity_model", offsetof(GlobalSettings, opacity_model), {"correlated", "exponential", "mean"}},
    {"quadrature", offsetof(GlobalSettings, quadrature), {"ring8", "ring16", "grid16", "lune"}},
    {"filtering", offsetof(GlobalSettings, filtering), {"linear", "published"}},
    {"ray_path", offsetof(GlobalSettings, ray_path), {"box", "straight", "exact"}},
    {"detail", offsetof(GlobalSettings, detail), {"auto", "exact", "voxels", "slab"}},
};

const NamedKnob *named_knob_find(const char *name) {
    for (size_t i = 0; i < NAMED_KNOB_COUNT; i++)
        if (strcmp(named_knobs[i].name, name) == 0) return &named_knobs[i];
    return NULL;
}

const char *named_knob_value(const NamedKnob *knob, const char *value) {
    for (const char *const *v = knob->values; *v; v++)
        if (strcmp(*v, value) == 0) return *v;
    return NULL;
}

const char *named_knob_get(const NamedKnob *knob, const GlobalSettings *settings) {
    const char *value;
    memcpy(&value, (const char *)settings + knob->offset, sizeof value);
    return value ? value : knob->values[0];
}

void named_knob_set(const NamedKnob *knob, GlobalSettings *settings, const char *value) {
    memcpy((char *)settings + knob->offset, &value, sizeof value);
}
