/* What the language asks of L-systems: lsystem_string(), lsystem_count(). */
#include "eval/build_parts.h"
#include "eval/eval_function.h"

bool plant_derive(const BuildContext *context, const LSystem *system, LSystemWord *word) {
    Eval *ev = context->eval;
    const atomic_bool *interrupted = ev ? ev->options->interrupted : NULL;
    if (lsystem_derive(system, context->arena, context->diags, interrupted, word)) return true;
    if (interrupted && *interrupted) ev->interrupted = ev->stopped = true;
    return false;
}

/* The word of the plant that argument 0 is; false after a report. */
static bool plant_word(Eval *ev, const Node *node, LSystemWord *word) {
    const Node *argument = node->as.apply.list.items[0];
    Value v = eval_node(ev, argument);
    if (v.kind == VALUE_ERROR) return false;
    const Plant *plant = v.kind == VALUE_OBJECT && v.as.object->kind == OBJECT_UNION ? v.as.object->as.group->plant : NULL;
    if (!plant) {
        diag_error(ev->diags, argument->span, "expected an L-system, found %s", v.kind == VALUE_OBJECT ? "another object" : value_kind_text(v.kind));
        return false;
    }
    /* Only read from. */
    *word = (LSystemWord){(char *)(uintptr_t)plant->letters, (uint32_t *)(uintptr_t)plant->first, (double *)(uintptr_t)plant->parameters, plant->count};
    return true;
}

Value eval_lsystem_string(Eval *ev, const Node *node) {
    LSystemWord word;
    StrBuf text = {0};
    if (!plant_word(ev, node, &word)) return value_error();
    lsystem_print(&word, &text);
    Value v = value_string(ev, text.size ? text.data : "", text.size);
    strbuf_free(&text);
    return v;
}

Value eval_lsystem_count(Eval *ev, const Node *node) {
    LSystemWord word;
    const Node *argument = node->as.apply.list.items[1];
    if (!plant_word(ev, node, &word)) return value_error();
    const char *letter;
    size_t length;
    if (!eval_string(ev, argument, &letter, &length)) return value_error();
    if (length != 1) {
        diag_error(ev->diags, argument->span, "lsystem_count() counts one letter: \"F\"");
        return value_error();
    }
    return value_float((double)lsystem_count(&word, letter[0]));
}
