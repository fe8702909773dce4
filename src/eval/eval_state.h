/* The evaluator's own state: names and scopes, sinks, the stack of calls. Only eval_*.c include this. */
#ifndef VTS_EVAL_EVAL_STATE_H
#define VTS_EVAL_EVAL_STATE_H

#include "eval/block.h"
#include "eval/eval.h"
#include "parser/parser.h"

#include <math.h>

typedef struct Eval Eval;

/* ---- names ---- */

/* A place that holds a value and owns the memory of its vector or text, which is reused from one assignment to the next. */
typedef struct Slot {
    Value value;
    void *buffer;
    uint32_t capacity; /* bytes */
    bool set;
} Slot;

/* Scope is dynamic: the visible meaning of a name is on top of that name's own stack of bindings, so that looking it up is one load. */
typedef struct VarBinding VarBinding;
struct VarBinding {
    Slot *slot; /* &own, or the caller's for a parameter that went by reference */
    Slot own;
    VarBinding *outer;      /* what the name meant outside */
    VarBinding *scope_next; /* next binding of the same scope; also links the free ones */
    uint32_t name_id;
    uint32_t scope; /* number of the scope that it belongs to; 0: global */
};

typedef struct Scope {
    VarBinding *bindings;
    struct Scope *outer;
    uint32_t number;
} Scope;

/* ---- macros and calls ---- */

struct Macro {
    Name name;
    Span name_span; /* in its definition */
    const Name *parameters;
    size_t parameter_count, required;
    Body body;
    bool half;  /* opens brackets that it does not close, or closes others */
    bool whole; /* brackets balance and no operator dangles */
    /* Whether a call stands for one expression and how tightly it binds; found on first need, and again when `stamp` is old. */
    Binding binding;
    uint32_t stamp;
    bool is_block; /* its value is a block: an item of its own, never an argument of a word before it */
    bool measuring;
    Span
        last_call; /* for notes of errors that show only after the call, when its text is part of a larger expression */
    struct Macro *next; /* of all that were defined */
};

typedef struct CallRecord CallRecord;
struct CallRecord {
    CallRecord *outer;
    Name macro; /* NULL: an include */
    Span span;  /* of the call */
};

/* ---- where the values of a body go ---- */

typedef enum SinkKind {
    SINK_NONE,   /* nothing is expected: a body of directives */
    SINK_SCENE,  /* top level of the file */
    SINK_ITEMS,  /* a block's items */
    SINK_SINGLE, /* one value */
    SINK_ARRAY,  /* the elements of an array, in order */
} SinkKind;

typedef struct ItemList {
    BlockItem *items;
    size_t count, capacity;
} ItemList;

typedef struct Sink {
    SinkKind kind;
    Name block;         /* SINK_ITEMS */
    ItemList *items;    /* SINK_ITEMS */
    bool gathers;       /* SINK_ITEMS: a block of objects, of which there may be very many */
    bool lists;         /* SINK_ITEMS: a list of a mesh, with nothing but numbers so far */
    ListedNumbers numbers; /* SINK_ITEMS: these */
    uint64_t word_body; /* SINK_ITEMS: the run of a body that brought the last word */
    Value value;        /* SINK_SINGLE */
    bool filled;
    Array *array; /* SINK_ARRAY */
    size_t next;  /* element */
    bool layers;  /* SINK_ARRAY: a texture without a comma before it is a layer of the last element */
} Sink;

/* FLOW_TEXT: nothing was run, the statement is half of something and must be read together with what follows it. */
typedef enum Flow { FLOW_NEXT, FLOW_BREAK, FLOW_STOP, FLOW_TEXT } Flow;

/* ---- arrays, splines, files ---- */

struct Array {
    Slot *items;
    size_t count, capacity;
    bool growing; /* written without a size: array { … } */
    bool rows;    /* its elements are arrays themselves: more than one dimension */
    ValueKind
        *class; /* what all elements are, VALUE_ERROR as long as there are none; rows share it; NULL: mixed */
    Name *keys;   /* of a dictionary: one for each element */
    size_t key_capacity;
};

