/* FLIP: how strongly an observer sees two pictures differ when flipping between them.
 * P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild, "FLIP: A Difference Evaluator for
 * Alternating Images", Proceedings of the ACM in Computer Graphics and Interactive Techniques 3(2), 2020. */
#ifndef VTS_IMAGE_FLIP_H
#define VTS_IMAGE_FLIP_H

#include "image/image.h"

/* Pixels per degree of the visual field that the paper assumes: a screen 0.7 m wide with 3840 pixels seen from 0.7 m. */
#define FLIP_PIXELS_PER_DEGREE 67.0206432766

/* The map of errors in [0, 1], one per pixel, row by row from the top, and in *mean their mean. Both pictures are linear light,
 * clamped to [0, 1] (the evaluator for low dynamic range). The map is malloc()ed, the caller frees it; NULL with a line in
 * `error` when the sizes differ or memory is short. `pixels_per_degree` > 0. */
float *flip_map(const Image *reference, const Image *test, double pixels_per_degree, double *mean, StrBuf *error);

#endif
