/* Evaluated blocks: `keyword { … }` after its directives have run, its macros have been expanded and its expressions
 * have been evaluated, in the order of the text. What is left is a flat list of items, plain data, from which a builder
 * makes a node of the scene graph. Builders never see directives, macros or syntax.
 *
 * The evaluator calls a block's builder when its closing brace is reached, so nested blocks arrive as finished values:
 *     sphere { <0,1,0>, R  pigment { rgb 1 }  scale 2 }
 * is [VALUE <0,1,0>] [VALUE R] [VALUE a pigment] [WORD scale (2)].
 *     mapping { repeat <37,37> height 0.9 }
 * has no builder: the skin around it gets [VALUE of kind BLOCK: mapping] and reads its items itself.
 *
 * Words and their arguments. At the place of an item, a word that is neither a declared name nor the start of an
 * expression (x, rgb, color, function, a number …) is an ITEM_WORD; its arguments are the expressions that follow, with
 * commas or (`height 0.6 function(x,y,z) {…}`) without. Whether the word makes sense there is for the builder to say, so
 * that an unknown one gets a "did you mean" from the right list. `tiling wang` and `uv planar y` are therefore two words:
 * [WORD tiling] [WORD wang], [WORD uv] [WORD planar (y)]. `matrix <12 numbers>` has one vector of size 12 as argument.
 * `color X` and `colour X` are colour expressions, never words.
 *
 * `count` in a particles block is evaluated once per particle:
 *     particles { count 16 { position <rand(S), 0, rand(S)> life 1 } }
 * evaluates 16 once and then the body 16 times, with the local name `index` declared as 0, 1 … 15. Each pass gives one
 * ITEM_WORD `count` of its own: arguments[0] is the index (a float), arguments[1] the number of particles, `body` the items
 * of that pass. A count of zero gives no item. A count that is negative, no whole number or past the limit of loops is the
 * evaluator's error. Everywhere else `word N { … }` is one ITEM_WORD with one body (phases 8 { … }).
 *
 * Blocks, items, arguments and components live until the builder returns; what stays VALUE_BLOCK is copied by the evaluator.
 * Builders copy what their nodes keep. */
#ifndef VTS_EVAL_BLOCK_H
#define VTS_EVAL_BLOCK_H

#include "base/gamma.h"
#include "base/diag.h"
#include "eval/value.h"
#include "lexer/token.h"

typedef enum BlockItemKind {
    ITEM_VALUE, /* an expression or a nested block: `value` */
    ITEM_WORD,  /* a word with the expressions that follow it: `word`, `arguments`; `body` if a { … } of its own follows */
    ITEM_ENTRY, /* [ … ] of a map: `entry` */
    ITEM_OBJECTS, /* objects that follow each other in a union and its like: `objects` */
} BlockItemKind;

typedef struct Argument {
    Value value;
    Span span;
} Argument;

typedef struct BlockItem {
    BlockItemKind kind;
    Span span;                 /* of the whole item */
    Span word_span;            /* of the word */
    Name word;                 /* ITEM_WORD */
    Value value;               /* ITEM_VALUE */
    const Argument *arguments; /* ITEM_WORD */
    size_t argument_count;
    const EvalBlock *body;     /* ITEM_WORD: count 16 { … }; word is the block's keyword too. Else NULL. */
    const EvalBlock *entry;    /* ITEM_ENTRY: the items between the brackets */
    struct { const Object **items; size_t count, capacity; } objects; /* ITEM_OBJECTS; each says itself where it stands */
} BlockItem;

struct EvalBlock {
    Name word;       /* the keyword before the brace */
    Span word_span;
    Span span;       /* from the keyword to the closing brace */
    const BlockItem *items;
    size_t count;
    const ListedNumber *numbers; /* NULL, or instead of items: a list of a mesh that holds nothing else */
    size_t number_count;
    Name outer;       /* the word of the block in which this one stands, or NULL */
    bool of_layers;   /* made of texture { … } texture { … } where one value was wanted */
    Name declared_as; /* the name of `#declare Name = texel { … }` when the block is its whole right side; else NULL */
};