enum { SPLINE_LINEAR, SPLINE_QUADRATIC, SPLINE_CUBIC, SPLINE_NATURAL };
typedef struct SplinePoint {
    double at;
    double value[5];
    double second[5]; /* second derivatives of the natural spline */
} SplinePoint;
struct Spline {
    int type, size;
    SplinePoint *points;
    size_t count;
};

/* ---- programs ---- */

/* A statement as it was parsed when it was first reached. */
typedef struct Statement {
    Node *node; /* NULL: it needs the slow road */
    uint32_t next;
    uint32_t end; /* of the body that it was read in */
    Name block;
    const Assumption *assumptions;
    uint32_t assumption_count;
    uint32_t stamp;      /* Eval.macro_stamp when it was checked */
    uint64_t name_stamp; /* Eval.name_stamp when all assumptions were last seen to hold */
} Statement;

typedef struct Program {
    TokenList *tokens;
    Statement **memo;  /* by token; NULL: none yet */
    Statement **heads; /* of directives on the slow road, by token; NULL: none yet */
    struct Program *next;
} Program;

struct Eval {
    const EvalOptions *options;
    SourceSet *sources;
    DiagList *diags;
    Interner *names;
    KeywordTable keywords;
    Arena *parse;  /* trees, memos, variables */
    Arena passing; /* trees of statements that run once */
    Arena temp;   /* values of the statement that is running */
    Arena blocks; /* items of blocks that are being read */
    BuildContext build;
    SceneDraft *draft;
    const char *scene_path, *scene_folder;

    VarBinding **bindings; /* by name id */
    uint32_t binding_count;
    VarBinding *free_bindings;
    Scope *scope;
    uint32_t macro_stamp; /* counts definitions of macros */
    uint64_t
        name_stamp; /* counts changes of what a name means to the parser (its NameClass, or which macro it is) */
    CallRecord *calls;
    Macro *macros;
    bool half_macros; /* there was one */
    uint32_t call_depth, include_depth;
    uint64_t body, body_count; /* the run of a body that is going on, and how many there were */
    bool repeats;              /* what runs now may run again: within a loop or a macro */
    int nesting;               /* C stack: bodies and expressions within each other */
    uintptr_t stack;           /* where it was when the evaluation began */

    Program **programs; /* by file id */
    uint32_t program_count;
    ParserHost fast_host;

    uint32_t *streams; /* states of seed()'s streams */
    size_t stream_count, stream_capacity;
    UserFile *files;
    struct MemoryFile *memory;
    uint64_t steps;    /* passes of loops and calls of macros so far */
    uint64_t elements; /* of arrays, made so far */
    uint64_t written;  /* bytes of #write so far */
    Span at;           /* the statement that is running: for what has no place of its own */
    double version;
    double phase; /* of the texel's phases that are being read */
    bool has_phase;
    size_t silent_errors; /* erroneous values that were left out of blocks */
    bool stopped, interrupted;
    bool after_declare; /* the last statement was one */
    Span last_break,
        break_end; /* blamed if no loop is found around it; the #end of the branches that it left */
    void (*outer_exhausted)(void *context); /* the memory budget's own handler */
    void *outer_context;
    Name block_word; /* of the innermost block that is being read, or NULL */
    Name index_name, count_name, particles_name;
};

