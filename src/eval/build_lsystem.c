/* lsystem { axiom … rule … }: grown when its block ends; and lsystem { Plant parts branches|symbols ["L"] }. */
#include "eval/build_parts.h"
#include "grow/turtle.h"

#include <math.h>
#include <string.h>

enum { MOST_RULES = 60000 };

typedef struct SymbolObject {
    char letter;
    const Object *object;
} SymbolObject;

typedef struct LSystemDraft {
    ObjectDraft common;
    LSystemSource source;
    TurtleSettings turtle;
    double tropism;
    struct { LSystemText *items; size_t count, capacity; } rules;
    struct { LSystemConstant *items; size_t count, capacity; } constants;
    struct { SymbolObject *items; size_t count, capacity; } symbols;
    struct { const Texture **items; size_t count, capacity; } textures; /* of colours */
    double seed, most_segments;
} LSystemDraft;

/* ---- words ---- */

static void read_axiom(Reader *reader, const Word *word, void *target) {
    LSystemDraft *draft = target;
    if (!word_arguments(reader, word, 1, 1) || !word_string(reader, word, 0, &draft->source.axiom.text)) return;
    draft->source.axiom.span = word->arguments[0].span;
}

static void read_rule(Reader *reader, const Word *word, void *target) {
    LSystemDraft *draft = target;
    LSystemText rule;
    if (!word_arguments(reader, word, 1, 1) || !word_string(reader, word, 0, &rule.text)) return;
    rule.span = word->arguments[0].span;
    if (draft->rules.count == MOST_RULES) {
        reader_error(reader, rule.span, "an L-system takes %d productions at most", MOST_RULES);
        return;
    }
    *list_push(reader->context->arena, &draft->rules) = rule;
}

static void read_define(Reader *reader, const Word *word, void *target) {
    LSystemConstant constant;
    if (!word_arguments(reader, word, 2, 2) || !word_string(reader, word, 0, &constant.name) || !word_float(reader, word, 1, &constant.value)) return;
    *list_push(reader->context->arena, &((LSystemDraft *)target)->constants) = constant;
}

static void read_ignore(Reader *reader, const Word *word, void *target) {
    if (word_arguments(reader, word, 1, 1)) word_string(reader, word, 0, &((LSystemDraft *)target)->source.ignored);
}

static void read_iterations(Reader *reader, const Word *word, void *target) {
    int iterations;
    if (!word_arguments(reader, word, 1, 1) || !word_int(reader, word, 0, &iterations)) return;
    if (iterations < 0 || iterations > LSYSTEM_MOST_ITERATIONS)
        reader_error(reader, word->arguments[0].span, "'iterations' must be from 0 to %d, found %d", LSYSTEM_MOST_ITERATIONS, iterations);
    else
        ((LSystemDraft *)target)->source.iterations = iterations;
}

static void read_tropism(Reader *reader, const Word *word, void *target) {
    LSystemDraft *draft = target;
    Vec3 direction;
    double strength = 1;
    if (!word_arguments(reader, word, 1, 2) || !word_vector(reader, word, 0, &direction)) return;
    if (word->count == 2 && !word_float(reader, word, 1, &strength)) return;
    draft->turtle.tropism = vec3_scale(vec3_length_squared(direction) > 0 ? vec3_normalize(direction) : direction, strength);
}

static void read_segments(Reader *reader, const Word *word, void *target) {
    double most;
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, &most)) return;
    if (!(most >= 0 && most <= 1e8)) reader_error(reader, word->arguments[0].span, "'max_segments' must be from 0 to 100000000, found %g", most);
    else ((LSystemDraft *)target)->most_segments = most;
}

