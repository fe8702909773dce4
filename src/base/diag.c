#include "base/diag.h"

#include "base/utf8.h"

#include <stdio.h>
#include <string.h>

enum { DEFAULT_ERROR_LIMIT = 20, MOST_WARNINGS = 1000, LONGEST_SHOWN_LINE = 160 };

void diag_init(DiagList *list, Arena *arena, SourceSet *sources) {
    *list = (DiagList){.arena = arena, .sources = sources};
}

bool diag_full(const DiagList *list) {
    return list->error_count >= (list->error_limit ? list->error_limit : DEFAULT_ERROR_LIMIT);
}

static bool error_exists_at(const DiagList *list, Span span) {
    if (span.file == 0) return false;
    for (const Diagnostic *d = list->first; d; d = d->next)
        if (d->severity == SEVERITY_ERROR && d->span.file == span.file && d->span.begin == span.begin) return true;
    return false;
}

/* A loop warns once; and what warns at ever new places does not fill the memory. */
static bool is_repeated_warning(const DiagList *list, Span span, const char *format) {
    if (list->kept_warnings >= MOST_WARNINGS) return true;
    for (const Diagnostic *d = list->first; d; d = d->next)
        if (d->severity == SEVERITY_WARNING && d->format == format && d->span.file == span.file &&
            d->span.begin == span.begin && d->span.end == span.end && span.file)
            return true;
    return false;
}

bool diag_error_before(const DiagList *list, Span span) {
    for (const Diagnostic *d = list->first; d; d = d->next)
        if (d->severity == SEVERITY_ERROR && d->span.file == span.file && d->span.begin < span.begin &&
            source_locate(list->sources, d->span).line == source_locate(list->sources, span).line)
            return true;
    return false;
}

static Diagnostic *add(DiagList *list, Severity severity, Span span, const char *format, va_list args) {
    if (severity == SEVERITY_ERROR) {
        list->failures++;
        if (error_exists_at(list, span)) return NULL;
        bool full = diag_full(list);
        list->error_count++;
        if (full) return NULL;
    } else {
        list->warning_count++;
        if (is_repeated_warning(list, span, format)) return NULL;
        list->kept_warnings++;
    }
    Diagnostic *d = arena_new(list->arena, Diagnostic);
    d->severity = severity;
    d->span = span;
    d->message = arena_vprintf(list->arena, format, args);
    d->format = format;
    if (list->last) list->last->next = d;
    else list->first = d;
    list->last = d;
    if (list->add_context_notes) list->add_context_notes(list->context, list, d);
    return d;
}

Diagnostic *diag_error_va(DiagList *list, Span span, const char *format, va_list args) {
    return add(list, SEVERITY_ERROR, span, format, args);
}

Diagnostic *diag_error(DiagList *list, Span span, const char *format, ...) {
    va_list args;
    va_start(args, format);
    Diagnostic *d = add(list, SEVERITY_ERROR, span, format, args);
    va_end(args);
    return d;
}

Diagnostic *diag_warning(DiagList *list, Span span, const char *format, ...) {
    va_list args;
    va_start(args, format);
    Diagnostic *d = add(list, SEVERITY_WARNING, span, format, args);
    va_end(args);
    return d;
}

void diag_note(DiagList *list, Diagnostic *to, Span span, const char *format, ...) {
    if (!to) return;
    Diagnostic *note = arena_new(list->arena, Diagnostic);
    note->severity = SEVERITY_NOTE;
    note->span = span;
    va_list args;
    va_start(args, format);
    note->format = format;
    note->message = arena_vprintf(list->arena, format, args);
    va_end(args);
    Diagnostic **end = &to->notes;
    while (*end) end = &(*end)->next;
    *end = note;
}

void diag_hint(DiagList *list, Diagnostic *to, const char *format, ...) {
    if (!to) return;
    va_list args;
    va_start(args, format);
    to->hint = arena_vprintf(list->arena, format, args);
    va_end(args);
}

