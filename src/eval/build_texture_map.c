/* texture { … }: plain ones, and those in which a pattern chooses among textures. */
#include "eval/build_pattern.h"

#include <string.h>

typedef struct TextureDraft {
    PigmentDraft pattern;   /* first; its pigment's transform is that of the whole */
    const Texture *texture; /* in the space before that transform; NULL: nothing said yet */
    struct {
        const Texture **items;
        size_t count, capacity;
    } textures;
    struct {
        double *items;
        size_t count, capacity;
    } positions;
    const InertNote *inert;
    Span pattern_span;
    bool begun;     /* something was read */
    bool mapped;    /* a texture_map was read, or the pattern lists its textures */
    bool patterned; /* a pattern chooses among textures */
    bool uv;
} TextureDraft;



static Transform *place_of(TextureDraft *draft) { return &draft->pattern.pigment.transform; }

static void add_texture(Reader *reader, TextureDraft *draft, const Texture *texture, double position) {
    if (!texture) return;
    *list_push(reader->context->arena, &draft->textures) = texture;
    *list_push(reader->context->arena, &draft->positions) = position;
}

static void list_texture(Reader *reader, TextureDraft *draft, const Texture *texture) {
    add_texture(reader, draft, texture, (double)draft->textures.count);
}

static bool on_value(Reader *reader, const Argument *value, void *target) {
    TextureDraft *draft = target;
    bool begun = draft->begun;
    draft->begun = true;
    switch (value->value.kind) {
    case VALUE_FUNCTION:
        if (draft->patterned) return false;
        draft->patterned = true;
        draft->pattern_span = value->span;
        if (argument_function(reader, value, "'texture'", 3, 1, &draft->pattern.pigment.function))
            draft->pattern.pigment.kind = PATTERN_FUNCTION;
        return true;
    case VALUE_TEXTURE: /* a declared one comes first, those of a pattern's list after it */
        if (draft->patterned) {
            list_texture(reader, draft, value->value.as.texture);
            return true;
        }
        if (begun && !reader->block->of_layers) return false;
        break;
    case VALUE_PIGMENT:
    case VALUE_NORMAL:
    case VALUE_FINISH:
        if (draft->patterned) return false;
        break;
    case VALUE_TRANSFORM: break;
    default: return false;
    }
    return take_looks(reader->context, value, &draft->texture, &draft->inert, place_of(draft)) ||
           take_transform(value, place_of(draft));
}

/* ---- patterns ---- */

/* The entries of texture_map { … }, or of the declared map that it holds. */
static void read_entries(Reader *reader, const EvalBlock *map, TextureDraft *draft) {
    for (size_t i = 0; map && i < map->count && !reader->failed; i++) {
        const BlockItem *item = &map->items[i];
        if (item->kind == ITEM_VALUE && item->value.kind == VALUE_BLOCK)
            read_entries(reader, item->value.as.block, draft);
        if (item->kind != ITEM_ENTRY) continue;
        Reader entry = reader_nested(reader, item->entry);
        Argument first;
        double position = 1; /* of `average`, a weight that may be left out */
        if (reader_take_value(&entry, VALUE_FLOAT, &first))
            argument_float(&entry, &first, "the position", &position);
        add_texture(reader, draft, texture_read(&entry), position);
        reader_end_nested(reader, &entry);
    }
}

static void read_map(Reader *reader, const Word *word, TextureDraft *draft) {
    if (!draft->patterned && !draft->uv)
        reader_error(reader, word->span, "'texture_map' needs a pattern before it");
    draft->mapped = true;
    if (!reader->failed) read_entries(reader, word->body, draft);
}

/* tiles { texture … tile2 texture … }: the checker of old. */
static void read_tiles(Reader *reader, const Word *word, TextureDraft *draft) {
    draft->pattern.pigment.kind = PATTERN_CHECKER;
    for (size_t i = 0; word->body && i < word->body->count; i++) {
        const BlockItem *item = &word->body->items[i];
        if (item->kind == ITEM_VALUE && item->value.kind == VALUE_TEXTURE)
            list_texture(reader, draft, item->value.as.texture);
        for (size_t k = 0; item->kind == ITEM_WORD && k < item->argument_count; k++)
            if (item->arguments[k].value.kind == VALUE_TEXTURE)
                list_texture(reader, draft, item->arguments[k].value.as.texture);
    }
}

