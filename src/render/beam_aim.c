#include "render/beam_sight.h"

#include "base/random.h"

/* The camera's lines through the tile: in the axes right, up, direction a point is at (s, t, 1) times its depth. */
void beam_aim(BeamTracer *tr) {
    const View *view = &tr->compiled->view;
    const Camera *c = &view->camera;
    Mat3 axes = {{c->right, c->up, c->direction}};
    double inverse = 1 / mat3_determinant(&axes);
    bool flat = !isfinite(inverse); /* a camera that spans no space: such a beam is empty */
    if (flat) inverse = 0;
    Vec3 to_s = vec3_scale(vec3_cross(axes.c[1], axes.c[2]), inverse), to_t = vec3_scale(vec3_cross(axes.c[2], axes.c[0]), inverse);
    Vec3 to_d = vec3_scale(vec3_cross(axes.c[0], axes.c[1]), inverse);
    double w = view->width, h = view->height, sx = 0.5 * w - tr->x0, sy = 0.5 * h - tr->y0;
    Beam *b = &tr->beam;
    b->perspective = c->kind == CAMERA_PERSPECTIVE;
    b->light = false;
    b->origin = c->location;
    b->shift = b->perspective ? vec3(0, 0, 0) : vec3(sx, sy, 0);
    b->rows[0] = vec3_scale(to_s, w);
    b->rows[1] = vec3_scale(to_t, -h);
    b->rows[2] = b->perspective ? to_d : vec3_negate(to_d);
    if (b->perspective) {
        b->rows[0] = vec3_madd(b->rows[0], to_d, sx);
        b->rows[1] = vec3_madd(b->rows[1], to_d, sy);
    }
    double s = tr->x0 / w - 0.5, t = 0.5 - tr->y0 / h;
    tr->corner = vec3_madd(vec3_madd(b->perspective ? c->direction : c->location, c->right, s), c->up, t);
    tr->right = vec3_scale(c->right, 1 / w);
    tr->down = vec3_scale(c->up, -1 / h);
    b->samples.columns = tr->columns;
    b->samples.rows = tr->rows;
    b->nearest = b->perspective ? tr->compiled->nearest : flat ? -1 : 0;
    b->farthest = b->perspective ? VTS_INFINITY : -VTS_INFINITY;
    beam_close(b);
}

BeamLine beam_line_at(const BeamTracer *tr, double x, double y) {
    Vec3 to = vec3_madd(vec3_madd(tr->corner, tr->right, x), tr->down, y);
    BeamLine line = {tr->beam.origin, to, 0};
    if (!tr->beam.perspective) line = (BeamLine){to, tr->compiled->view.camera.direction, 0};
    line.length = vec3_length(line.direction);
    return line;
}

double beam_line_distance(const BeamTracer *tr, const BeamLine *line, float key) {
    return tr->beam.perspective ? line->length / (double)key : -(double)key * line->length;
}

/* The additive recurrence of the plastic number, shifted for each pixel at random: low discrepancy for any count. */
void beam_lay_samples(BeamTracer *tr) {
    const double step_x = 0.7548776662466927, step_y = 0.5698402909980532;
    BeamSamples *s = &tr->beam.samples;
    uint32_t i = 0;
    for (int row = 0; row < tr->rows; row++)
        for (int column = 0; column < tr->columns; column++) {
            uint64_t bits = random_hash((uint64_t)(tr->x0 + column), (uint64_t)(tr->y0 + row), 0, tr->seed);
            int pixel = row * tr->columns + column, before = tr->allotment.taken[pixel];
            double x = random_unit(bits) + before * step_x, y = random_unit(random_mix(bits)) + before * step_y;
            double f = random_unit(random_mix(bits + 1)) + before * 0.6180339887498949;
            s->first[pixel] = i;
            for (int k = 0; k < tr->allotment.asked[pixel]; k++, i++) {
                x += step_x, y += step_y, f += 0.6180339887498949;
                x -= floor(x), y -= floor(y), f -= floor(f);
                s->x[i] = (float)(column + x);
                s->y[i] = (float)(row + y);
                s->mark[i] = 0;
                tr->fade[i] = (float)(BEAM_LEAST_FADE * (1 + f));
                tr->surface[i] = BEAM_NOTHING;
            }
        }
    s->first[tr->rows * tr->columns] = i;
}

BeamLine beam_sample_line(const BeamTracer *tr, uint32_t i) {
    return beam_line_at(tr, (double)tr->beam.samples.x[i], (double)tr->beam.samples.y[i]);
}

Vec3 beam_sample_point(const BeamTracer *tr, uint32_t i, double *t) {
    const BeamSamples *s = &tr->beam.samples;
    BeamLine line = beam_sample_line(tr, i);
    *t = beam_line_distance(tr, &line, s->key[i]);
    return vec3_madd(line.origin, line.direction, *t / line.length);
}
