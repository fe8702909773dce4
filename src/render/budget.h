/* The error that a picture may have, shared out among what makes it: each stage's error falls with the time that it takes, and errors of stages add up
 * by their squares. The least time together is where one more second takes as much from the sum of squares wherever it is spent (Lagrange). */
#ifndef VTS_RENDER_BUDGET_H
#define VTS_RENDER_BUDGET_H

#include <stdbool.h>

/* At a slack s, the error is error·s^rise and the time seconds·s^-fall. */
typedef struct BudgetLaw {
    double error, rise;   /* at slack 1; 0: the stage makes none, whatever its slack */
    double seconds, fall; /* 0: slack saves nothing */
    double least, most;   /* of the slack */
} BudgetLaw;

/* The slacks in `slack` that take the least time with a squared error of accepted² together; all at their least where that is out of reach. */
void budget_split(const BudgetLaw *laws, int count, double accepted, double *slack);
/* Of one stage with that slack. */
double budget_error(const BudgetLaw *law, double slack);
double budget_seconds(const BudgetLaw *law, double slack);
/* A law through what slacks 1 and `other` were found to make of errors and times; either that does not change is taken as it is. */
BudgetLaw budget_law(const double errors[2], const double seconds[2], double other);

/* Noise gets no less than this part of the accepted error. */
#define BUDGET_LEAST_NOISE 0.5

/* What makes a picture's error, and is told how much of it. */
typedef enum BudgetStage { BUDGET_NOISE, BUDGET_SKY, BUDGET_MEDIA, BUDGET_STAGES } BudgetStage;

/* How it was shared out. A slack of 1 is what the stage does by itself; that of noise is the part of the accepted error it gets. */
typedef struct Budget {
    double slack[BUDGET_STAGES];
    BudgetLaw laws[BUDGET_STAGES]; /* of a pixel, */
    bool known[BUDGET_STAGES];     /* where trials were made */
} Budget;

/* Nothing is known: slacks of 1. */
void budget_begin(Budget *budget);
/* The part of the accepted error that the other stages leave to noise. */
double budget_left(const Budget *budget, double accepted);

#endif