/* The objects of a symbol's body as one. */
static const Object *one_object(Reader *reader, const Word *word) {
    const EvalBlock *body = word->body;
    ObjectGroup *group = arena_new(reader->context->arena, ObjectGroup);
    const Object **items = arena_new_array(reader->context->arena, const Object *, body->count + 1);
    items[0] = NULL;
    *group = (ObjectGroup){.items = items};
    for (size_t i = 0; i < body->count; i++) {
        const Argument value = {body->items[i].value, body->items[i].span};
        const Object *part = body->items[i].kind == ITEM_VALUE ? object_from_value(reader->context, &value) : NULL;
        if (!part) {
            reader_error(reader, body->items[i].span, "'symbol' holds objects only");
            return NULL;
        }
        items[group->count++] = part;
    }
    if (!group->count) reader_error(reader, word->span, "'symbol' needs an object { … } behind its letter");
    if (group->count <= 1) return items[0];
    object_group_settle(group);
    Object object = {.span = word->span, .kind = OBJECT_UNION, .as.group = group};
    int depth = object_depth_by_parts(&object);
    if (depth > OBJECT_DEEPEST) {
        reader_error(reader, word->span, "objects are nested more than %d deep", OBJECT_DEEPEST);
        return NULL;
    }
    object.depth = (uint16_t)depth;
    return object_keep(reader->context->arena, &object, NULL);
}

static void read_symbol(Reader *reader, const Word *word, void *target) {
    const char *text;
    if (!word_arguments(reader, word, 1, 1) || !word_string(reader, word, 0, &text)) return;
    const Object *object = NULL;
    if (strlen(text) != 1) reader_error(reader, word->arguments[0].span, "'symbol' takes one letter, found \"%s\"", text);
    else if (turtle_knows(text[0])) reader_error(reader, word->arguments[0].span, "the turtle itself obeys '%s': it cannot stand for an object", text);
    else if (!word->body) reader_error(reader, word->span, "'symbol' needs an object { … } behind its letter");
    else object = one_object(reader, word);
    if (object) *list_push(reader->context->arena, &((LSystemDraft *)target)->symbols) = (SymbolObject){text[0], object};
}

static void read_textures(Reader *reader, const Word *word, void *target) {
    LSystemDraft *draft = target;
    Argument texture;
    if (!word->body) {
        reader_error(reader, word->span, "'texture_list' needs textures { … }");
        return;
    }
    Reader body = reader_nested(reader, word->body);
    reader_take_value(&body, VALUE_FLOAT, &texture); /* how many there are, as in mesh2 */
    while (reader_take_value(&body, VALUE_TEXTURE, &texture)) *list_push(reader->context->arena, &draft->textures) = texture.value.as.texture;
    if (reader_peek(&body)) reader_error(&body, reader_peek(&body)->span, "'texture_list' holds textures only");
    reader_end_nested(reader, &body);
}

#define FIELD(name) offsetof(LSystemDraft, name)
static const WordRule rules[] = {
    {"axiom", WORD_CUSTOM, 0, read_axiom, true},
    {"rule", WORD_CUSTOM, 0, read_rule, false},
    {"define", WORD_CUSTOM, 0, read_define, false},
    {"ignore", WORD_CUSTOM, 0, read_ignore, true},
    {"iterations", WORD_CUSTOM, 0, read_iterations, true},
    {"angle", WORD_FLOAT, FIELD(turtle.angle), NULL, true},
    {"step", WORD_FLOAT, FIELD(turtle.step), NULL, true},
    {"width", WORD_FLOAT, FIELD(turtle.width), NULL, true},
    {"taper", WORD_FLOAT, FIELD(turtle.taper), NULL, true},
    {"tropism", WORD_CUSTOM, 0, read_tropism, true},
    {"seed", WORD_FLOAT, FIELD(seed), NULL, true},
    {"symbol", WORD_CUSTOM, 0, read_symbol, false},
    {"max_segments", WORD_CUSTOM, 0, read_segments, true},
    {"texture_list", WORD_CUSTOM, 0, read_textures, true},
};

/* ---- what has grown, as objects ---- */

typedef struct PartList {
    const Object **items;
    size_t count, capacity;
} PartList;

/* A part of the plant; `color` picks its texture, NULL where the block names none. */
static void add_part(const BuildContext *context, const LSystemDraft *draft, Object object, int color, PartList *parts) {
    object.span = draft->common.object.span;
    object.depth = 1;
    size_t textures = draft->textures.count;
    if (textures) object.texture = draft->textures.items[(size_t)color < textures ? (size_t)color : textures - 1];
    *list_push(context->arena, parts) = object_keep(context->arena, &object, NULL);
}

