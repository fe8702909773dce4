#include "eval/eval_state.h"

#include <string.h>

void scope_enter(Eval *ev, Scope *scope) {
    *scope = (Scope){.outer = ev->scope, .number = ev->scope ? ev->scope->number + 1 : 0};
    ev->scope = scope;
}

NameClass slot_class(const Slot *slot) {
    if (!slot->set) return NAME_UNKNOWN;
    switch (slot->value.kind) {
    case VALUE_MACRO: return NAME_MACRO;
    case VALUE_FUNCTION:
    case VALUE_SPLINE:
    case VALUE_ERROR: /* might have been one */ return NAME_CALLABLE;
    default: return NAME_PLAIN;
    }
}

static NameClass binding_class(const VarBinding *b) { return b ? slot_class(b->slot) : NAME_UNKNOWN; }

/* Most bindings come and go without a difference to the parser: a parameter that holds a value like the one outside. */
static void note_change(Eval *ev, NameClass before, NameClass after) {
    ev->name_stamp += before != after || after == NAME_MACRO;
}

static void drop(Eval *ev, VarBinding *b) {
    note_change(ev, binding_class(b), binding_class(b->outer));
    ev->bindings[b->name_id] = b->outer;
    b->own.set = false;
    b->own.value = value_error();
    b->scope_next = ev->free_bindings;
    ev->free_bindings = b;
}

void scope_leave(Eval *ev, Scope *scope) {
    for (VarBinding *b = scope->bindings, *next; b; b = next) {
        next = b->scope_next;
        drop(ev, b);
    }
    ev->scope = scope->outer;
}

static void make_room(Eval *ev, uint32_t id) {
    if (id < ev->binding_count) return;
    uint32_t count = ev->binding_count ? ev->binding_count : 1024;
    while (count <= id) count *= 2;
    VarBinding **larger = arena_new_array(ev->parse, VarBinding *, count);
    if (ev->binding_count) memcpy(larger, ev->bindings, ev->binding_count * sizeof *larger);
    ev->bindings = larger;
    ev->binding_count = count;
}

static VarBinding *push(Eval *ev, Name name, Scope *scope) {
    make_room(ev, name->id);
    VarBinding *b = ev->free_bindings;
    if (b)
        ev->free_bindings = b->scope_next;
    else
        b = arena_new(ev->parse, VarBinding);
    b->slot = &b->own;
    b->name_id = name->id;
    b->scope = scope->number;
    b->outer = ev->bindings[name->id];
    b->scope_next = scope->bindings;
    scope->bindings = b;
    ev->bindings[name->id] = b;
    return b;
}

/* A new global goes below whatever locals the name has: there are none, or #declare would have found them. */
static Scope *global_scope(Eval *ev) {
    Scope *s = ev->scope;
    while (s->outer) s = s->outer;
    return s;
}

bool scope_may_declare(Eval *ev, Name name, ValueKind kind, Span span) {
    VarBinding *b = scope_find(ev, name);
    ValueKind old = b && b->slot->set ? b->slot->value.kind : VALUE_ERROR;
    bool fixed = old == VALUE_MACRO || old == VALUE_FUNCTION;
    if (old == VALUE_ERROR || (!fixed && kind != VALUE_FUNCTION)) return true;
    diag_error(ev->diags, span, "'%s' is %s already: #undef it first", name->text, value_kind_text(old));
    return false;
}

Slot *scope_declare(Eval *ev, Name name, bool local) {
    VarBinding *b = scope_find(ev, name);
    if (b && (!local || b->scope == ev->scope->number)) return b->slot;
    note_change(ev, binding_class(b), NAME_UNKNOWN);
    return push(ev, name, local ? ev->scope : global_scope(ev))->slot;
}

Slot *scope_bind(Eval *ev, Name name, Slot *reference, const Value *value) {
    NameClass before = binding_class(scope_find(ev, name));
    VarBinding *b = push(ev, name, ev->scope);
    uint64_t stamp = ev->name_stamp;
    if (reference) {
        b->slot = reference;
    } else if (!value) {
        slot_clear(ev, b->slot);
    } else if (value->kind == VALUE_FLOAT) {
        b->own.value = *value;
        b->own.set = true;
    } else {
        slot_set(ev, b->slot, value);
    }
    ev->name_stamp = stamp;
    note_change(ev, before, binding_class(b));
    return b->slot;
}

void scope_undef(Eval *ev, Name name) {
    VarBinding *b = scope_find(ev, name);
    if (!b) return;
    for (Scope *s = ev->scope; s; s = s->outer) {
        if (s->number != b->scope) continue;
        for (VarBinding **p = &s->bindings; *p; p = &(*p)->scope_next)
            if (*p == b) {
                *p = b->scope_next;
                drop(ev, b);
                return;
            }
    }
}

NameClass scope_classify(const Eval *ev, Name name, const Macro **macro) {
    *macro = NULL;
    const VarBinding *b = scope_find(ev, name);
    NameClass class = binding_class(b);
    if (class == NAME_MACRO) *macro = b->slot->value.as.macro;
    return class;
}