/* ---- eval_value.c ---- */
/* Reports an error and gives the value that says so. */
Value eval_fail(Eval *ev, Span span, const char *format, ...) VTS_PRINTF(3, 4);
static inline Value value_error(void) { return (Value){.kind = VALUE_ERROR}; }
static inline Value value_float(double number) {
    return (Value){.kind = VALUE_FLOAT, .size = 1, .as.number = number};
}
Value value_vector(Eval *ev, const double *components, int size);
Value value_string(Eval *ev, const char *text, size_t length);
bool value_is_numeric(const Value *v);
/* Component i; a float has it everywhere, a shorter vector 0. */
double value_component(const Value *v, int i);
/* POV-Ray's tolerance: nearer than this to 0 is false, nearer than this to each other is equal. */
#define VALUE_TOLERANCE 1e-10
static inline bool value_is_true(double number) { return fabs(number) > VALUE_TOLERANCE; }
static inline bool value_are_equal(double a, double b) { return !value_is_true(a - b); }
/* Whole numbers are C's int, and what lies outside of it is its least one, as in POV-Ray on common machines. */
static inline double value_to_int(double a) {
    return a > -2147483649.0 && a < 2147483648.0 ? trunc(a) + 0.0 : -2147483648.0;
}
Value value_unary(Eval *ev, int op, Value a, Span span);
/* For a node of two operands, which are blamed for themselves. */
Value value_binary(Eval *ev, int op, Value a, Value b, const Node *node);
double value_float_binary(Eval *ev, int op, double a, double b, Span span);
/* As a float, reporting anything else; false after an error. */
bool value_to_float(Eval *ev, const Value *v, Span span, double *out);
/* Vectors of `size` components; floats are spread, more or fewer components cut or filled with 0. */
bool value_to_vector(Eval *ev, const Value *v, Span span, double *out, int size);
bool value_to_string(Eval *ev, const Value *v, Span span, const char **text, size_t *length);
/* Puts a value into a slot, copying vectors, strings and arrays. */
void slot_set(Eval *ev, Slot *slot, const Value *value);
static inline void slot_set_float(Eval *ev, Slot *slot, double number) {
    Value v = value_float(number);
    if (slot->value.kind == VALUE_FLOAT)
        slot->value.as.number = number;
    else
        slot_set(ev, slot, &v);
}
void slot_clear(Eval *ev, Slot *slot);
/* A copy that the evaluation of the statement may keep, whatever happens to the slot. */
Value slot_get(Eval *ev, const Slot *slot);

/* ---- eval_scope.c ---- */
static inline VarBinding *scope_find(const Eval *ev, Name name) {
    return name->id < ev->binding_count ? ev->bindings[name->id] : NULL;
}
void scope_enter(Eval *ev, Scope *scope);
void scope_leave(Eval *ev, Scope *scope);
/* Functions and macros stay what they are until #undef, and nothing else becomes a function: false after a report. */
bool scope_may_declare(Eval *ev, Name name, ValueKind kind, Span span);
/* The slot that #declare (local: #local) of a name assigns, made if need be. */
Slot *scope_declare(Eval *ev, Name name, bool local);
/* A parameter of the innermost scope: bound to the caller's slot, or (NULL) to one of its own with this value (NULL: none yet). */
Slot *scope_bind(Eval *ev, Name name, Slot *reference, const Value *value);
void scope_undef(Eval *ev, Name name);
NameClass scope_classify(const Eval *ev, Name name, const Macro **macro);
/* What a name that holds this slot means to the parser. */
NameClass slot_class(const Slot *slot);

/* ---- eval_compute.c ---- */
typedef struct ComputeStep {
    uint8_t op;
    uint8_t from;     /* where the operand is */
    uint32_t name_id; /* of an operand that is a name */
    double number;
} ComputeStep;
typedef struct Compute {
    uint32_t count; /* 0: no code */
    bool pending;   /* no code yet */
    bool pair;      /* a name and a number: the commonest expression of loops */
    ComputeStep steps[];
} Compute;
/* Makes the code of a binary expression when it is met for the second time. */
void compute_prepare(Eval *ev, const Node *node);
/* False where the code is not made for the values that it meets: nothing has happened then. */
bool compute_run(const Eval *ev, const Compute *compute, double *out);
bool compute_run_pair(const Eval *ev, const Compute *compute, double *out);
static inline bool compute_try(Eval *ev, const Node *node, double *out) {
    const Compute *compute = node->as.operand.compute;
    if (compute && compute->count) return compute->pair ? compute_run_pair(ev, compute, out) : compute_run(ev, compute, out);
    if (!compute || compute->pending) compute_prepare(ev, node);
    return false;
}

/* ---- eval_node.c, eval_expression.c ---- */
Value eval_node(Eval *ev, const Node *node);
Value eval_compound(Eval *ev, const Node *node);
/* What an expression gives: true and a float in *number, or false and anything else in *other. Floats so travel in a register and
 * a word of the caller's, which is much cheaper than a whole Value at each of an expression's nodes. */
