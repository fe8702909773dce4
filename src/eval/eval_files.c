#include "eval/eval_files.h"

#include <errno.h>
#include <string.h>

bool file_is_open(const UserFile *file) { return file->open && !file->ended; }

MemoryFile *files_in_memory(const Eval *ev, const char *name) {
    for (MemoryFile *m = ev->memory; m; m = m->next)
        if (strcmp(m->name, name) == 0) return m;
    return NULL;
}

static void close_file(Eval *ev, UserFile *f) {
    if (f->stream) {
        fclose(f->stream);
        source_forget(ev->sources, f->path);
    }
    f->stream = NULL;
    f->open = false;
}

void files_close_all(Eval *ev) {
    for (UserFile *f = ev->files; f; f = f->next) close_file(ev, f);
    for (MemoryFile *m = ev->memory; m; m = m->next) strbuf_free(&m->text);
    ev->memory = NULL;
}

const SourceFile *eval_find_text(Eval *ev, const char *name, Span span) {
    const SourceFile *source = NULL;
    const MemoryFile *m = files_in_memory(ev, name);
    if (m) return source_add_text(ev->sources, name, m->text.data ? m->text.data : "", m->text.size);
    Diagnostic *refused = NULL;
    StrBuf places = {0};
    const char *path = path_find(ev, name, span, &refused, &places);
    if (!path && !refused) {
        Diagnostic *d = diag_error(ev->diags, span, "there is no file '%s'", name);
        diag_hint(ev->diags, d, "looked in %s", places.data ? places.data : "no folder");
    }
    strbuf_free(&places);
    return path && eval_load_text(ev, path, span, &source) == SOURCE_OK ? source : NULL;
}

static bool open_for_reading(Eval *ev, UserFile *f, const char *name, Span span) {
    const SourceFile *source = eval_find_text(ev, name, span);
    if (source) f->tokens = lexer_run(source, &ev->keywords, ev->parse);
    return source != NULL;
}

static bool open_for_writing(Eval *ev, UserFile *f, const char *name, Span span) {
    if (ev->options->keep_writes_in_memory) {
        MemoryFile *m = files_in_memory(ev, name);
        if (!m) {
            m = arena_new(ev->parse, MemoryFile);
            m->name = arena_strdup(ev->parse, name);
            m->next = ev->memory;
            ev->memory = m;
        }
        if (f->mode == KW_write) strbuf_clear(&m->text);
        f->memory = &m->text;
        return true;
    }
    const char *path =
        name[0] == '/'
            ? name
            : arena_printf(ev->parse, "%s/%s",
                           ev->options->allow_write_count ? ev->options->allow_write[0] : ".", name);
    if (!path_may_write(ev, path)) {
        Diagnostic *d = diag_error(ev->diags, span, "the scene may not write '%s'", name);
        diag_hint(ev->diags, d, "--allow-write gives it a folder");
        return false;
    }
    f->path = path;
    source_forget(ev->sources, path);
    f->stream = fopen(path, f->mode == KW_append ? "ab" : "wb");
    if (!f->stream) diag_error(ev->diags, span, "'%s' cannot be written: %s", path, strerror(errno));
    return f->stream != NULL;
}

void run_fopen(Eval *ev, const Node *node) {
    const Node *handle = node->as.list.items[0], *path = node->as.list.items[1];
    const char *name;
    if (handle->kind != NODE_NAME) {
        diag_error(ev->diags, handle->span, "a file handle is a plain name");
        return;
    }
    VarBinding *b = scope_find(ev, handle->as.name);
    bool ended = b && b->slot->value.kind == VALUE_FILE && !file_is_open(b->slot->value.as.file);
    if (b && b->slot->set && !ended && b->slot->value.kind != VALUE_ERROR) {
        diag_error(ev->diags, handle->span, "'%s' is %s already: #undef it first", handle->as.name->text,
                   value_kind_text(b->slot->value.kind));
        return;
    }
    if (!eval_string(ev, path, &name, NULL)) return;
    UserFile *f = arena_new(ev->parse, UserFile);
    *f = (UserFile){.path = arena_strdup(ev->parse, name), .mode = (Keyword)node->op};
    Value v = {.kind = VALUE_FILE, .as.file = f};
    f->open = f->mode == KW_read ? open_for_reading(ev, f, name, path->span)
                                 : open_for_writing(ev, f, name, path->span);
    if (!f->open)
        v = value_error();
    else
        f->next = ev->files, ev->files = f;
    slot_set(ev, scope_declare(ev, handle->as.name, false), &v);
}

static UserFile *handle_of(Eval *ev, const Node *node) {
    bool failed = false;
    Slot *slot = eval_target(ev, node, &failed);
    if (failed) return NULL;
    if (!slot || !slot->set) {
        if (node->kind == NODE_NAME) eval_undeclared(ev, node->as.name, node->span);
        return NULL;
    }
    if (slot->value.kind == VALUE_ERROR) return NULL;
    if (slot->value.kind == VALUE_FILE && slot->value.as.file->open) return slot->value.as.file;
    diag_error(ev->diags, node->span, "expected the handle of an open file");
    return NULL;
}

