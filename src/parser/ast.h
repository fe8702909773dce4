/* The syntax tree. Directives are nodes like any other; bodies (of a block, a loop, a branch, a macro, a file) are ranges of
 * tokens, whose statements are parsed when they are first reached. */
#ifndef VTS_PARSER_AST_H
#define VTS_PARSER_AST_H

#include "lexer/lexer.h"

typedef enum NodeKind {
    NODE_ERROR,
    /* expressions */
    NODE_NUMBER,
    NODE_STRING,
    NODE_VALUE, /* a value found while macros were expanded */
    NODE_NAME,
    NODE_CONSTANT,  /* x, pi, clock …: op is the Keyword */
    NODE_VECTOR,    /* list */
    NODE_INDEX,     /* base [list[0]] */
    NODE_DOT,       /* a . op (DotComponent), b: the word as a NODE_NAME, for dictionaries */
    NODE_UNARY,     /* op: '-' '+' '!' */
    NODE_BINARY,    /* op: character or TokenKind of the operator */
    NODE_CONDITION, /* a ? b : c */
    NODE_CALL,      /* base ( list ): macro, function, spline; decided when it runs */
    NODE_BUILTIN,   /* op: Keyword; list */
    NODE_COLOR,     /* colour expression */
    NODE_ARRAY,     /* array [list]… { body }; op: mixed */
    NODE_DICTIONARY, /* list: key, value, key, value … */
    NODE_FUNCTION,  /* function ( names ) { list } or { block } */
    NODE_BLOCK,     /* word { body }; op: 0 or BLOCK_OF_LAYERS */
    /* what only a body may hold */
    NODE_WORD,    /* word list [{ body }] */
    NODE_ENTRY,   /* [ body ] */
    NODE_LIST,    /* { body } in an array */
    NODE_DECLARE, /* targets = value */
    NODE_UNDEF,
    NODE_IF, /* if, ifdef, ifndef with its elseif and else */
    NODE_WHILE,
    NODE_FOR,
    NODE_SWITCH,
    NODE_BREAK,
    NODE_MACRO,
    NODE_INCLUDE,
    NODE_VERSION,
    NODE_DEFAULT,
    NODE_MESSAGE, /* op: KW_debug, warning, error, render, statistics */
    NODE_FOPEN,
    NODE_FCLOSE,
    NODE_READ,
    NODE_WRITE,
    NODE_EMPTY, /* a stray ; or , */
    NODE_NUMBERS, /* many numbers and vectors: all that stands in a body */
} NodeKind;

/* texture { … } texture { … } where one value is wanted. */
enum { BLOCK_OF_LAYERS = 1 };

typedef enum DotComponent { DOT_X, DOT_Y, DOT_Z, DOT_4, DOT_5, DOT_GRAY, DOT_OTHER } DotComponent;

typedef struct Node Node;

typedef struct NodeList {
    Node **items;
    size_t count, capacity;
} NodeList;

/* Statements to run in order: tokens [begin, end) of `tokens`, or, where the text had to be expanded first, `items`. */
typedef struct Body {
    TokenList *tokens; /* NULL: `items` */
    uint32_t begin, end;
    NodeList items;
} Body;

typedef struct Branch {
    Node *condition; /* NULL: else */
    Body body;
} Branch;

typedef struct SwitchCase {
    Node *low, *high; /* high NULL: #case; both NULL: #else */
    Body body;
} SwitchCase;

typedef struct ColorPart {
    uint16_t
        component; /* KW_red, green, blue, filter, transmit, alpha; KW_rgb … srgbft; KW_color: any expression */
    Node *value;
} ColorPart;

struct Node {
    uint8_t kind;
    /* A call in an expression: how tightly its macro's body must bind for the call to mean what its text would (Binding). */
    uint8_t need;
    uint16_t op;
    Span span;
    union {
        double number;
        const TokenString *string;
        const struct Value *value;
        Name name;
        const ListedNumbers *numbers;
        NodeList list; /* VECTOR, BUILTIN, READ and WRITE (first the handle), UNDEF, FOPEN (handle, path) */
        struct {
            Node *a, *b;
            union {
                Node *c;
                const struct Compute *compute; /* of BINARY: the evaluator's short way, see eval_compute.c */
            };
        } operand; /* UNARY a; BINARY a, b; CONDITION a, b, c; DOT a; INCLUDE, VERSION, MESSAGE a */
        struct {
            Node *base;
            NodeList list;
        } apply; /* INDEX, CALL */
        struct {
            ColorPart *parts;
            size_t count;
        } color;
        struct {
            NodeList dimensions;
            Body *body;
        } array;
        struct {
            Name *parameters;
            Span *spans;
            size_t count;
            Node *columns, *rows; /* function 300, 300 { … }; else NULL */
            NodeList body;
        } function;
        struct {
            Name word;
            Span word_span;
            Body *body;
        } block; /* BLOCK, ENTRY, LIST, DEFAULT */
        struct {
            Name word;
            Span word_span;
            NodeList list;
            Body *body;
        } word;
        struct {
            Node *target, *value;
            Span after;   /* unended: where the semicolon is missing */
            bool unended; /* without semicolon, which is a mistake if the value is a number */
            bool local;
        } declare;
        struct {
            Branch *branches;
            size_t count;
        } branches;
        struct {
            Node *condition;
            Body body;
        } loop; /* WHILE */
        struct {
            Name name;
            Node *from, *to, *step;
            Body body;
        } for_loop;
        struct {
            Node *subject;
            Body prelude; /* what stands before the first case: it always runs */
            SwitchCase *cases;
            size_t count;
        } switch_;
        struct {
            Name name;
            Span name_span;
            Name *parameters;
            size_t count, required; /* the rest may be left out */
            Body body;
            bool unbalanced;
        } macro;
    } as;
};

/* How tightly an expression holds together, loosest first. */
typedef enum Binding { BIND_NONE, BIND_ANY, BIND_SUM, BIND_PRODUCT, BIND_PRIMARY } Binding;

/* The tree as indented text. Bodies are printed as their token ranges. */
void ast_print(const Node *node, StrBuf *out, int indent);

#endif
