/* Recursive descent over tokens.
 *
 * The same functions read raw text (fast road) and text whose directives and macro calls are run while it is read (slow road).
 * On the fast road tokens come straight from a file's list, nothing is reported, and whatever cannot be understood as it stands (a
 * directive in the middle of an expression, a macro that is half of something, a plain mistake) makes the parse fail; the evaluator
 * then reads the statement on the slow road, where tokens come from ParserHost.pull, and where mistakes are reported. */
#ifndef VTS_PARSER_PARSER_H
#define VTS_PARSER_PARSER_H

#include "parser/ast.h"

typedef enum NameClass {
    NAME_UNKNOWN,
    NAME_PLAIN,
    NAME_CALLABLE, /* function or spline */
    NAME_MACRO,
} NameClass;

/* A name whose meaning decided how text was read: while it holds, the tree may be used again. */
typedef struct Assumption {
    Name name;
    NameClass class;
    const void *macro;
    Binding need; /* of a call in an expression */
    const Node *call;
} Assumption;

typedef struct AssumptionList {
    Assumption *items;
    size_t count, capacity;
} AssumptionList;

typedef struct Parser Parser;

typedef struct ParserHost {
    void *context;
    NameClass (*classify)(void *context, Name name, const void **macro);
    /* Whether a call of this macro stands for one expression, and how tightly it binds; BIND_NONE if it does not. */
    Binding (*macro_binding)(void *context, const void *macro);
    /* Whether the macro's body can be read by itself: it closes what it opens. */
    bool (*macro_is_whole)(void *context, const void *macro);
    /* Whether these tokens call a macro that opens or closes brackets of theirs; NULL: none does. */
    bool (*holds_half_macro)(void *context, const TokenList *tokens, uint32_t begin, uint32_t end);
    bool (*macro_is_block)(void *context, const void *macro); /* after macro_binding() */
    /* Slow road only. The next token, macros expanded and names replaced by their values unless the parser's `raw` is set. */
    Token (*pull)(void *context, Parser *parser);
    /* The raw token after the one that was pulled last, or the one `skip` tokens further; not taken. */
    const Token *(*after)(void *context, uint32_t skip);
    /* The index of the next raw token of the text that is being read. */
    uint32_t (*position)(void *context);
    /* When the last pulled token is an opening bracket whose match lies in the same text: that text, which is then skipped. */
    bool (*take_body)(void *context, Body *body);
    /* Evaluates a finished operand at once, so that effects happen in the order of the text. */
    Node *(*fold)(void *context, Node *node);
    /* Counts #end of groups that were passed so far. */
    size_t (*groups_ended)(void *context);
} ParserHost;

struct Parser {
    Arena *arena;
    DiagList *diags;
    const KeywordTable *keywords;
    const ParserHost *host;
    bool slow;
    bool reports;    /* fast road: report mistakes all the same, no slow road follows */
    bool failed;     /* fast road: not understood; slow road: an error was reported */
    TokenList *list; /* fast road: tokens [at, end) of it */
    uint32_t at, end;
    Token window; /* slow road: the token that was looked at but not taken */
    bool has_window;
    bool raw;         /* slow road: pull the next token as it is written */
    Token last;       /* the token that was taken last */
    Name block;       /* the block whose items are being read, NULL at top level */
    Name *parameters; /* of the function whose body is being read */
    size_t parameter_count;
    bool in_function;
    bool unfolded;   /* operands are kept as trees */
    bool heads_only; /* branches of directives need not be whole: the text after #end may complete them */
    bool semicolons_optional; /* before version 3.5 of the language */
    bool guessing;            /* names that mean nothing yet are taken for values */
    bool crossed;   /* slow road: a group ended between an operand and what follows it, outside of brackets */
    bool closed;    /* the last operand was a block, a function, an array or a text: no operator follows */
    int depth;      /* nesting, against the C stack */
    int brackets;   /* open ( < [ of the expression being read */
    bool expanding; /* within a block whose text is expanded as it is read */
    AssumptionList assumptions;
};

enum { PARSER_DEPTH_LIMIT = 200, PARSER_CHAIN_LIMIT = 4000, VECTOR_LONGEST = 255 };