static void read_materials(Reader *reader, const Word *word, TextureDraft *draft) {
    draft->pattern.pigment.kind = PATTERN_MATERIAL;
    draft->pattern.pigment.image = image_read(reader, word);
    for (size_t i = 0; word->body && i < word->body->count; i++) {
        const BlockItem *item = &word->body->items[i];
        if (item->kind == ITEM_VALUE && item->value.kind == VALUE_TEXTURE)
            list_texture(reader, draft, item->value.as.texture);
    }
}

/* Patterns whose textures stand in a list, not in a map. */
static bool has_list(const char *pattern) {
    static const char *const words[] = {"checker", "brick",  "hexagon", "square",       "triangular",
                                        "cubic",   "object", "tiles",   "material_map", "texture_map"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(words); i++)
        if (strcmp(words[i], pattern) == 0) return true;
    return false;
}

/* The pattern's own words, once the grammar of textures has passed them. */
static void read_pattern_word(Reader *reader, const Word *word, TextureDraft *draft) {
    Reader words = reader_nested(reader, reader->block);
    words.next = reader->next;
    reader_add_table(&words, pattern_rules, pattern_rule_count, &draft->pattern);
    reader_add_table(&words, pattern_setting_rules, pattern_setting_rule_count, &draft->pattern);
    words.on_value = on_value;
    words.value_target = draft;
    reader_word(&words, word);
    reader->next = words.next;
    reader_end_nested(reader, &words);
}

static void begin_pattern(Reader *reader, const Word *word, TextureDraft *draft) {
    if (draft->patterned) reader_error(reader, word->span, "'%s' is a second pattern", word->text);
    draft->patterned = draft->begun = true;
    draft->pattern_span = word->span;
    draft->mapped = has_list(word->text);
}

static bool on_word(Reader *reader, const Word *word, void *target) {
    TextureDraft *draft = target;
    bool entry = strcmp(reader->block->word->text, "texture_map") == 0; /* checked with the whole map */
    if (!entry && !grammar_word(reader, word)) return false;
    if (strcmp(word->text, "texture_map") == 0) return read_map(reader, word, draft), true;
    bool tiles = strcmp(word->text, "tiles") == 0, materials = strcmp(word->text, "material_map") == 0;
    if (tiles || materials || grammar_has("pattern_types", word->text)) begin_pattern(reader, word, draft);
    if (reader->failed) return true;
    if (tiles)
        read_tiles(reader, word, draft);
    else if (materials)
        read_materials(reader, word, draft);
    else
        read_pattern_word(reader, word, draft);
    return true;
}

/* ---- the finished node ---- */

/* Lists that are too short are filled with the default texture. */
static void fill_list(Reader *reader, TextureDraft *draft) {
    size_t wanted = size_max(pattern_block_count(draft->pattern.pigment.kind), 1);
    while (draft->textures.count < wanted) list_texture(reader, draft, texture_default(reader->context));
}

static bool measure(Reader *reader, TextureMap *map) {
    map->depth = map->pattern->depth;
    map->work = map->pattern->work + 1;
    for (size_t i = 0; i < map->count; i++) {
        const TextureMap *inner = map->textures[i]->map;
        map->depth = int_max(map->depth, inner ? inner->depth + 1 : 1);
        map->work += inner ? inner->work : map->textures[i]->pigment->work;
    }
    if (map->depth > PIGMENT_DEEPEST)
        reader_error(reader, reader->block->word_span, "textures are nested more than %d deep", PIGMENT_DEEPEST);
    else if (map->work > PIGMENT_MOST_WORK)
        reader_error(reader, reader->block->word_span, "this texture takes more than %g steps", PIGMENT_MOST_WORK);
    return !reader->failed;
}

static bool keeps_order(PatternKind kind) {
    return pattern_block_count(kind) > 0 || kind == PATTERN_AVERAGE || kind == PATTERN_MATERIAL || kind == PATTERN_UV;
}

