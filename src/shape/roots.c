#include "shape/roots.h"

#include <string.h>

/* Between two neighbouring zeros of the derivative a polynomial is monotonic: one zero there, or none. The zeros of the
 * derivative come from those of its own, and so on down to a line. Nothing is deflated, so no zero spoils another. */

double roots_value(const double *c, int degree, double x) {
    double value = c[degree];
    for (int i = degree - 1; i >= 0; i--) value = value * x + c[i];
    return value;
}

/* The zero between a and b, where the signs differ: Newton's steps while they stay between and shrink, halving else. A step of no more
 * than rounding is the last: after it they only jump about. */
static double zero_between(const double *c, int degree, double a, double b) {
    bool rising = roots_value(c, degree, a) < 0;
    double x = a + (b - a) / 2, last = b - a;
    for (int i = 0; i < 120; i++) {
        double value = c[degree], slope = 0;
        for (int k = degree - 1; k >= 0; k--) slope = slope * x + value, value = value * x + c[k];
        if (value == 0) return x;
        if ((value < 0) == rising)
            a = x;
        else
            b = x;
        double next = x - value / slope;
        if (fabs(next - x) <= 3e-16 * fabs(x)) return double_clamp(next, a, b);
        bool slow = !(fabs(next - x) < fabs(last) / 2);
        if (slow || !(next > a && next < b)) next = a + (b - a) / 2;
        last = next - x;
        x = next;
        if (x <= a || x >= b || fabs(last) <= 1e-16 * fabs(x)) break;
    }
    return x;
}

/* Zeros of `c` in [lo, hi], where `stations` are those of its derivative. */
static int zeros_among(const double *c, int degree, double lo, double hi, const double *stations, int station_count, double *out) {
    int count = 0;
    double a = lo, at_a = roots_value(c, degree, lo);
    if (at_a == 0) out[count++] = lo;
    for (int i = 0; i <= station_count; i++) {
        double b = i < station_count ? stations[i] : hi, at_b = roots_value(c, degree, b);
        if (b > a && at_b == 0)
            out[count++] = b;
        else if ((at_a < 0 && at_b > 0) || (at_a > 0 && at_b < 0))
            out[count++] = zero_between(c, degree, a, b);
        a = b;
        at_a = at_b;
        if (count == degree) break;
    }
    return count;
}

/* ---- how many there may be ---- */

enum { MANY = 2, HIGHEST_COUNTED = 12 };
/* Coefficients below this share of the largest may have either sign. */
static const double DOUBTFUL = 1e-13;

/* The coefficients of p(lo + (hi − lo)·x). */
static void move_to_unit(const double *c, int degree, double lo, double hi, double *out) {
    double scale = 1;
    memcpy(out, c, sizeof *c * (size_t)(degree + 1));
    for (int k = 0; k < degree && lo != 0; k++)
        for (int i = degree - 1; i >= k; i--) out[i] += lo * out[i + 1];
    for (int i = 1; i <= degree && hi - lo != 1; i++) out[i] *= scale *= hi - lo;
}

/* No fewer zeros than there are in [lo, hi], by Descartes' rule for Bernstein's coefficients: 0, 1 (then there is one), or MANY. */
static int count_zeros(const double *c, int degree, double lo, double hi) {
    double b[HIGHEST_COUNTED + 1], largest = 0;
    if (degree > HIGHEST_COUNTED) return MANY;
    move_to_unit(c, degree, lo, hi, b);
    /* From the powers to Bernstein's basis: b_i = Σ_j C(i, j)/C(n, j) a_j, by differences. */
    double binomial = 1;
    for (int j = 0; j <= degree; j++) {
        b[j] /= binomial;
        binomial = binomial * (degree - j) / (j + 1);
    }
    for (int k = 1; k <= degree; k++)
        for (int i = degree; i >= k; i--) b[i] += b[i - 1];
    for (int i = 0; i <= degree; i++) largest = fmax(largest, fabs(b[i]));
    int changes = 0;
    for (int i = 0; i <= degree; i++) {
        if (!(fabs(b[i]) > DOUBTFUL * largest)) return MANY;
        changes += i > 0 && (b[i] > 0) != (b[i - 1] > 0);
    }
    return int_min(changes, MANY);
}