static void add_leaves(const BuildContext *context, const LSystemDraft *draft, const TurtleLeaves *leaves, int color, PartList *parts) {
    if (!leaves->triangles.count) return;
    MeshData *mesh = arena_new(context->arena, MeshData);
    *mesh = (MeshData){.vertices = leaves->corners.items,
                       .vertex_count = leaves->corners.count,
                       .triangles = (const uint32_t(*)[3])leaves->triangles.items,
                       .triangle_count = leaves->triangles.count};
    mesh_rehash(mesh);
    add_part(context, draft, (Object){.kind = OBJECT_TRIANGLES, .as.mesh = mesh}, color, parts);
}

static const Object *object_of(const LSystemDraft *draft, char letter) {
    for (size_t i = draft->symbols.count; i-- > 0;)
        if (draft->symbols.items[i].letter == letter) return draft->symbols.items[i].object;
    return NULL;
}

static const Object *placed(const BuildContext *context, const Object *object, const TurtlePlace *place) {
    Mat3 axes = {{vec3_scale(place->left, -place->size), vec3_scale(place->heading, place->size), vec3_scale(place->up, place->size)}};
    const Affine affine = {axes, place->position};
    Transform own = object_transform(object), turtle = transform_of(&affine), all = transform_then(&own, &turtle);
    return object_keep(context->arena, object, &all);
}

static const Object *union_of(const BuildContext *context, const PartList *parts, const Plant *plant, Span span) {
    ObjectGroup *group = arena_new(context->arena, ObjectGroup);
    *group = (ObjectGroup){.items = parts->items, .count = parts->count, .plant = plant};
    object_group_settle(group);
    Object object = {.span = span, .kind = OBJECT_UNION, .as.group = group};
    object.depth = (uint16_t)int_min(object_depth_by_parts(&object), OBJECT_DEEPEST);
    return object_keep(context->arena, &object, NULL);
}

static const Object *plant_object(const BuildContext *context, const LSystemDraft *draft, const LSystemWord *word, const TurtleDrawing *drawing) {
    Plant *plant = arena_new(context->arena, Plant);
    PartList branches = {0}, symbols = {0}, both = {0};
    char *letters = arena_new_array(context->arena, char, (size_t)drawing->colors + drawing->places.count + 1);
    for (int color = 0; color < drawing->colors; color++) {
        const TurtleBranches *b = &drawing->branches[color];
        if (b->count) add_part(context, draft, (Object){.kind = OBJECT_BRANCHES, .as.branches = {b->items, b->count}}, color, &branches);
        add_leaves(context, draft, &drawing->leaves[color], color, &symbols);
    }
    memset(letters, '{', symbols.count);
    for (size_t i = 0; i < drawing->places.count; i++) {
        const TurtlePlace *place = &drawing->places.items[i];
        letters[symbols.count] = place->letter;
        *list_push(context->arena, &symbols) = placed(context, object_of(draft, place->letter), place);
    }
    Span span = draft->common.object.span;
    *plant = (Plant){.letters = word->letters, .first = word->first, .parameters = word->parameters, .count = word->count, .symbol_letters = letters};
    plant->branches = union_of(context, &branches, plant, span);
    plant->symbols = union_of(context, &symbols, plant, span);
    /* What is empty has no end, and would take the bounds of the rest with it. */
    if (branches.count) *list_push(context->arena, &both) = plant->branches;
    if (symbols.count) *list_push(context->arena, &both) = plant->symbols;
    return union_of(context, &both, plant, span);
}

/* ---- building ---- */

