/* What the names of a program stand for when it ends. */
#ifndef VTS_EVAL_EVAL_NAMES_H
#define VTS_EVAL_EVAL_NAMES_H

#include "eval/eval_state.h"

/* Fills scene->named_texels, in the scene's arena: global names, and elements of arrays as "Trees[2]". */
void eval_name_texels(const Eval *ev, Scene *scene);

#endif