void run_fclose(Eval *ev, const Node *node) {
    const Node *handle = node->as.list.items[0];
    const VarBinding *b = handle->kind == NODE_NAME ? scope_find(ev, handle->as.name) : NULL;
    if (handle->kind == NODE_NAME && (!b || !b->slot->set)) { /* closing twice does no harm */
        diag_warning(ev->diags, handle->span, "'%s' is no open file", handle->as.name->text);
        return;
    }
    UserFile *f = handle_of(ev, handle);
    if (!f) return;
    close_file(ev, f);
    if (handle->kind == NODE_NAME) scope_undef(ev, handle->as.name);
}

/* ---- #read ---- */

static bool take(UserFile *f, int kind) {
    if (f->tokens->items[f->at].kind != kind) return false;
    f->at++;
    return true;
}

/* ["-" | "+"] number */
static bool read_number(UserFile *f, double *out) {
    double sign = 1;
    if (take(f, '-'))
        sign = -1;
    else
        take(f, '+');
    const Token *t = &f->tokens->items[f->at];
    if (!take(f, TOKEN_NUMBER)) return false;
    *out = sign * t->as.number;
    return true;
}

/* value = string | number | "<" number { [","] number } ">" */
static bool read_value(Eval *ev, UserFile *f, Value *out) {
    const Token *t = &f->tokens->items[f->at];
    double c[5];
    int n = 0;
    if (take(f, TOKEN_STRING)) {
        *out = value_string(ev, t->as.string->text, t->as.string->length);
        return true;
    }
    if (!take(f, '<')) {
        if (!read_number(f, &c[0])) return false;
        *out = value_float(c[0]);
        return true;
    }
    while (n < 5 && read_number(f, &c[n])) {
        n++;
        take(f, ',');
    }
    if (n < 2 || !take(f, '>')) return false;
    *out = value_vector(ev, c, n);
    return true;
}

/* One token separates values, whatever it is; the file ends where there is none. As in POV-Ray a comma behind the last value promises
 * another: only the #read that misses it finds the end. */
static void take_separator(Eval *ev, UserFile *f) {
    const Token *t = &f->tokens->items[f->at];
    f->ended = t->kind == TOKEN_END;
    if (f->ended) return;
    if (t->kind != ',')
        diag_warning(ev->diags, t->span, "%s is skipped: a comma is needed between values",
                     token_describe(t, ev->sources, &ev->temp));
    f->at++;
}

/* At the end of the file the variables stay as they are. */
void run_read(Eval *ev, const Node *node) {
    UserFile *f = handle_of(ev, node->as.list.items[0]);
    if (!f) return;
    if (f->mode != KW_read) {
        diag_error(ev->diags, node->as.list.items[0]->span, "this file is open for writing");
        return;
    }
    if (f->ended) { /* POV-Ray closes it there, and has forgotten its handle */
        diag_error(ev->diags, node->as.list.items[0]->span, "this file has been read to its end");
        return;
    }
    for (size_t i = 1; i < node->as.list.count; i++) {
        const Node *target = node->as.list.items[i];
        Value v;
        const Token *t = &f->tokens->items[f->at];
        if (t->kind == TOKEN_END) {
            f->ended = true;
            return;
        }
        if (!read_value(ev, f, &v)) {
            Diagnostic *d = diag_error(ev->diags, t->span,
                                       "the next value of '%s' is no number, vector or string", f->path);
            diag_note(ev->diags, d, target->span, "read here");
            return;
        }
        take_separator(ev, f);
        bool failed = false;
        Slot *slot = target->kind == NODE_NAME ? scope_declare(ev, target->as.name, false)
                                               : eval_target(ev, target, &failed);
        if (slot) slot_set(ev, slot, &v);
    }
}

/* ---- #write ---- */

static void format_value(StrBuf *out, const Value *v) {
    if (v->kind == VALUE_STRING)
        strbuf_add(out, v->as.string.text, v->as.string.length);
    else if (v->kind == VALUE_FLOAT)
        strbuf_addf(out, "%g", v->as.number);
    else {
        for (int i = 0; i < v->size; i++) strbuf_addf(out, "%c%g", i ? ',' : '<', v->as.components[i]);
        strbuf_adds(out, "> ");
    }
}

void run_write(Eval *ev, const Node *node) {
    UserFile *f = handle_of(ev, node->as.list.items[0]);
    StrBuf text = {0};
    for (size_t i = 1; i < node->as.list.count; i++) {
        Value v = eval_node(ev, node->as.list.items[i]);
        if (value_is_numeric(&v) || v.kind == VALUE_STRING)
            format_value(&text, &v);
        else if (v.kind != VALUE_ERROR)
            diag_error(ev->diags, node->as.list.items[i]->span, "%s cannot be written",
                       value_kind_text(v.kind));
    }
    if (f && f->mode == KW_read)
        diag_error(ev->diags, node->as.list.items[0]->span, "this file is open for reading");
    else if (f && (ev->written += text.size) > ev->options->limits.written_bytes)
        diag_error(ev->diags, node->span, "the scene writes more than %llu bytes",
                   (unsigned long long)ev->options->limits.written_bytes);
    else if (f && f->memory)
        strbuf_add(f->memory, text.data ? text.data : "", text.size);
    else if (f && text.size && fwrite(text.data, 1, text.size, f->stream) != text.size)
        diag_error(ev->diags, node->span, "writing '%s' failed", f->path);
    strbuf_free(&text);
}