/* The pattern with an entry for each texture. */
static const Pigment *map_pattern(Reader *reader, TextureDraft *draft) {
    Arena *arena = reader->context->arena;
    size_t count = draft->textures.count;
    ColorMapEntry *entries = arena_new_array(arena, ColorMapEntry, count);
    for (size_t i = 0; i < count; i++) entries[i].position = draft->positions.items[i];
    Pigment *pattern = arena_copy(arena, &draft->pattern.pigment, sizeof *pattern);
    if (!keeps_order(pattern->kind)) map_entries_sort(entries, (const void **)draft->textures.items, count);
    pattern->entries = entries;
    pattern->entry_count = count;
    if (!pattern->noise_generator) pattern->noise_generator = build_noise_generator(reader->context);
    pigment_measure(pattern);
    pigment_rehash(pattern);
    return pattern;
}

static const Texture *texture_of_map(Reader *reader, TextureDraft *draft) {
    Arena *arena = reader->context->arena;
    fill_list(reader, draft);
    if (!pattern_check(reader, &draft->pattern.pigment)) return NULL;
    const Pigment *pattern = map_pattern(reader, draft);
    TextureMap *map = arena_new(arena, TextureMap);
    *map = (TextureMap){.pattern = pattern, .textures = draft->textures.items, .count = draft->textures.count};
    if (!measure(reader, map)) return NULL;
    Texture *texture = arena_copy(arena, draft->textures.items[0], sizeof *texture);
    texture->transform = transform_identity();
    texture->under = NULL;
    texture->normal = NULL;
    texture->inert = draft->inert;
    texture->map = map;
    texture_rehash(texture);
    return texture;
}

static const Texture *texture_of_layers(Reader *reader, TextureDraft *draft) {
    const Texture *base = draft->texture ? draft->texture : texture_default(reader->context);
    const Texture *placed = texture_placed(reader->context, base, place_of(draft));
    Texture *texture = arena_copy(reader->context->arena, placed, sizeof *texture);
    for (const InertNote *note = draft->inert; note; note = note->next)
        inert_add(reader->context, &texture->inert, note->word, note->span);
    return texture;
}

/* The texture as the one entry of a map that is seen in u and v. */
static const Texture *seen_in_uv(Reader *reader, const Texture *inner) {
    TextureDraft outer = {.pattern.pigment = pigment_default(), .inert = inner->inert};
    outer.pattern.pigment.kind = PATTERN_UV;
    list_texture(reader, &outer, inner);
    return texture_of_map(reader, &outer);
}

static const Texture *finished(Reader *reader, TextureDraft *draft) {
    const Texture *made = draft->patterned ? texture_of_map(reader, draft) : texture_of_layers(reader, draft);
    if (made && draft->uv) made = seen_in_uv(reader, made);
    if (!made) return NULL;
    Texture *texture = arena_copy(reader->context->arena, made, sizeof *made);
    texture->span = reader->block->span;
    return texture;
}

static const WordRule rules[] = {{"uv_mapping", WORD_FLAG, offsetof(TextureDraft, uv), NULL, false}};

const Texture *texture_read(Reader *reader) {
    TextureDraft *draft = arena_new(reader->context->arena, TextureDraft);
    draft->pattern.pigment = pigment_default();
    draft->pattern.is_texture = true;
    if (reader->context->wave_count) draft->pattern.pigment.wave_count = reader->context->wave_count;
    reader_add_table(reader, transform_rules, transform_rule_count, place_of(draft));
    reader_add_table(reader, rules, VTS_ARRAY_COUNT(rules), draft);
    reader->on_value = on_value;
    reader->on_word = on_word;
    reader->value_target = draft;
    if (!reader_run(reader)) return NULL;
    if (draft->patterned && !draft->mapped) {
        reader_error(reader, draft->pattern_span, "a pattern of textures needs a 'texture_map'");
        return NULL;
    }
    return finished(reader, draft);
}

bool build_texture(BuildContext *context, const EvalBlock *block, Value *out) {
    Reader reader = reader_begin(context, block);
    const Texture *texture = texture_read(&reader);
    *out = (Value){.kind = VALUE_TEXTURE, .as.texture = texture};
    return texture != NULL;
}