bool eval_operand(Eval *ev, const Node *node, double *number, Value *other);
bool eval_float(Eval *ev, const Node *node, double *out);
bool eval_condition(Eval *ev, const Node *node, bool *out);
bool eval_string(Eval *ev, const Node *node, const char **text, size_t *length);
/* The slot that a target names, or NULL: not declared (no report), or an error (reported: *failed). */
Slot *eval_target(Eval *ev, const Node *target, bool *failed);
/* The same for an element of an array, and the array that holds it. */
Slot *eval_element(Eval *ev, const Node *target, Array **array, bool *failed);
Value eval_color(Eval *ev, const Node *node);
void eval_undeclared(Eval *ev, Name name, Span span);

/* ---- eval_builtin.c, eval_builtin_string.c ---- */
Value eval_builtin(Eval *ev, const Node *node);
Value eval_builtin_string(Eval *ev, const Node *node);
Value eval_constant(Eval *ev, const Node *node);
/* min_extent, max_extent (eval_extent.c). */
Value eval_extent(Eval *ev, const Node *node);
/* trace, inside: by way of EvalOptions.geometry. */
Value eval_geometry(Eval *ev, const Node *node);
bool builtin_argument_count(Eval *ev, const Node *node, size_t least, size_t most);
/* Whether the number of arguments is right. Otherwise false, after a report at `span` (*reported, if not NULL: what was added, NULL if
 * it was dropped). `what` is what is called: "'sin'". */
bool eval_argument_count(Eval *ev, Span span, const char *what, size_t least, size_t most, size_t given,
                         Diagnostic **reported);

/* ---- eval_array.c ---- */
Value eval_array(Eval *ev, const Node *node);
/* Whether the value is of the kind of the elements that the array has; false after a report. */
bool array_accepts(Eval *ev, Array *array, const Value *v, Span span);
/* Whether `v`, the element of `array` that an index gave, lacks further indices; reported. */
bool array_is_partial(Eval *ev, const Array *array, const Value *v, Span span);
/* NULL when the limit of elements is reached (reported; the program stops). */
Array *array_copy(Eval *ev, const Array *from);
/* Counts elements that are about to be made; false when the limit is reached (reported; the program stops). */
bool array_take(Eval *ev, uint64_t count, Span span);
Slot *array_slot(Eval *ev, const Array *array, double index, Span span);
/* One more element, not set. */
void array_grow(Eval *ev, Array *array);
Value eval_dictionary(Eval *ev, const Node *node);
/* The entry of a dictionary; NULL when there is none. */
Slot *dictionary_find(const Array *dictionary, Name key);
/* The same, made (but not set) if need be; NULL after a report: too many elements. */
Slot *dictionary_entry(Eval *ev, Array *dictionary, Name key);
/* The key that an index in [ ] names; NULL after a report. */
Name dictionary_key(Eval *ev, const Node *index);

/* ---- eval_run.c ---- */
Flow run_body(Eval *ev, const Body *body, Sink *sink);
Flow run_node(Eval *ev, const Node *node, Sink *sink);
Flow run_statement(Eval *ev, Program *program, uint32_t *at, uint32_t end, Sink *sink);
/* The statement at a token, from the memo or parsed now; NULL node: slow road. */
bool statement_holds(Eval *ev, Statement *s);
const Statement *statement_at(Eval *ev, Program *program, uint32_t at, uint32_t end, Name block);
Program *eval_program_new(Eval *ev, TokenList *tokens);
static inline Program *eval_program(Eval *ev, TokenList *tokens) {
    uint32_t id = tokens->file->id;
    Program *known = id < ev->program_count ? ev->programs[id] : NULL;
    return known ? known : eval_program_new(ev, tokens);
}
/* Whether there is room for another level of nesting; otherwise reported, and the program stops. */
bool eval_has_stack(Eval *ev, Span span);
/* The same, and the level is entered: `nesting` is to be counted down at its end. */
bool eval_deeper(Eval *ev, Span span);
void run_assign(Eval *ev, const Node *node);
void run_define_macro(Eval *ev, const Node *node);
Flow run_include(Eval *ev, const Node *node, Sink *sink);
/* Reads a text file; anything but SOURCE_OK is reported at `span`. */
SourceStatus eval_load_text(Eval *ev, const char *path, Span span, const SourceFile **out);
/* Loads and lexes what an #include names; NULL after a report. */
TokenList *eval_load_include(Eval *ev, const Node *node, Span *path_span);
/* At the end of `last`, a branch or pass of `group`: FLOW_STOP after a report if the group has no #end, or if (reached: the text up to
 * there was read, not skipped) another directive stands where #end should. */