/* ---- finding them ---- */

int roots_in(const double *c, int degree, double lo, double hi, double *out) {
    double slopes[ROOTS_HIGHEST_DEGREE + 1][ROOTS_HIGHEST_DEGREE + 1], stations[ROOTS_HIGHEST_DEGREE + 1];
    while (degree > 0 && c[degree] == 0) degree--;
    for (int i = 0; i <= degree; i++)
        if (!isfinite(c[i])) return 0;
    if (degree < 1 || degree > ROOTS_HIGHEST_DEGREE || !(lo <= hi)) return 0;
    memcpy(slopes[0], c, sizeof *c * (size_t)(degree + 1));
    for (int k = 1; k <= degree; k++)
        for (int i = 0; i <= degree - k; i++) slopes[k][i] = slopes[k - 1][i + 1] * (i + 1);
    int count = 0, from = degree - 1;
    /* Down to a derivative whose zeros are known without those of its own. */
    for (int k = 0; k < degree; k++) {
        int most = count_zeros(slopes[k], degree - k, lo, hi);
        if (most == MANY) continue;
        if (most == 1) out[count++] = zero_between(slopes[k], degree - k, lo, hi);
        from = k - 1;
        break;
    }
    for (int k = from; k >= 0; k--) {
        memcpy(stations, out, sizeof *out * (size_t)count);
        count = zeros_among(slopes[k], degree - k, lo, hi, stations, count, out);
    }
    return count;
}

/* Beyond [-1, 1] the reciprocals of the zeros are those of the polynomial read backwards. */
int roots_real(const double *c, int degree, double *out) {
    double backwards[ROOTS_HIGHEST_DEGREE + 1], far[ROOTS_HIGHEST_DEGREE];
    while (degree > 0 && c[degree] == 0) degree--;
    if (degree < 1 || degree > ROOTS_HIGHEST_DEGREE) return 0;
    for (int i = 0; i <= degree; i++) backwards[i] = c[degree - i];
    int count = 0, low = roots_in(backwards, degree, -1, 0, far);
    for (int i = low - 1; i >= 0; i--)
        if (far[i] > -1 && far[i] < 0) out[count++] = 1 / far[i];
    count += roots_in(c, degree, -1, 1, out + count);
    int high = roots_in(backwards, degree, 0, 1, far);
    for (int i = high - 1; i >= 0; i--)
        if (far[i] > 0 && far[i] < 1 && count < degree) out[count++] = 1 / far[i];
    return count;
}

/* Secants, the end that stays counting half from its second time on (the Illinois method); halving where that is slow. */
double roots_between(double (*f)(const void *context, double x), const void *context, double a, double at_a,
                     double b, double at_b, double close) {
    double first = fabs(b - a);
    for (int i = 0, stays = 0; i < 200 && fabs(b - a) > close; i++) {
        double x = a + (b - a) * (at_a / (at_a - at_b));
        bool slow = i % 3 == 2 && fabs(b - a) > first / 4;
        if (slow || !(x > fmin(a, b) && x < fmax(a, b))) x = a + (b - a) / 2;
        if (i % 3 == 2) first = fabs(b - a);
        if (x == a || x == b) break;
        double value = f(context, x);
        if (value == 0) return x;
        if ((value > 0) == (at_a > 0)) {
            a = x, at_a = value;
            if (stays == 1) at_b /= 2;
            stays = 1;
        } else {
            b = x, at_b = value;
            if (stays == -1) at_a /= 2;
            stays = -1;
        }
    }
    return fabs(at_a) < fabs(at_b) ? a : b;
}

void roots_multiply(const double *a, int a_degree, const double *b, int b_degree, double *out) {
    for (int i = 0; i <= a_degree + b_degree; i++) out[i] = 0;
    for (int i = 0; i <= a_degree; i++)
        for (int k = 0; k <= b_degree; k++) out[i + k] += a[i] * b[k];
}
