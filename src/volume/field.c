#include "volume/field.h"

#include "pattern/values.h"
#include "pattern/warp.h"
#include "volume/grid.h"

double field_of_number(const DensityField *field, double number) {
    if (!field->has_threshold) return number > 0 ? number : isnan(number) ? number : 0;
    return isnan(number) ? number : double_clamp((number - field->low) / (field->high - field->low), 0, 1);
}

double field_density(const DensityField *field, Vec3 point) {
    const Pigment *pattern = field->pattern;
    Spot outer = spot_make(point, vec3_splat(0), 0);
    Spot spot = spot_in_pattern(pattern, &outer, pattern_traits(pattern->kind).warps_itself);
    if (pattern->kind == PATTERN_DENSITY) return field_of_number(field, grid_value(pattern->density, 0, spot.p));
    return field_of_number(field, pattern_value(pattern, &spot).value);
}

bool field_is_grid(const DensityField *field, const DensityGrid **grid) {
    const Pigment *p = field->pattern;
    *grid = p->density;
    return p->kind == PATTERN_DENSITY && field->in_bounds && p->warp_count == 0 && vec3_length_squared(p->turbulence) == 0 &&
           transform_is_identity(&p->transform);
}