static size_t count_characters(const char *text, size_t size) {
    size_t count = 0;
    for (size_t i = 0; i < size; i += size_max(utf8_size(text + i, size - i), 1)) count++;
    return count;
}

/* Control characters would move the caret, bytes that are no UTF-8 confuse terminals. */
static void add_visible(StrBuf *out, const char *text, size_t size) {
    for (size_t i = 0, n; i < size; i += size_max(n, 1)) {
        n = utf8_size(text + i, size - i);
        if (n == 1 && ((unsigned char)text[i] < 0x20 || text[i] == 0x7F)) strbuf_addc(out, ' ');
        else if (n == 0) strbuf_adds(out, "\xEF\xBF\xBD");
        else strbuf_add(out, text + i, n);
    }
}

static size_t character_begin(const char *line, size_t at) {
    size_t begin = at;
    while (begin > 0 && at - begin < 3 && ((unsigned char)line[begin] & 0xC0u) == 0x80u) begin--;
    return begin;
}

/* The source line, and under it a caret at the span's first character, extended over the rest of it on this line.
 * A long line is shown in part, around the span. */
static void add_excerpt(StrBuf *out, SourceSet *sources, Span span, SourcePlace place, bool colour) {
    size_t size;
    const char *line = source_line(sources, place.file, place.line, &size);
    size_t before = (size_t)(line - place.file->text);
    size_t start = span.begin > before ? size_min(span.begin - before, size) : 0;
    size_t length = span.end > span.begin ? span.end - span.begin : 1;
    if (start + length > size) length = size > start ? size - start : 1;
    size_t from = 0, shown = size;
    if (size > LONGEST_SHOWN_LINE) {
        from = start > LONGEST_SHOWN_LINE / 2 ? character_begin(line, start - LONGEST_SHOWN_LINE / 2) : 0;
        shown = size_min(size - from, LONGEST_SHOWN_LINE);
        if (from + shown < size) shown = character_begin(line, from + shown) - from;
        if (length > from + shown - start) length = from + shown - start;
    }
    char number[24];
    int width = snprintf(number, sizeof number, "%5u", place.line);
    strbuf_addf(out, "%s | %s", number, from ? "…" : "");
    add_visible(out, line + from, shown);
    strbuf_addf(out, "%s\n", from + shown < size ? "…" : "");
    strbuf_repeat(out, ' ', (size_t)width);
    strbuf_adds(out, " | ");
    strbuf_repeat(out, ' ', count_characters(line + from, start - from) + (from ? 1 : 0));
    if (colour) strbuf_adds(out, "\033[1;32m");
    size_t marks = start < size ? count_characters(line + start, length) : 1;
    strbuf_addc(out, '^');
    if (marks > 1) strbuf_repeat(out, '~', marks - 1);
    if (colour) strbuf_adds(out, "\033[0m");
    strbuf_addc(out, '\n');
}

static void add_one(StrBuf *out, SourceSet *sources, const Diagnostic *d, bool colour) {
    static const char *const words[] = {"note", "warning", "error"};
    static const char *const colours[] = {"\033[1;36m", "\033[1;35m", "\033[1;31m"};
    SourcePlace place = source_locate(sources, d->span);
    if (place.file) strbuf_addf(out, "%s:%u:%u: ", place.file->name, place.line, place.column);
    else strbuf_adds(out, "vts: ");
    if (colour) strbuf_addf(out, "%s%s:\033[0m %s\n", colours[d->severity], words[d->severity], d->message);
    else strbuf_addf(out, "%s: %s\n", words[d->severity], d->message);
    if (place.file) add_excerpt(out, sources, d->span, place, colour);
}

void diag_format(StrBuf *out, SourceSet *sources, const Diagnostic *diagnostic, bool colour) {
    add_one(out, sources, diagnostic, colour);
    if (diagnostic->hint) strbuf_addf(out, "      = help: %s\n", diagnostic->hint);
    for (const Diagnostic *note = diagnostic->notes; note; note = note->next) add_one(out, sources, note, colour);
}
