/* What the names of a program stand for when it ends. */
#include "eval/eval_names.h"

#include <stdlib.h>
#include <string.h>

typedef struct TexelNames {
    Arena *arena;
    NamedTexel *items;
    size_t count, capacity;
} TexelNames;

enum { DEEPEST_ARRAY = 8, MOST_NAMED_TEXELS = 10000 };

static void add_value(TexelNames *names, const char *name, const Slot *slot, int depth) {
    if (!slot->set || names->count >= MOST_NAMED_TEXELS) return;
    if (slot->value.kind == VALUE_TEXEL)
        *list_push(names->arena, names) = (NamedTexel){name, slot->value.as.texel};
    if (slot->value.kind != VALUE_ARRAY || depth == DEEPEST_ARRAY) return;
    const Array *array = slot->value.as.array;
    for (size_t i = 0; i < array->count && names->count < MOST_NAMED_TEXELS; i++) {
        ValueKind kind = array->items[i].value.kind;
        if (kind == VALUE_TEXEL || kind == VALUE_ARRAY)
            add_value(names, arena_printf(names->arena, "%s[%zu]", name, i), &array->items[i], depth + 1);
    }
}

static int by_name(const void *a, const void *b) {
    return strcmp(((const NamedTexel *)a)->name, ((const NamedTexel *)b)->name);
}

void eval_name_texels(const Eval *ev, Scene *scene) {
    TexelNames names = {.arena = ev->build.arena};
    const Interner *interner = ev->build.names;
    for (uint32_t i = 0; i < interner->slot_count; i++) {
        Name name = interner->slots[i];
        const VarBinding *binding = name && name->id < ev->binding_count ? ev->bindings[name->id] : NULL;
        if (binding) add_value(&names, name->text, binding->slot, 0);
    }
    if (names.count) qsort(names.items, names.count, sizeof *names.items, by_name);
    scene->named_texels = names.items;
    scene->named_texel_count = names.count;
}
