/* Grids of densities, read by whoever links the folder that can. */
#include "eval/build_pattern.h"
#include "eval/eval_state.h"

const DensityGrid *density_grid_load(const BuildContext *context, const char *name, Span span, const EvalDensityRequest *request) {
    const char *path = name ? data_file_find(context, "density file", name, span) : NULL;
    Eval *ev = context->eval;
    const EvalGeometry *geometry = ev ? ev->options->geometry : NULL;
    EvalDensityRequest stoppable = *request;
    StrBuf error = {0};
    if (name && !path) return NULL;
    stoppable.interrupted = ev ? ev->options->interrupted : NULL;
    DensityGrid *grid = arena_new(context->arena, DensityGrid);
    if (geometry && geometry->density_grid && geometry->density_grid(geometry->context, context->arena, path, &stoppable, grid, &error)) return grid;
    if (stoppable.interrupted && *stoppable.interrupted) {
        strbuf_free(&error);
        ev->interrupted = ev->stopped = true;
        return NULL;
    }
    diag_error(context->diags, span, "the %s '%s' is refused: %s", "density file", name ? name : "fractal",
               error.size ? error.data : "such files are not read here");
    strbuf_free(&error);
    return NULL;
}

const DensityGrid *density_load(const BuildContext *context, const char *name, Span span) {
    return density_grid_load(context, name, span, &(EvalDensityRequest){0});
}
