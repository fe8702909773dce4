/* What a density { … } says at a place. */
#ifndef VTS_VOLUME_FIELD_H
#define VTS_VOLUME_FIELD_H

#include "volume/lattice.h"
#include "scene/scene.h"

/* At a point of the space that the density stands in: its own grid's unit cube, or that of the block around it. Never negative; NAN
 * where it is no number. */
double field_density(const DensityField *field, Vec3 point);
/* Whether its numbers are those of a grid, cell by cell, which *grid gets. */
bool field_is_grid(const DensityField *field, const DensityGrid **grid);
/* The number of a grid's cell as density. */
double field_of_number(const DensityField *field, double number);

#endif