Flow run_group_end(Eval *ev, const Node *group, const Body *last, bool reached);
/* A #break leaves this branch: without a loop around it, POV-Ray blames the branch's #end. */
void run_break_leaves(Eval *ev, const Body *branch);
/* Whether #else or #elseif may follow the branch. */
bool run_branch_goes_on(const Branch *b);
bool run_case_matches(Eval *ev, const SwitchCase *c, double subject);
/* Whether `more` bytes can be taken; otherwise reported, and the program stops. */
bool eval_has_memory(Eval *ev, size_t more, Span span);
/* Before each pass of a loop and each call of a macro: false when the limit of steps or of memory is reached (reported) or the session is
 * interrupted. The program then stops. */
bool eval_step(Eval *ev, Span span);
Flow run_loop_guard(Eval *ev, uint64_t *passes, size_t errors, Span span);

/* ---- eval_literal.c ---- */
static inline bool literal_begins(const Token *t) {
    return t->kind == TOKEN_NUMBER || t->kind == '<' || t->kind == '-' || t->kind == '+';
}
/* Gives the sink the numbers and vectors that stand at token `at` of the body, each with a comma or the body's end behind it. Returns the
 * token to go on with. */
uint32_t run_literals(Eval *ev, const Body *body, uint32_t at, Sink *sink);

/* ---- eval_sink.c ---- */
void sink_value(Eval *ev, Sink *sink, Value value, Span span);
/* The same of all of a list: it may become the sink's own. */
void sink_numbers(Eval *ev, Sink *sink, const ListedNumbers *numbers);
void sink_word(Eval *ev, Sink *sink, const Node *node);
void sink_entry(Eval *ev, Sink *sink, const Node *node);
void sink_list(Eval *ev, Sink *sink, const Node *node);

/* ---- eval_block.c ---- */
Value eval_block(Eval *ev, const Node *node, Name declared_as);
const EvalBlock *eval_block_items(Eval *ev, Name word, Span word_span, Span span, const Body *body);

/* ---- eval_macro.c ---- */
Value eval_call(Eval *ev, const Node *node);
/* A call as an item: its body's items go to the sink. */
Flow run_call(Eval *ev, const Node *node, Sink *sink);
/* Binds the arguments of a call in a new scope. False after a report: nothing is then entered. */
bool macro_enter(Eval *ev, const Macro *macro, const NodeList *arguments, Span span, Scope *scope,
                 CallRecord *record);
void macro_leave(Eval *ev, Scope *scope);
Binding macro_binding(Eval *ev, const Macro *macro);
/* Whether these tokens call a macro that is half of something: brackets then close elsewhere than they seem to. */
bool macro_half_called(const Eval *ev, const TokenList *tokens, uint32_t begin, uint32_t end);

/* ---- eval_expand.c: the slow road ---- */
/* Reads and runs the statement at *at of `program` with directives and macros expanded, and moves *at past it. */
Flow run_slow(Eval *ev, Program *program, uint32_t *at, uint32_t end, Sink *sink);
/* The same for an #include that is text like any other: half of a statement, whose other half follows it. */
Flow run_include_as_text(Eval *ev, Program *program, uint32_t *at, uint32_t end, Sink *sink);

/* ---- eval_function.c, eval_spline.c, eval_files.c ---- */
Value eval_function(Eval *ev, const Node *node);
Value call_function(Eval *ev, const UserFunction *function, const NodeList *arguments, Span span);
Value call_known_function(Eval *ev, const Node *node, bool *known);
Value eval_spline(Eval *ev, const EvalBlock *block);
Value call_spline(Eval *ev, const Spline *spline, const NodeList *arguments, Span span);
void spline_evaluate(const Spline *spline, int type, double at, double *out);
void run_fopen(Eval *ev, const Node *node);
void run_fclose(Eval *ev, const Node *node);
void run_read(Eval *ev, const Node *node);
void run_write(Eval *ev, const Node *node);
bool file_is_open(const UserFile *file);
void files_close_all(Eval *ev);
bool file_exists_for(Eval *ev, const char *path, Span span);
/* Whether the scene may read this path. */
bool path_may_read(const Eval *ev, const char *path);

#endif
