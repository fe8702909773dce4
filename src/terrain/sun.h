/* Where the sun stands, by the day of the calendar and the place on the globe. */
#ifndef VTS_TERRAIN_SUN_H
#define VTS_TERRAIN_SUN_H

#include "base/strbuf.h"
#include "terrain/geodesy.h"

/* Days since 2000-01-01 12:00 UTC (J2000) of an ISO 8601 text: "2026-06-21", perhaps with a time "T10:00", "T10:00:30.5" and a zone "Z",
 * "+02:00", "-0730", "+02"; without a zone it is UTC. False with a line of text in `error`. */
bool sun_parse_time(const char *text, double *days, StrBuf *error);

/* The unit vector (x east, y up, z north) from a place towards the middle of the sun: its true direction, with aberration and parallax,
 * not bent by the air. Within 0.001 degrees from 1900 to 2100 where UTC is the earth's time of rotation, from which it may be up to
 * 0.004 degrees off. False where the place is none or the day lies more than 10000 years away. */
bool sun_direction(GeoPlace place, double days, Vec3 *out);

#endif