/* One statement of a body: an item or a directive. NULL when it failed; TOKEN_END is not a statement. */
Node *parser_statement(Parser *parser);
/* The head of a directive and the ranges of its bodies; the directive's token is `directive`, already taken, at index `index` of
 * `list`. On the fast road the parser is then past #end; on the slow road *next is set to the raw token to go on with when the directive
 * has bodies, else to 0. */
Node *parser_directive(Parser *parser, TokenList *list, uint32_t index, uint32_t *next);
/* "(" arguments ")" of a macro call. */
bool parser_arguments(Parser *parser, NodeList *arguments);
bool parser_at_end(Parser *parser);
/* The #end of the group whose directive is at `index` (the #if, or any #else … of it), or TOKEN_END where it is missing. */
uint32_t group_end(const TokenList *list, uint32_t index);
/* Reports that the group whose first directive is at `head` has no #end: at the end of the file, with a note where it begins. */
void group_report_endless(DiagList *diags, const TokenList *list, Span head);
/* Reports an #else, #case … that continues nothing. */
void group_report_stray(DiagList *diags, const Token *directive);

/* Whether a body can be run by itself: brackets balanced, and no operator dangling at either end. */
bool parser_body_is_whole(const Body *body);

/* ---- for the parser's own files ---- */
const Token *parser_peek(Parser *parser);
const Token *parser_peek_after(Parser *parser);
Token parser_take(Parser *parser);
bool parser_accept(Parser *parser, int kind);
bool parser_accept_keyword(Parser *parser, Keyword keyword);
/* Where something is missing: at the next token, or behind the last one where nothing or a directive follows. */
Span parser_here(Parser *parser);
bool parser_expect(Parser *parser, int kind, const char *what);
/* Makes the parse fail without a word: on the fast road, for what the slow road will read. Returns NULL. */
Node *parser_give_up(Parser *parser);
/* Reports on the slow road, fails on both. Returns NULL. */
Node *parser_fail(Parser *parser, Span span, const char *format, ...) VTS_PRINTF(3, 4);
/* Slow road, outside of brackets: whether a directive comes next, which looking at the next token would run. */
bool parser_directive_follows(Parser *parser);
/* The same with a hint (NULL: none), which must be a literal. */
Node *parser_fail_hint(Parser *parser, Span span, const char *hint, const char *format, ...) VTS_PRINTF(4, 5);
/* The token in words, for "expected …, found …". */
const char *parser_found(Parser *parser, const Token *token);
Node *parser_node(Parser *parser, NodeKind kind, Span begin);
bool parser_enter(Parser *parser);
static inline void parser_leave(Parser *parser) { parser->depth--; }
NameClass parser_classify(Parser *parser, Name name, const void **macro);
/* On the slow road, the finished operand evaluated. */
Node *parser_fold(Parser *parser, Node *node);
Node *parser_expression(Parser *parser); /* additive */
Node *parser_layers(Parser *parser);     /* additive, or several texture blocks: layers of one */
Node *parser_full(Parser *parser);       /* with comparisons and ?: */
Node *parser_color(Parser *parser);
Node *parser_function(Parser *parser);
Node *parser_array(Parser *parser);
/* `dictionary` where it is no name of the scene's. */
bool parser_begins_dictionary(Parser *parser);
Node *parser_dictionary(Parser *parser);
/* word { body }, the word being the next token. */
Node *parser_block(Parser *parser);
/* { body } or [ body ], the opening bracket being the next token. NULL after failure. */
Body *parser_body(Parser *parser, Name block);
/* name { "[" expression "]" | "." word }, not evaluated. */
Node *parser_target(Parser *parser);
/* An expression at the place of an argument of a word: does the next token begin one? `after_comma`: then names count whatever they are. */
bool parser_begins_expression(Parser *parser, bool after_comma);
/* `clock` where an animation says which clocks it has; elsewhere it is a number. */
bool parser_is_film_clock(const Parser *p, const Token *t);
bool parser_begins_color(Parser *parser);
/* red, green, blue, filter, transmit, alpha with a value after it. */
bool parser_begins_component(Parser *parser);
/* The components that follow a colour's value. */
Node *parser_color_from(Parser *parser, Node *base);

/* Whether a block of this keyword never holds one of the other (nesting.c). */
bool nesting_never(int outer, int inner);

/* The vocabulary of vts's own blocks, which is reserved only where it means something (context.c). */
bool context_is_block(Name word);
bool context_is_item(Name block, Name word);

#endif
