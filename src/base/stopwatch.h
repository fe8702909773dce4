/* Wall and processor time, and the largest resident size: the only clocks that the report quotes. */
#ifndef VTS_BASE_STOPWATCH_H
#define VTS_BASE_STOPWATCH_H

#include "base/common.h"

double stopwatch_wall(void); /* seconds on a monotonic clock */
double stopwatch_cpu(void);  /* user + system seconds of this process, all threads */
double stopwatch_user(void); /* user seconds alone */
size_t peak_resident_bytes(void);

#endif
