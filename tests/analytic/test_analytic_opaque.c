/* Matter so dense that no light comes through, against Chandrasekhar's law of what a semi-infinite medium sends back. */
#include "analytic.h"

enum { HEIGHTS = 64 };

/* Chandrasekhar's H for albedo 1 at cosine mu, from its values in the middles of equal steps: 1/H = 1/2 int mu' H(mu')/(mu + mu') dmu' (Radiative Transfer, 1950, ch. V). */
static double h_of(const double h[HEIGHTS], double mu) {
    double sum = 0;
    for (int i = 0; i < HEIGHTS; i++) {
        double other = (i + 0.5) / HEIGHTS;
        sum += other * h[i] / (mu + other) / HEIGHTS;
    }
    return 2 / sum;
}

static void solve_h(double h[HEIGHTS]) {
    double next[HEIGHTS];
    for (int i = 0; i < HEIGHTS; i++) h[i] = 1 + 1.9 * (i + 0.5) / HEIGHTS;
    for (int round = 0; round < 2000; round++) {
        for (int i = 0; i < HEIGHTS; i++) next[i] = (h[i] + h_of(h, (i + 0.5) / HEIGHTS)) / 2;
        memcpy(h, next, sizeof next);
    }
}

/* The mean over 2 by 2 of a ball of radius 1, all of whose light comes back near where it went in: mu0 H(mu) H(mu0)/(4 (mu + mu0)) of a lamp's colour, seen from `turn` beside the lamp. */
static double opaque_ball(const double h[HEIGHTS], double turn) {
    enum { ACROSS = 80 };
    double sum = 0;
    for (int y = 0; y < ACROSS; y++)
        for (int x = 0; x < ACROSS; x++) {
            double px = (x + 0.5) / ACROSS * 2 - 1, py = (y + 0.5) / ACROSS * 2 - 1, rest = 1 - px * px - py * py, mu = sqrt(fmax(rest, 0)), lit = mu * cos(turn) + px * sin(turn);
            if (rest > 0 && lit > 0) sum += lit * h_of(h, mu) * h_of(h, lit) / (4 * (mu + lit)) / ACROSS / ACROSS;
        }
    return sum;
}

/* A ball so dense that bins see nothing of the layer that light comes out of: they had made it 86 % too dark, and 178 % too bright at a thousandth of that density. By paths, which end after 200 000 turns, as well. */
static void opaque_balls_are_white(void **state) {
    double h[HEIGHTS];
    const Bench *b = *state;
    solve_h(h);
    for (int i = 0; i < 2; i++) {
        char scene[1024];
        const double turn = i * VTS_PI / 4, right = opaque_ball(h, turn);
        VtsOptions o = options_of_size(10, 10);
        o.reference_samples = 40;
        snprintf(scene, sizeof scene, "global_settings { assumed_gamma 1 samples 16 }\ncamera { orthographic location <%.9f, 0, %.9f> look_at 0 right 2*x up 2*y }\n"
                 "light_source { -1000*z, rgb 1 parallel point_at 0 }\nvolume { sphere { 0, 1 } scattering 1e6 }\n", 50 * sin(turn), -50 * cos(turn));
        double drawn = bench_mean(b, &o, scene, false), exact = bench_mean(b, &o, scene, true);
        printf("opaque ball: %.4f, by paths %.4f (%.4f)\n", drawn, exact, right);
        if (!(fabs(drawn / right - 1) < 0.03 && fabs(exact / right - 1) < 0.03)) fail_msg("opaque ball");
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(opaque_balls_are_white)};
    return cmocka_run_group_tests(tests, bench_set_up, bench_tear_down);
}
