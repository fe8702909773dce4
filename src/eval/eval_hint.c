/* What likely helps where a name is not declared: an #include that is missing, another spelling, a longer name. */
#define _DEFAULT_SOURCE /* scandir, alphasort */

#include "eval/eval_state.h"

#include <ctype.h>
#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const char *eval_suggest_name(const BuildContext *context, const char *text, const char *const *words,
                              size_t word_count) {
    Eval *ev = context->eval;
    size_t count = word_count;
    const char **candidates = arena_new_array(context->arena, const char *,
                                              word_count + KW_COUNT + (ev ? ev->names->count : 0));
    for (size_t i = 0; i < word_count; i++) candidates[i] = words[i];
    for (uint32_t i = 0; ev && i < ev->names->slot_count; i++) {
        Name other = ev->names->slots[i];
        VarBinding *b = other ? scope_find(ev, other) : NULL;
        if (b && b->slot->set && b->slot->value.kind != VALUE_ERROR) candidates[count++] = other->text;
    }
    for (int k = 1; ev && k < KW_COUNT; k++)
        if (keyword_class((Keyword)k) == KEYWORD_FUNCTION) candidates[count++] = keyword_text((Keyword)k);
    return closest_word(text, candidates, count);
}

/* ---- names of the library ---- */

static bool in_name(char c) { return isalnum((unsigned char)c) || c == '_'; }

/* Whether "#declare" or "#macro" ends before `at`, spaces aside. */
static bool declared_at(const char *text, const char *at) {
    while (at > text && isspace((unsigned char)at[-1])) at--;
    static const char *const directives[] = {"#declare", "#macro"};
    for (size_t i = 0; i < VTS_ARRAY_COUNT(directives); i++) {
        size_t size = strlen(directives[i]);
        if ((size_t)(at - text) >= size && memcmp(at - size, directives[i], size) == 0) return true;
    }
    return false;
}

static bool text_declares(const char *text, const char *name) {
    size_t size = strlen(name);
    for (const char *at = strstr(text, name); at; at = strstr(at + 1, name))
        if (!in_name(at[size]) && at > text && !in_name(at[-1]) && declared_at(text, at)) return true;
    return false;
}

static int is_include(const struct dirent *entry) {
    size_t size = strlen(entry->d_name);
    return size > 4 && strcmp(entry->d_name + size - 4, ".inc") == 0;
}

/* The first file of the library, in the order of the alphabet, that declares `name` and was not included; or NULL. */
static const char *library_file_of(Eval *ev, const char *name) {
    const char *folder = ev->options->stdlib_dir;
    struct dirent **entries = NULL;
    int count = folder ? scandir(folder, &entries, is_include, alphasort) : 0;
    const char *found = NULL;
    SourceSet library; /* not the scene's: its files are not what the scene was read from */
    source_set_init(&library, ev->parse);
    for (int i = 0; i < count; i++) {
        const char *path = arena_printf(ev->parse, "%s/%s", folder, entries[i]->d_name);
        const SourceFile *file;
        if (!found && !source_holds(ev->sources, path) && source_load(&library, path, NULL, &file) == SOURCE_OK &&
            text_declares(file->text, name))
            found = arena_strdup(ev->parse, entries[i]->d_name);
        free(entries[i]);
    }
    free(entries);
    return found;
}

/* ---- names that begin so ---- */

static int by_alphabet(const void *a, const void *b) { return strcmp(*(const char *const *)a, *(const char *const *)b); }

/* "Spruce_Plant, Spruce_Stand_1, …" for "Spruce", what is declared of it; or NULL. */
static const char *longer_names(Eval *ev, const char *text) {
    enum { MOST = 4 };
    size_t size = strlen(text), count = 0;
    const char **names = arena_new_array(ev->parse, const char *, ev->names->count);
    for (uint32_t i = 0; i < ev->names->slot_count; i++) {
        Name other = ev->names->slots[i];
        if (!other || strncasecmp(other->text, text, size) != 0 || other->text[size] != '_') continue;
        VarBinding *b = scope_find(ev, other);
        if (b && b->slot->set && b->slot->value.kind != VALUE_ERROR) names[count++] = other->text;
    }
    if (count == 0) return NULL;
    qsort(names, count, sizeof *names, by_alphabet);
    const char *list = names[0];
    for (size_t i = 1; i < count && i < MOST; i++) list = arena_printf(ev->parse, "%s, %s", list, names[i]);
    return count > MOST ? arena_printf(ev->parse, "%s and others", list) : list;
}

void eval_hint_name(const BuildContext *context, Diagnostic *d, const char *text, const char *const *words,
                    size_t word_count) {
    if (!d) return;
    Eval *ev = context->eval;
    const char *file = ev ? library_file_of(ev, text) : NULL;
    if (file) {
        diag_hint(context->diags, d, "'%s' is of the standard library: #include \"%s\"", text, file);
        return;
    }
    const char *closest = eval_suggest_name(context, text, words, word_count);
    const char *longer = ev && !closest ? longer_names(ev, text) : NULL;
    if (closest) diag_hint(context->diags, d, "did you mean '%s'?", closest);
    if (longer) diag_hint(context->diags, d, "declared are %s", longer);
}
