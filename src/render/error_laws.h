/* The error to be expected of a pixel, by its own samples and by what those of other pixels of the tile have told. Errors are squared. */
#ifndef VTS_RENDER_ERROR_LAWS_H
#define VTS_RENDER_ERROR_LAWS_H

#include "render/cell.h"
#include "render/contrast.h"
#include "render/learned.h"

/* Contrasts are learned by their classes; and apart from others those of a pattern in even light, which is averaged over the pixel
 * already: their classes are so many up. */
enum { ERROR_OF_PATTERNS = CONTRAST_CLASSES, ERROR_CLASSES = 2 * CONTRAST_CLASSES };
/* Quiet pixels are those that seem to need nothing: of middles alone, and by learned_level() of their samples, one up. */
enum { QUIET_CLASSES = LEARNED_LEVELS + 1 };

typedef struct ErrorLaws {
    double accepted; /* of a pixel, on the mean */
    Learned contrasts[ERROR_CLASSES], levels[LEARNED_LEVELS], quiet[QUIET_CLASSES], edges[2]; /* of middles, of samples */
    double ratios[ERROR_CLASSES], missed[QUIET_CLASSES], edge_ratios[2]; /* what these have told by now */
} ErrorLaws;

void error_laws_begin(ErrorLaws *laws, double accepted);

/* Whether a contrast is so large that what it comes from makes a difference. */
bool error_counts(const ErrorLaws *laws, float contrast);
/* Whether a pixel that has more than its middle seems to need nothing. */
bool error_net_is_quiet(const ErrorLaws *laws, const Cell *cell);
int error_quiet_class(const Cell *cell);
/* As the pixel by itself seems; where samples agree they may all have missed something. 0 of what cannot be refined. */
double error_expected(const ErrorLaws *laws, const Cell *cell);

/* `before`: the cell before its last samples. */
void error_learn(ErrorLaws *laws, const Cell *before, const Cell *cell);
/* The error of a picture all whose pixels have as many samples, by the sum of their expected ones. */
double error_of_all(double sum);
/* What was expected of a tile that had too few samples. */
double error_of_stopped(double sum);

#endif