/* What a builder may use besides its block. */
typedef struct BuildContext {
    Arena *arena;       /* the scene's */
    Interner *names;
    DiagList *diags;
    double image_aspect; /* width / height */
    bool is_program;     /* run for what it prints: an empty scene is no matter */
    uint64_t most_vertices; /* the limit of one mesh; 0: none */
    const Texture *default_texture;
    int noise_generator; /* of global_settings: 1, 2, 3; 0: not given */
    bool old_noise;      /* #version is below 3.5: generator 1 unless one is given */
    double assumed_gamma; /* of global_settings, or GAMMA_SRGB; 0: not given */
    bool old_gamma;      /* #version is below 3.7: colours are what screens are sent unless assumed_gamma is given */
    GeoOrigin geo_origin; /* of global_settings, or of the first terrain */
    bool has_terrain;     /* a terrain was made: it decided whether the scene's earth is round */
    Span geo_asked;       /* where the first place of the scene was asked for, which a flat earth would move */
    bool is_geo_asked;
    int wave_count;      /* number_of_waves of global_settings; 0: not given */
    bool names_missing;  /* an include was not found: what it declares is missing, without a word */
    double time, cycle;  /* of the frame in seconds, and after how many a film begins again; 0: it does not */
    const struct BlockSetting *settings; /* block_setting.h: from outside, over what blocks say */
    size_t setting_count;
    void *eval;          /* for the evaluator itself */
} BuildContext;

/* The same block with items; what they point to lives as long as both. Readers do this by themselves. */
const EvalBlock *block_with_items(Arena *arena, const EvalBlock *block);

/* A copy with all its items that lives as long as `arena`: for what stays a block. */
const EvalBlock *block_keep(Arena *arena, const EvalBlock *block);

/* The noise generator of functions and patterns that name none. */
static inline int build_noise_generator(const BuildContext *context) {
    return context->noise_generator ? context->noise_generator : context->old_noise ? 1 : 2;
}

/* What the numbers of colours mean: light to the power of 1 through this, or GAMMA_SRGB. */
static inline double build_assumed_gamma(const BuildContext *context) {
    return context->assumed_gamma != 0 ? context->assumed_gamma : context->old_gamma ? GAMMA_SRGB : 1;
}

/* Makes the value of a block; false after a diagnostic (out is then VALUE_ERROR). */
typedef bool BlockBuilder(BuildContext *context, const EvalBlock *block, Value *out);

/* The builder of `word { … }`, or NULL when such blocks stay VALUE_BLOCK. `known` is set to false when no block of this name
 * exists anywhere in the language. */
BlockBuilder *block_builder_find(const BuildContext *context, Name word, bool *known);
/* Whether `#declare Name = word { … }` makes sense, as it does for all but parts of POV-Ray's blocks that have no names there. */
bool block_may_be_declared(Name word);
/* The word of a block that an unknown `word { … }` was likely meant to be, or NULL: for a hint. */
const char *block_word_suggest(const char *word);

/* Whether a word is one of the language's, which no scene can declare. */
bool eval_is_keyword(const BuildContext *context, Name word);
/* The nearest of `words` and of the declared names, or NULL: for a hint. */
const char *eval_suggest_name(const BuildContext *context, const char *text, const char *const *words,
                              size_t word_count);
/* Tells in the hint of `d` (NULL: nothing) what likely helps where `text` is not declared: which file of the library declares it, the
 * nearest of `words` and of the declared names, or names that begin with it. */
void eval_hint_name(const BuildContext *context, Diagnostic *d, const char *text, const char *const *words,
                    size_t word_count);

/* The builders' other entry: a value that stands at top level of the file goes into the scene. False after a diagnostic
 * ("a float has no meaning here"). `declared texels` and the like that stand alone are errors too. */
typedef struct SceneDraft SceneDraft;
SceneDraft *scene_draft_create(BuildContext *context, const char *scene_name);
bool scene_draft_add(SceneDraft *draft, BuildContext *context, const Value *value, Span span);
/* Fills in defaults (camera …), warns of an empty scene. */
/* Its times are left to who knows them. */
const Scene *scene_draft_finish(SceneDraft *draft, BuildContext *context);
/* Whether an animation stood at top level. */
bool scene_draft_has_film(const SceneDraft *draft);
/* #default { texture / pigment / finish … } */
bool scene_draft_default(SceneDraft *draft, BuildContext *context, const EvalBlock *block);

#endif
