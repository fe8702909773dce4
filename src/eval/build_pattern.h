/* Patterns' words, for the builder of pigments. */
#ifndef VTS_EVAL_BUILD_PATTERN_H
#define VTS_EVAL_BUILD_PATTERN_H

#include "eval/build_parts.h"

/* A pigment under construction. Block patterns collect their colours in `items`. */
typedef struct PigmentDraft {
    Pigment pigment;
    ColorMapEntry *items;
    size_t count, capacity;
    int magnet;     /* of `magnet 1 mandel …`, until its second word is met */
    bool is_normal; /* a number after the pattern is the normal's, and lists hold normals */
    bool is_texture; /* lists hold textures */
    bool uv;         /* uv_mapping */
} PigmentDraft;

/* Names of patterns, what belongs to them, waves, turbulence and warps; target: a PigmentDraft. */
extern const WordRule pattern_rules[];
extern const size_t pattern_rule_count;
extern const WordRule pattern_setting_rules[];
extern const size_t pattern_setting_rule_count;

/* How many colours the pattern lists; 0: it has a map. */
size_t pattern_block_count(PatternKind kind);
/* A colour or pigment of a block pattern's list; false: it is neither. */
bool take_block_entry(Reader *reader, PigmentDraft *draft, const Argument *value);
/* object { O … } as a pattern. */
bool take_object_pattern(Reader *reader, PigmentDraft *draft, const Object *object);
/* warp { … } of a pigment. */
WordHandler read_warp;

/* A function of place that gives 1 inside of the object, else 0 (eval_internal.c); NULL: objects cannot be asked here. */
const Tape *object_inside_tape(const BuildContext *context, const Object *object, Span span);
/* A grid of densities; `name`: of its file, or NULL. NULL after a report. */
const DensityGrid *density_grid_load(const BuildContext *context, const char *name, Span span, const EvalDensityRequest *request);
/* The density file that the text at `span` names (eval_density.c); NULL after a report. */
const DensityGrid *density_load(const BuildContext *context, const char *name, Span span);

/* image_pattern { … }, and image_map { … } of pigments; target: a PigmentDraft. */
WordHandler read_image;
/* Entries in the order of their positions; what `list` holds moves along. */
void map_entries_sort(ColorMapEntry *entries, const void **list, size_t count);

/* The word of a pattern, or NULL. */
const char *pattern_word(PatternKind kind);
/* Whether the settings of a pattern that was read whole fit each other; reports it if not. */
bool pattern_check(Reader *reader, const Pigment *pigment);
/* Whether a setting (`mortar`) belongs to the pattern of this word (NULL: unknown, everything does); reports it if not. Words that
 * are no settings of certain patterns pass. */
bool pattern_takes(Reader *reader, const char *pattern, const Word *setting);

#endif
