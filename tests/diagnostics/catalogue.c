#define _XOPEN_SOURCE 700
#include "catalogue.h"

#include "base/strbuf.h"

#include <ctype.h>
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What emits diagnostics, and which of its arguments is the format. A new function of this kind (marked VTS_PRINTF) belongs here. */
typedef struct Emitter {
    const char *name;
    int format; /* 1: the first argument; 0: emits no message of its own (notes, hints, texts) */
} Emitter;
static const Emitter emitters[] = {
    {"diag_error", 3}, {"diag_warning", 3},  {"reader_error", 3},     {"parser_fail", 3},
    {"eval_fail", 3},  {"compiler_fail", 3}, {"parser_fail_hint", 4}, {"diag_note", 0},
    {"diag_hint", 0},  {"strbuf_addf", 0},   {"arena_printf", 0},     {"format_refuse", 0},
    {"map_fail", 0},   {"say", 0},
};

const char *catalogue_message(Arena *arena, const char *format) {
    StrBuf out = {0};
    for (const char *p = format; *p; p++) {
        if (*p != '%') {
            strbuf_addc(&out, *p);
        } else if (p[1] == '%') {
            strbuf_addc(&out, *++p);
        } else {
            strbuf_adds(&out, "…");
            while (p[1] && !isalpha((unsigned char)p[1])) p++;
            while (strchr("hlzjtL", p[1]) && p[1]) p++;
            if (p[1]) p++;
        }
    }
    const char *message = arena_strdup(arena, out.data ? out.data : "");
    strbuf_free(&out);
    return message;
}

void catalogue_add(Arena *arena, Catalogue *list, const char *message, const char *place) {
    if (!catalogue_find(list, message)) *list_push(arena, list) = (CatalogueEntry){message, place};
}

const CatalogueEntry *catalogue_find(const Catalogue *list, const char *message) {
    for (size_t i = 0; i < list->count; i++)
        if (strcmp(list->items[i].message, message) == 0) return &list->items[i];
    return NULL;
}

static char *read_whole(Arena *arena, const char *path) {
    FILE *f = fopen(path, "rb");
    if (!f) return NULL;
    StrBuf text = {0};
    char piece[4096];
    for (size_t got; (got = fread(piece, 1, sizeof piece, f)) > 0;) strbuf_add(&text, piece, got);
    fclose(f);
    char *out = arena_strdup(arena, text.data ? text.data : "");
    strbuf_free(&text);
    return out;
}

/* ---- sources ---- */

typedef struct Reading {
    Arena *arena;
    Catalogue *out;
    const char *name, *text;
    bool ok;
} Reading;

static unsigned line_of(const Reading *r, const char *at) {
    unsigned line = 1;
    for (const char *p = r->text; p < at; p++) line += *p == '\n';
    return line;
}

/* Past a string, a character or a comment that begins at p; p itself where none does. */
static const char *skip_quoted(const char *p) {
    if (*p == '"' || *p == '\'') {
        char quote = *p++;
        while (*p && *p != quote) p += *p == '\\' && p[1] ? 2 : 1;
        return *p ? p + 1 : p;
    }
    if (p[0] == '/' && p[1] == '*') {
        const char *end = strstr(p + 2, "*/");
        return end ? end + 2 : p + strlen(p);
    }
    if (p[0] == '/' && p[1] == '/') return p + strcspn(p, "\n");
    return p;
}

/* The characters of a literal; NULL for an escape that messages have no use for. */
static const char *add_literal(StrBuf *out, const char *p) {
    for (p++; *p && *p != '"'; p++) {
        if (*p == '\\') p++;
        strbuf_addc(out, *p);
    }
    return p + 1;
}

static void add_format(Reading *r, StrBuf *format, const char *at) {
    catalogue_add(r->arena, r->out, catalogue_message(r->arena, format->data ? format->data : ""),
                  arena_printf(r->arena, "%s:%u", r->name, line_of(r, at)));
    strbuf_free(format);
}

/* An argument up to the ',' or ')' behind it. Its literals are formats, one for each branch of a ?: */
static const char *read_argument(Reading *r, const char *p, bool is_format) {
    const char *begin = p + strspn(p, " \n");
    StrBuf format = {0};
    int depth = 0, literals = 0;
    for (p = begin; *p && (depth > 0 || (*p != ',' && *p != ')'));) {
        if (is_format && depth == 0 && *p == '"') {
            p = add_literal(&format, p);
            p += strspn(p, " \n");
            if (*p == '"') continue;
            add_format(r, &format, begin);
            literals++;
            continue;
        }
        const char *past = skip_quoted(p);
        if (past > p) {
            p = past;
            continue;
        }
        depth += (*p == '(' || *p == '{' || *p == '[') - (*p == ')' || *p == '}' || *p == ']');
        p++;
    }
    bool passes_on = strncmp(begin, "const char", 10) == 0 || strncmp(begin, "format", 6) == 0;
    if (is_format && !literals && !passes_on) {
        printf("%s:%u: the format must be a literal at the call\n", r->name, line_of(r, begin));
        r->ok = false;
    }
    return p;
}