static bool grow(BuildContext *context, LSystemDraft *draft, LSystemWord *word, TurtleDrawing *drawing) {
    LSystemSource *source = &draft->source;
    char *letters = arena_new_array(context->arena, char, draft->symbols.count + 1);
    for (size_t i = 0; i < draft->symbols.count; i++) letters[i] = draft->symbols.items[i].letter;
    source->rules = draft->rules.items;
    source->rule_count = draft->rules.count;
    source->constants = draft->constants.items;
    source->constant_count = draft->constants.count;
    source->seed = (uint64_t)(int64_t)double_clamp(draft->seed, -9e15, 9e15);
    source->most_segments = (uint64_t)draft->most_segments;
    draft->turtle.symbols = letters;
    const LSystem *system = lsystem_read(source, context->arena, context->diags);
    if (!system || !plant_derive(context, system, word)) return false;
    turtle_draw(word, &draft->turtle, context->arena, drawing);
    return true;
}

static bool build_new(BuildContext *context, const EvalBlock *block, Value *out) {
    LSystemDraft draft = {.common = object_begin(block, OBJECT_UNION), .turtle = {.angle = 90, .step = 1, .width = 0.1, .taper = 0.7}, .most_segments = 2e6};
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), &draft);
    reader.on_value = object_on_value;
    reader.value_target = &draft.common;
    if (!object_read(&reader, &draft.common)) return false;
    if (!draft.source.axiom.text) {
        reader_error(&reader, block->word_span, "'lsystem' needs an axiom");
        return false;
    }
    LSystemWord word;
    TurtleDrawing *drawing = arena_new(context->arena, TurtleDrawing);
    if (!grow(context, &draft, &word, drawing)) return false;
    if (!context->is_program && !drawing->segments && !drawing->places.count && drawing->colors == 0)
        diag_warning(context->diags, block->word_span, "this L-system draws nothing: its word has no F and no symbol with an object");
    draft.common.object.as.group = plant_object(context, &draft, &word, drawing)->as.group;
    return object_make(&reader, &draft.common, out);
}

/* The symbols whose letters stand in a string behind the word; all without one. */
static const ObjectGroup *symbols_of(Reader *reader, const Word *word, const Plant *plant) {
    const ObjectGroup *all = plant->symbols->as.group;
    const char *wanted;
    if (word->count == 0 || !word_arguments(reader, word, 1, 1) || !word_string(reader, word, 0, &wanted)) return all;
    PartList parts = {0};
    for (size_t i = 0; i < all->count; i++)
        if (strchr(wanted, plant->symbol_letters[i])) *list_push(reader->context->arena, &parts) = all->items[i];
    return union_of(reader->context, &parts, plant, word->span)->as.group;
}

static void read_parts(Reader *reader, const Word *word, void *target) {
    ObjectDraft *draft = target;
    const Plant *plant = draft->object.as.group->plant;
    Word next;
    if (word->count == 0 && reader_take_word(reader, "branches", &next)) draft->object.as.group = plant->branches->as.group;
    else if (word->count == 0 && reader_take_word(reader, "symbols", &next)) draft->object.as.group = symbols_of(reader, &next, plant);
    else reader_expect_word(reader, word, "branches or symbols");
}

/* lsystem { Plant parts branches }: as `object`, with one word more. */
static bool build_parts_of(BuildContext *context, const EvalBlock *block, Value *out) {
    static const WordRule part_rules[] = {{"parts", WORD_CUSTOM, 0, read_parts, true}};
    Reader reader = reader_begin(context, block);
    const Object *source = block->items[0].value.as.object;
    reader.next++;
    if (source->kind != OBJECT_UNION || !source->as.group->plant) {
        reader_error(&reader, block->items[0].span, "'lsystem' takes parts of an L-system, and this is none");
        return false;
    }
    ObjectDraft draft = {.object = object_copy(source), .transform = object_transform(source), .word = "object"};
    draft.object.span = block->span;
    draft.no_shadow = source->no_shadow;
    draft.no_image = source->no_image;
    if (source->rest) draft.rest = *source->rest;
    reader_add_table(&reader, part_rules, VTS_ARRAY_COUNT(part_rules), &draft);
    return object_finish(&reader, &draft, out);
}

bool build_lsystem(BuildContext *context, const EvalBlock *block, Value *out) {
    return object_is_copy(block) ? build_parts_of(context, block, out) : build_new(context, block, out);
}
