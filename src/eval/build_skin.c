#include "eval/build_parts.h"

#include <string.h>

typedef struct SkinDraft {
    Skin skin;
    struct {
        SkinTexel *items;
        size_t count, capacity;
    } texels;
    Transform place; /* stays the identity: a skin has no transform of its own */
    Span springs;
} SkinDraft;

/* ---- texel { Flower texture { Red } density 0.05 } ---- */

typedef struct TexelReference {
    SkinTexel texel;
    Transform place;
} TexelReference;

static bool on_reference_value(Reader *reader, const Argument *value, void *target) {
    TexelReference *reference = target;
    const InertNote *ignored = NULL;
    if (value->value.kind == VALUE_TEXEL && !reference->texel.texel) {
        reference->texel.texel = value->value.as.texel;
        return true;
    }
    return take_looks(reader->context, value, &reference->texel.texture, &ignored, &reference->place);
}

static void read_density(Reader *reader, const Word *word, void *target) {
    SkinTexel *texel = &((TexelReference *)target)->texel;
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, &texel->density)) return;
    if (texel->density < 0 || texel->density > 1)
        reader_error(reader, word->arguments[0].span,
                     "'density' is a share of the tiles from 0 to 1, found %g", texel->density);
}

static void read_texel(Reader *reader, const Word *word, void *target) {
    static const WordRule reference_rules[] = {{"density", WORD_CUSTOM, 0, read_density, true}};
    SkinDraft *draft = target;
    if (!word->body) {
        reader_error(reader, word->span, "'texel' needs the name of a texel { … }");
        return;
    }
    TexelReference reference = {.texel = {.span = word->whole, .density = 1}, .place = transform_identity()};
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, reference_rules, VTS_ARRAY_COUNT(reference_rules), &reference);
    body.on_value = on_reference_value;
    body.value_target = &reference;
    reader_run(&body);
    if (reader_end_nested(reader, &body))
        *list_push(reader->context->arena, &draft->texels) = reference.texel;
}

/* ---- skin { … } ---- */

static void read_mapping(Reader *reader, const Word *word, void *target) {
    mapping_read(reader, word, &((SkinDraft *)target)->skin.mapping);
}

static void read_jitter(Reader *reader, const Word *word, void *target) {
    jitter_read(reader, word, &((SkinDraft *)target)->skin.jitter);
}

static void read_damping(Reader *reader, const Word *word, void *target) {
    double *damping = &((SkinSprings *)target)->damping;
    if (!word_arguments(reader, word, 1, 1) || !word_float(reader, word, 0, damping)) return;
    if (*damping < 0) reader_error(reader, word->arguments[0].span, "'%s' must not be negative, found %g", word->text, *damping);
}

static void read_springs(Reader *reader, const Word *word, void *target) {
    static const WordRule spring_rules[] = {
        {"stiffness", WORD_POSITIVE, offsetof(SkinSprings, stiffness), NULL, true},
        {"damping", WORD_CUSTOM, 0, read_damping, true},
    };
    SkinDraft *draft = target;
    if (!word->body) {
        reader_error(reader, word->span, "'%s' needs its block { … }", word->text);
        return;
    }
    draft->springs = word->span;
    draft->skin.springs = (SkinSprings){.present = true, .stiffness = 40, .damping = 2};
    Reader body = reader_nested(reader, word->body);
    reader_add_table(&body, spring_rules, VTS_ARRAY_COUNT(spring_rules), &draft->skin.springs);
    reader_run(&body);
    reader_end_nested(reader, &body);
}

static void read_tiling(Reader *reader, const Word *word, void *target) {
    Word next;
    if (word->count == 0 && reader_take_word(reader, "plain", &next)) return;
    if (word->count == 0 && reader_take_word(reader, "wang", &next))
        ((SkinDraft *)target)->skin.wang = true;
    else
        reader_expect_word(reader, word, "plain or wang");
}

static const WordRule rules[] = {
    {"texel", WORD_CUSTOM, 0, read_texel, false},
    {"mapping", WORD_CUSTOM, 0, read_mapping, true},
    {"jitter", WORD_CUSTOM, 0, read_jitter, true},
    {"tiling", WORD_CUSTOM, 0, read_tiling, true},
    {"springs", WORD_CUSTOM, 0, read_springs, true},
    {"surface", WORD_IGNORED, 0, NULL, true}, /* arrives as a value; here for "did you mean" */
    {"wind_field", WORD_IGNORED, 0, NULL, true},
};

static bool take_surface(Reader *reader, SkinDraft *draft, const Argument *value) {
    if (draft->skin.surface) {
        Diagnostic *d = reader_error(reader, value->span, "'surface' stands twice in 'skin'");
        diag_note(reader->context->diags, d, draft->skin.surface->span, "first here");
    }
    draft->skin.surface = value->value.as.surface;
    return true;
}

static bool on_value(Reader *reader, const Argument *value, void *target) {
    SkinDraft *draft = target;
    switch (value->value.kind) {
    case VALUE_SURFACE: return take_surface(reader, draft, value);
    case VALUE_TEXEL:
        *list_push(reader->context->arena, &draft->texels) =
            (SkinTexel){.span = value->span, .texel = value->value.as.texel, .density = 1};
        return true;
    case VALUE_WIND_FIELD:
        if (draft->skin.wind) reader_error(reader, value->span, "'wind_field' stands twice in 'skin'");
        draft->skin.wind = value->value.as.wind_field;
        return true;
    case VALUE_OBJECT: {
        Diagnostic *d = reader_error(reader, value->span, "a skin lies on a surface");
        diag_hint(reader->context->diags, d, "write surface { … } around the object");
        return true;
    }
    default:
        return take_looks(reader->context, value, &draft->skin.texture, &draft->skin.inert, &draft->place);
    }
}

static bool complete(Reader *reader, const SkinDraft *draft) {
    if (!draft->skin.surface)
        reader_error(reader, reader->block->word_span, "this skin has no surface { … } to lie on");
    else if (!draft->texels.count)
        reader_error(reader, reader->block->word_span, "this skin has no texel { … } to lay on its surface");
    return !reader->failed;
}

bool build_skin(BuildContext *context, const EvalBlock *block, Value *out) {
    SkinDraft *draft = arena_new(context->arena, SkinDraft);
    Skin *skin = &draft->skin;
    *draft = (SkinDraft){.skin = {.span = block->span,
                                  .mapping = {.repeat_u = 1, .repeat_v = 1, .height = 1, .w_tip = 1},
                                  .jitter = {.coordinates.scale = 1,
                                             .height.scale = 1,
                                             .direction.scale = 1,
                                             .instance.density = 1}},
                         .place = transform_identity()};
    Reader reader = reader_begin(context, block);
    reader_add_table(&reader, rules, VTS_ARRAY_COUNT(rules), draft);
    reader.on_value = on_value;
    reader.value_target = draft;
    if (!reader_run(&reader) || !complete(&reader, draft)) return false;
    if (skin->springs.present && !skin->wind)
        diag_warning(context->diags, draft->springs, "nothing moves these springs: the skin has no wind_field");
    skin->texels = draft->texels.items;
    skin->texel_count = draft->texels.count;
    skin_rehash(skin);
    *out = (Value){.kind = VALUE_SKIN, .as.skin = skin};
    return true;
}