static void read_call(Reading *r, const char *p, int format) {
    for (int i = 1; *p && *p != ')'; i++) {
        p = read_argument(r, p, i == format);
        if (*p == ',') p++;
    }
}

static const Emitter *emitter_at(const char *word, size_t length) {
    for (size_t i = 0; i < VTS_ARRAY_COUNT(emitters); i++)
        if (strlen(emitters[i].name) == length && strncmp(emitters[i].name, word, length) == 0)
            return &emitters[i];
    return NULL;
}

/* A function marked VTS_PRINTF(k, n) before or after its name that the table above does not know. */
static void check_marked(Reading *r, const char *mark) {
    const char *p = mark, *end;
    while (p > r->text && isspace((unsigned char)p[-1])) p--;
    if (p > r->text && p[-1] == ')') {
        int depth = 0;
        do {
            p--;
            depth += (*p == ')') - (*p == '(');
        } while (p > r->text && depth > 0);
        end = p;
    } else {
        p = strchr(mark, ')') + 1;
        end = strchr(p, '(');
        if (!end) return;
    }
    for (p = end; p > r->text && (isalnum((unsigned char)p[-1]) || p[-1] == '_');) p--;
    if (strstr(mark, ", 0)") == strchr(mark, ',') || emitter_at(p, (size_t)(end - p))) return;
    printf("%s:%u: %.*s() takes a format: name it in the table `emitters` of tests/diagnostics/catalogue.c\n",
           r->name, line_of(r, mark), (int)(end - p), p);
    r->ok = false;
}

static void read_source(Reading *r) {
    for (const char *p = r->text; *p;) {
        const char *past = skip_quoted(p);
        if (past > p) {
            p = past;
        } else if (isalpha((unsigned char)*p) || *p == '_') {
            size_t n = 1;
            while (isalnum((unsigned char)p[n]) || p[n] == '_') n++;
            const Emitter *e = emitter_at(p, n);
            bool define = p > r->text + 8 && strncmp(p - 8, "#define ", 8) == 0;
            if (e && e->format && p[n] == '(') read_call(r, p + n + 1, e->format);
            if (n == 10 && strncmp(p, "VTS_PRINTF", n) == 0 && p[n] == '(' && !define) check_marked(r, p);
            p += n;
        } else {
            p++;
        }
    }
}

static void read_folder(Reading *r, const char *folder, const char *shown) {
    DIR *d = opendir(folder);
    if (!d) {
        r->ok = false;
        return;
    }
    for (struct dirent *e; (e = readdir(d));) {
        const char *suffix = strrchr(e->d_name, '.');
        const char *path = arena_printf(r->arena, "%s/%s", folder, e->d_name);
        const char *name = arena_printf(r->arena, "%s%s", shown, e->d_name);
        if (!suffix) {
            read_folder(r, path, arena_printf(r->arena, "%s/", name));
        } else if (strcmp(suffix, ".c") == 0 || strcmp(suffix, ".h") == 0) {
            r->name = name;
            r->text = read_whole(r->arena, path);
            if (r->text) read_source(r);
        }
    }
    closedir(d);
}

bool catalogue_read_sources(Arena *arena, const char *folder, Catalogue *out) {
    Reading r = {.arena = arena, .out = out, .ok = true};
    read_folder(&r, folder, "");
    return r.ok;
}

/* ---- texts ---- */

static bool read_texts(Arena *arena, const char *path, Catalogue *out, bool rows) {
    char *text = read_whole(arena, path);
    if (!text) return false;
    unsigned number = 1;
    for (char *line = text, *next; line; line = next, number++) {
        next = strchr(line, '\n');
        if (next) *next++ = '\0';
        const char *place = arena_printf(arena, "line %u", number);
        if (rows && strncmp(line, "| `", 3) == 0) {
            char *end = strchr(line + 3, '`'), *to = line + 3;
            if (!end) return false;
            *end = '\0';
            for (char *from = to; (*to = *from); from++) to += !(from[0] == '\\' && from[1] == '|');
            catalogue_add(arena, out, line + 3, place);
        } else if (!rows && *line && *line != '#') {
            catalogue_add(arena, out, line, place);
        }
    }
    return true;
}

bool catalogue_read_page(Arena *arena, const char *path, Catalogue *out) {
    return read_texts(arena, path, out, true);
}
bool catalogue_read_lines(Arena *arena, const char *path, Catalogue *out) {
    return read_texts(arena, path, out, false);
}
