/* Diagnostics as data: severity, span, message, notes. Whoever finds an error adds one here and returns failure;
 * printing happens in one place (diag_format, called by the program). */
#ifndef VTS_BASE_DIAG_H
#define VTS_BASE_DIAG_H

#include "base/source.h"
#include "base/strbuf.h"

typedef enum Severity { SEVERITY_NOTE, SEVERITY_WARNING, SEVERITY_ERROR } Severity;

typedef struct Diagnostic Diagnostic;
struct Diagnostic {
    Severity severity;
    Span span;
    const char *message; /* one line, no full stop */
    const char *format;  /* what the message was made from: what kind of diagnostic this is (doc/diagnostics.md) */
    const char *hint;    /* NULL, or what likely helps: "did you mean 'pigment'?" */
    Diagnostic *notes;   /* first note, linked through `next` */
    Diagnostic *next;
};

typedef struct DiagList {
    Arena *arena;
    SourceSet *sources;
    Diagnostic *first, *last;
    size_t error_count, warning_count;
    size_t failures; /* errors found, those dropped as cascades too: whether something failed since */
    size_t error_limit; /* 0 = 20; errors past it are counted, not kept */
    size_t kept_warnings; /* at most 1000 */
    /* Added as notes to every new diagnostic: the include and macro stack; maintained by the evaluator. NULL: none. */
    void (*add_context_notes)(void *context, struct DiagList *list, Diagnostic *diagnostic);
    void *context;
} DiagList;

void diag_init(DiagList *list, Arena *arena, SourceSet *sources);

/* Add a diagnostic. An error at a span that already has one is dropped (a cascade), and so is a warning of the same kind at
 * the same span (the next pass of a loop). Returns it, so that a hint can be set, or NULL when it was dropped. Formats are
 * literals at the call and are listed in doc/diagnostics.md, which a test checks. */
Diagnostic *diag_error(DiagList *list, Span span, const char *format, ...) VTS_PRINTF(3, 4);
Diagnostic *diag_error_va(DiagList *list, Span span, const char *format, va_list args) VTS_PRINTF(3, 0);
Diagnostic *diag_warning(DiagList *list, Span span, const char *format, ...) VTS_PRINTF(3, 4);
/* Adds a note to `to` (no effect if NULL). */
void diag_note(DiagList *list, Diagnostic *to, Span span, const char *format, ...) VTS_PRINTF(4, 5);
void diag_hint(DiagList *list, Diagnostic *to, const char *format, ...) VTS_PRINTF(3, 4);
/* Whether an error is blamed on the line of `span`, before it: what does not parse after it is likely its consequence. */
bool diag_error_before(const DiagList *list, Span span);
/* Whether the error limit is reached: time to give up. */
bool diag_full(const DiagList *list);

/* The text that users see: "file:line:col: error: message", the source line, a caret under the span, hint and notes.
 * `colour`: with ANSI colours. */
void diag_format(StrBuf *out, SourceSet *sources, const Diagnostic *diagnostic, bool colour);

#endif
